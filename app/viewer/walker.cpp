#include "app/viewer/walker.h"

#include <algorithm>
#include <cmath>

namespace saccade::app {

namespace {
constexpr float kRadiansPerPixel = 0.003f;
constexpr float kMaxPitch = 1.55f;  // just short of the pole, where "up" has no direction
constexpr float kRoomDiagonal = 20;
constexpr float kWalkMetresPerSecond = 1.4f;
constexpr float kFast = 4;
constexpr float kZoomPerStep = 0.9f;
}  // namespace

Walker::Walker(const core::Camera& start, float sceneDiagonal)
    : metresPerSecond_(kWalkMetresPerSecond * std::max(0.05f, sceneDiagonal / kRoomDiagonal)) {
  setCamera(start);
}

void Walker::setCamera(const core::Camera& camera) {
  camera_ = camera;
  const core::Vec3 d = glm::normalize(camera.at - camera.eye);
  yaw_ = std::atan2(d.x, -d.z);
  pitch_ = std::clamp(std::asin(std::clamp(d.y, -1.0f, 1.0f)), -kMaxPitch, kMaxPitch);
}

void Walker::look(float dxPx, float dyPx) {
  if (dxPx == 0 && dyPx == 0) return;
  const float scale = kRadiansPerPixel * camera_.fovYDegrees / 60;
  yaw_ += scale * dxPx;
  pitch_ = std::clamp(pitch_ - scale * dyPx, -kMaxPitch, kMaxPitch);
  updateTarget();
}

void Walker::move(const WalkInput& input, float seconds) {
  if (input.forward == 0 && input.right == 0 && input.up == 0) return;
  const core::Vec3 ahead(std::sin(yaw_), 0, -std::cos(yaw_));
  const core::Vec3 aside(std::cos(yaw_), 0, std::sin(yaw_));
  const float step = metresPerSecond_ * (input.fast ? kFast : 1) * seconds;
  camera_.eye += step * (input.forward * ahead + input.right * aside + core::Vec3(0, input.up, 0));
  updateTarget();
}

void Walker::zoom(float steps) {
  if (steps == 0) return;
  camera_.fovYDegrees = std::clamp(camera_.fovYDegrees * std::pow(kZoomPerStep, steps), 5.0f, 120.0f);
}

void Walker::updateTarget() {
  camera_.at = camera_.eye + core::Vec3(std::cos(pitch_) * std::sin(yaw_), std::sin(pitch_),
                                        -std::cos(pitch_) * std::cos(yaw_));
  camera_.up = {0, 1, 0};
}

}  // namespace saccade::app
