// The camera of a person who walks: yaw, pitch, and keys.
#pragma once

#include "core/camera.h"

namespace saccade::app {

/// Which way the keys push, each in {-1, 0, 1}.
struct WalkInput {
  float forward = 0, right = 0, up = 0;
  bool fast = false;
};

class Walker {
 public:
  /// `sceneDiagonal` in metres sets the pace: a person's 1.4 m/s in rooms, more in large scenes.
  Walker(const core::Camera& start, float sceneDiagonal);

  /// Turns by mouse motion in pixels; pitch stops short of straight up and down.
  void look(float dxPx, float dyPx);
  void move(const WalkInput& input, float seconds);
  /// Wheel: narrower or wider field of view.
  void zoom(float steps);
  void setCamera(const core::Camera& camera);
  const core::Camera& camera() const { return camera_; }

 private:
  void updateTarget();

  core::Camera camera_;
  float yaw_ = 0, pitch_ = 0;  ///< radians; yaw 0 looks along -Z
  float metresPerSecond_ = 1.4f;
};

}  // namespace saccade::app
