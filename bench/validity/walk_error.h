// Errors of what a walk displays, by kind of object.
#pragma once

#include <array>
#include <vector>

#include "app/session/camera_path.h"
#include "bench/harness/method.h"
#include "bench/validity/judged_samples.h"

namespace saccade::bench {

inline constexpr app::ImageSize kValiditySize{256, 256};
inline constexpr double kValidityFrameSeconds = 1.0 / 25;
inline constexpr std::uint64_t kValiditySamples = 1500;  ///< new ones a frame

/// Over the pixels of a kind in all pictures added.
struct KindError {
  double squared = 0, flip = 0, pixels = 0;
  double rmse() const;  ///< of displayed values (sRGB, [0, 1])
  double meanFlip() const;
};
using KindErrors = std::array<KindError, std::size(kObjectKinds)>;

/// The middle of a path walked frame by frame with so many new samples each; some frames are put beside what
/// `raytrace` shows of their camera. GL thread.
class ComparedWalk {
 public:
  ComparedWalk(const Stage& stage, const app::CameraPath& path);
  /// Adds the errors of a walk with this aging.
  void walk(app::AgingTest test, float delta, KindErrors& errors) const;

 private:
  struct Truth {
    int frame;
    core::ImageRgb linear;
    std::vector<float> ids;
  };
  const Stage& stage_;
  std::vector<core::Camera> cameras_;
  std::vector<Truth> truths_;
};

}  // namespace saccade::bench
