#include "app/viewer/camera_drive.h"

#include <algorithm>
#include <cmath>

namespace saccade::app {

namespace {

constexpr double kShortestSeconds = 0.5, kLongestSeconds = 2.5;
constexpr float kDiagonalsPerSecond = 0.25f;
constexpr float kRadiansPerSecond = 1.2f;

struct Heading {
  float yaw, pitch, distance;
};

Heading headingOf(const core::Camera& c) {
  const core::Vec3 d = c.at - c.eye;
  const float distance = glm::length(d);
  return {std::atan2(d.x, -d.z), std::asin(std::clamp(d.y / distance, -1.0f, 1.0f)), distance};
}

/// The shorter way round, in [-pi, pi].
float turn(float from, float to) { return std::remainder(to - from, 2 * core::kPi); }

double secondsOf(const core::Camera& from, const core::Camera& to, float sceneDiagonal) {
  const Heading a = headingOf(from), b = headingOf(to);
  const double way = glm::length(to.eye - from.eye) / (kDiagonalsPerSecond * std::max(sceneDiagonal, 1e-6f));
  const double turning = std::max(std::abs(turn(a.yaw, b.yaw)), std::abs(b.pitch - a.pitch));
  return std::clamp(std::max(way, turning / kRadiansPerSecond), kShortestSeconds, kLongestSeconds);
}

}  // namespace

Flight::Flight(const core::Camera& from, const core::Camera& to, float sceneDiagonal)
    : from_(from), to_(to), seconds_(secondsOf(from, to, sceneDiagonal)) {}

core::Camera Flight::at(double seconds) const {
  if (seconds <= 0) return from_;
  if (seconds >= seconds_) return to_;
  const auto t = static_cast<float>(seconds / seconds_);
  const float s = t * t * (3 - 2 * t);  // no speed at either end
  const Heading a = headingOf(from_), b = headingOf(to_);
  const float yaw = a.yaw + s * turn(a.yaw, b.yaw), pitch = glm::mix(a.pitch, b.pitch, s);
  core::Camera camera = to_;
  camera.eye = glm::mix(from_.eye, to_.eye, s);
  camera.at = camera.eye + glm::mix(a.distance, b.distance, s) * core::Vec3(std::cos(pitch) * std::sin(yaw),
                                                                            std::sin(pitch),
                                                                            -std::cos(pitch) * std::cos(yaw));
  const core::Vec3 up = glm::mix(from_.up, to_.up, s);
  if (glm::length(glm::cross(up, camera.at - camera.eye)) > 1e-4f * glm::length(camera.at - camera.eye))
    camera.up = up;
  camera.fovYDegrees = glm::mix(from_.fovYDegrees, to_.fovYDegrees, s);
  return camera;
}

void CameraDrive::flyTo(const core::Camera& to, const core::Camera& from, double now) {
  stop();
  flight_.emplace(from, to, sceneDiagonal_);
  start_ = now;
}

void CameraDrive::play(const CameraPath& path, double now) {
  stop();
  path_ = path;
  start_ = now - path.beginSeconds();
}

void CameraDrive::play(const CameraPath& path, const core::Camera& from, double now) {
  flyTo(path.at(path.beginSeconds()), from, now);
  path_ = path;
}

void CameraDrive::stop() {
  flight_.reset();
  path_.reset();
}

std::optional<core::Camera> CameraDrive::at(double now) {
  if (!flight_) return path_ ? alongPath(now) : std::nullopt;
  const core::Camera camera = flight_->at(now - start_);
  if (now - start_ >= flight_->seconds()) {
    start_ += flight_->seconds();
    flight_.reset();
    if (path_) start_ -= path_->beginSeconds();
  }
  return camera;
}

std::optional<core::Camera> CameraDrive::alongPath(double now) {
  const core::Camera camera = path_->at(now - start_);
  if (now - start_ < path_->lengthSeconds()) return camera;
  if (!loop_) {
    path_.reset();
  } else {
    flight_.emplace(camera, path_->at(path_->beginSeconds()), sceneDiagonal_);
    start_ = now;
  }
  return camera;
}

}  // namespace saccade::app
