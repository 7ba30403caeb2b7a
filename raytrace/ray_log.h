// The very rays of a run, in order, and a bare Embree loop over them: the yardstick for the corrective loop.
#pragma once

#include <cstdint>
#include <vector>

#include "raytrace/world.h"

namespace saccade::raytrace {

class RayLog {
 public:
  struct Entry {
    Ray ray;
    std::int32_t object = -1;  ///< >= 0: in that object's own tree
    bool occluded = false;     ///< rtcOccluded1 instead of rtcIntersect1
  };
  void add(const Ray& ray, std::int32_t object, bool occluded) {
    entries_.push_back({ray, object, occluded});
  }
  const std::vector<Entry>& entries() const { return entries_; }
  void clear() { entries_.clear(); }

 private:
  std::vector<Entry> entries_;
};

/// rtcIntersect1 / rtcOccluded1 for each entry, nothing else. Returns the number of rays that hit.
std::uint64_t replayRays(const World& world, const RayLog& log);

}  // namespace saccade::raytrace
