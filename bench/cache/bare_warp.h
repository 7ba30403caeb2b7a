// What warping costs at the least: samples projected, tested against mask and depth, written to their pixel.
#pragma once

#include <vector>

#include "core/corrective/messages.h"

namespace saccade::bench {

/// A sample cache stripped to what the least of all warps needs: arrays, no levels, no ages, no footprints.
class BareWarp {
 public:
  /// Of all samples of a batch.
  void add(const core::Sample& sample);
  /// Writes each visible sample's correction to its own pixel, the last one wins; how many were written.
  std::size_t warp(const core::FrameSnapshot& frame);
  std::size_t size() const { return x_.size(); }

 private:
  std::vector<float> x_, y_, z_;
  std::vector<float> id_;
  std::vector<core::Vec3> correction_;
  std::vector<core::Vec4> image_;
};

}  // namespace saccade::bench
