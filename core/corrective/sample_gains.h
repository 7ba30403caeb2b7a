// What one more sample is worth, object by object: how much fresh samples have changed what is displayed.
//
// Addition to Haber et al. 2001: importance says where a person looks, not where the picture is wrong. A
// smooth wall that the base layer has nearly right and a sphere full of reflections may attract the eye
// alike; a sample mends the sphere. Nothing is traced to find that out: every sample that arrives tells what
// it has changed (bench/walkorder measures what that is worth).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/math/types.h"

namespace saccade::core {

/// |difference| of two linear radiances as displayed (the sRGB curve taken as a root), mean over the
/// channels, [0, 1].
float displayedChange(const Vec3& before, const Vec3& after);

/// One owner, one thread at a time.
class SampleGains {
 public:
  /// A sample of an object has changed its own pixel by so much, [0, 1] as displayed. NaN is ignored.
  void add(std::uint32_t id, float change);
  /// For every new camera: what was seen before counts less from now on.
  void beginFrame();
  /// (0, 1] by id: the mean change, or 1 for an object of which nothing is known, or nothing any more: all
  /// but what it got in the last few frames is forgotten, so that no object goes without samples for good.
  std::vector<float> byId(std::size_t entries) const;

  /// What is left of the weight of a sample with each new camera.
  static constexpr float kKept = 0.7f;
  /// Added to every mean: an object that samples do not change is sampled last, but before nothing.
  static constexpr float kLeast = 0.01f;

 private:
  struct Mean {
    float sum = 0, weight = 0;
  };
  std::vector<Mean> means_;  ///< by id
};

}  // namespace saccade::core
