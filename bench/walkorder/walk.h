// One stretch of a scene's path, its converged pictures, and walks of it by orders of correction.
#pragma once

#include <cstdint>
#include <vector>

#include "app/session/camera_path.h"
#include "bench/harness/method.h"
#include "bench/reference/grade.h"

namespace saccade::bench {

/// Means over the key views. RMSE is of displayed values (sRGB, [0, 1]); `salient`: weighted by the spectral
/// residual of the converged picture.
struct WalkError {
  double rmse = 0, rmseSalient = 0, flip = 0, flipSalient = 0;
};

/// 1.4 seconds of a path at 25 frames a second. GL thread; the stage must outlive it.
class OrderWalk {
 public:
  /// About `place` in [0, 1] of the path. Traces the converged pictures, with the seed that walks are to
  /// have.
  OrderWalk(const Stage& stage, const app::CameraPath& path, double place, app::ImageSize size,
            std::uint32_t seed);

  /// From nothing, frame by frame with so many new samples each.
  WalkError walk(const app::CorrectiveOptions& options, std::uint64_t samplesPerFrame) const;

 private:
  struct KeyView {
    int frame;
    Grader truth;
  };
  const Stage& stage_;
  const app::ImageSize size_;
  const std::uint32_t seed_;
  std::vector<core::Camera> cameras_;
  std::vector<KeyView> keyViews_;
};

}  // namespace saccade::bench
