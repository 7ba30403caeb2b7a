// What cached samples must pass to be shown again (Haber et al. 2001, section 4.5, and ours).
#pragma once

#include <cmath>

#include "core/corrective/messages.h"

namespace saccade::render {

enum class AgingTest {
  haber,  ///< the paper's: change of <normal, v>, by majority of an object's samples of one age
  change  ///< sample by sample: expected change of what is displayed (core/corrective/change_rate.h)
};

struct AgingOptions {
  int nMin = 10;       ///< N_min: samples a level needs to be the one that is tested (haber)
  float delta = 0.1f;  ///< largest change of a valid sample: of <normal, v>, or as displayed; [0, 1]
  int maxAge = 30;     ///< MAX_AGE in camera changes, >= 0
  AgingTest test = AgingTest::haber;
};

/// How much a sample has changed for another eye by the test's measure, which SampleCache::age compares with
/// delta a page at a time (haber: by majority). NaN for an eye on the sample, which is invalid. Any thread.
inline float agedChange(AgingTest test, const core::Sample& sample, const core::Vec3& eye) {
  const core::Vec3 v = glm::normalize(eye - sample.position);
  if (test == AgingTest::haber) return std::abs(glm::dot(sample.normal, v) - sample.cosView);
  return sample.changeRate * glm::length(v - sample.toEye);
}

}  // namespace saccade::render
