// What cached samples must pass to be shown again (Haber et al. 2001, section 4.5, and ours).
#pragma once

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

}  // namespace saccade::render
