// Cached samples of a walk beside what they would be if they were traced again.
#pragma once

#include <string>
#include <unordered_set>
#include <vector>

#include "app/session/camera_path.h"
#include "bench/harness/method.h"
#include "bench/paper/untraced_walk.h"

namespace saccade::bench {

/// What an object is to the view-dependent light on it.
enum class ObjectKind { mirror, glossy, glass };
inline constexpr ObjectKind kObjectKinds[] = {ObjectKind::mirror, ObjectKind::glossy, ObjectKind::glass};
/// "mirror", "glossy", "glass".
std::string nameOf(ObjectKind kind);
/// Glass transmits; a mirror's GGX alpha is below 0.01 all over; all others are glossy. `id` as in an ID
/// mask.
ObjectKind kindOf(const raytrace::World& world, std::uint32_t id);

/// A cached sample when the camera has gone on. Errors are the largest difference of a channel of base +
/// correction after the display transform (sRGB, [0, 1]).
struct JudgedSample {
  std::uint64_t key = 0;  ///< of the sample, within its place
  ObjectKind kind = ObjectKind::mirror;
  float error = 0;      ///< against the same point traced for the new eye with the same random numbers
  float noiseless = 0;  ///< the same of means of kSubSamples, then and now; negative where not computed
  float expected = 0;   ///< what AgingTest::change expects: changeRate times the chord of the turn
};

/// All samples that a walk of `frames` frames left in the cache, none of them aged away, and the next view.
/// GL thread.
class JudgedPlace {
 public:
  static constexpr int kSubSamples = 8;

  JudgedPlace(const Stage& stage, const app::CameraPath& path, double seconds);

  /// Of those whose surface faces the new eye and is met again.
  const std::vector<JudgedSample>& samples() const { return samples_; }
  /// What SampleCache::age does for the new view.
  struct Aged {
    std::unordered_set<std::uint64_t> kept;  ///< keys
    double seconds = 0;                      ///< that it took, for all of the cache's samples
  };
  Aged aged(const render::AgingOptions& options) const;
  std::size_t cached() const { return cache_->size(); }

 private:
  core::View view_;
  std::unique_ptr<FrozenCache> cache_;
  std::vector<JudgedSample> samples_;
};

}  // namespace saccade::bench
