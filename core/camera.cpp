#include "core/camera.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace saccade::core {
namespace {

// Near plane: a thousandth of the scene, at most 5 cm (a walker's nose), at least a millionth of the far
// plane.
constexpr float kNearOfDiagonal = 1e-3f;
constexpr float kNearLargest = 0.05f;
constexpr float kNearOfFar = 1e-6f;
constexpr float kFarMargin = 1.01f;
/// Sine of the angle below which up counts as parallel to the line of sight.
constexpr float kParallel = 1e-5f;

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check(const Camera& camera, int width, int height) {
  const std::string who = camera.name.empty() ? "camera" : "camera '" + camera.name + "'";
  if (width <= 0 || height <= 0) throw Error(who + ": image size must be at least 1x1");
  if (!finite(camera.eye) || !finite(camera.at) || !finite(camera.up) || !std::isfinite(camera.fovYDegrees))
    throw Error(who + ": eye, at, up and field of view must be finite numbers");
  if (!(camera.fovYDegrees > 0 && camera.fovYDegrees < 180))
    throw Error(who + ": field of view must lie between 0 and 180 degrees");
  const float sight = glm::length(camera.at - camera.eye);
  if (!(sight > 0) || !std::isfinite(sight)) throw Error(who + ": eye and at are the same point");
  const float upLength = glm::length(camera.up);
  if (!(upLength > 0) || !std::isfinite(upLength)) throw Error(who + ": up must not be zero");
  const Vec3 across = glm::cross((camera.at - camera.eye) / sight, camera.up / upLength);
  if (!(glm::length(across) > kParallel)) throw Error(who + ": up is parallel to the line of sight");
}

float farthestCorner(const Bounds& box, const Vec3& eye) {
  if (box.empty()) return 1;
  const Vec3 reach = glm::max(glm::abs(box.lo - eye), glm::abs(box.hi - eye));
  return glm::length(reach);
}

}  // namespace

View::View(const Camera& camera, int width, int height, const Bounds& scene)
    : camera_(camera), width_(width), height_(height) {
  check(camera, width, height);
  forward_ = glm::normalize(camera.at - camera.eye);
  right_ = glm::normalize(glm::cross(forward_, glm::normalize(camera.up)));
  up_ = glm::cross(right_, forward_);
  tanHalfY_ = static_cast<float>(std::tan(0.5 * static_cast<double>(camera.fovYDegrees) * kPi / 180.0));
  tanHalfX_ = tanHalfY_ * static_cast<float>(width) / static_cast<float>(height);

  const float diagonal = scene.diagonal() > 0 ? scene.diagonal() : 1.0f;
  const float reach =
      std::max(farthestCorner(scene, camera.eye) * kFarMargin, diagonal * kNearOfDiagonal * 4);
  zFar_ = reach;
  zNear_ = std::max(std::min(diagonal * kNearOfDiagonal, kNearLargest), zFar_ * kNearOfFar);

  const Vec3 x = right_ / tanHalfX_;
  const Vec3 y = -up_ / tanHalfY_;  // down: row 0 of the image is the top
  const float a = -zNear_ / (zFar_ - zNear_);
  const float b = zFar_ * zNear_ / (zFar_ - zNear_);
  const Vec3 rows[4] = {x, y, a * forward_, forward_};
  const float constants[4] = {0, 0, b, 0};
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 3; ++column) viewProjection_[column][row] = rows[row][column];
    viewProjection_[3][row] = constants[row] - glm::dot(rows[row], camera.eye);
  }
}

Vec3 View::direction(Vec2 pixel) const {
  const float x = (2 * pixel.x / static_cast<float>(width_) - 1) * tanHalfX_;
  const float y = (1 - 2 * pixel.y / static_cast<float>(height_)) * tanHalfY_;
  return forward_ + x * right_ + y * up_;
}

float View::viewDepth(float windowDepth) const {
  const double n = zNear_, f = zFar_;
  return static_cast<float>(f * n / (n + windowDepth * (f - n)));
}

std::optional<View::Projected> View::project(const Vec3& world) const {
  const Vec3 offset = world - camera_.eye;
  const float depth = glm::dot(forward_, offset);
  // Written so that NaN fails.
  if (!(depth >= zNear_) || !std::isfinite(depth)) return std::nullopt;
  const float x = glm::dot(right_, offset) / (depth * tanHalfX_);
  const float y = glm::dot(up_, offset) / (depth * tanHalfY_);
  const Vec2 pixel(0.5f * (1 + x) * static_cast<float>(width_), 0.5f * (1 - y) * static_cast<float>(height_));
  if (!std::isfinite(pixel.x) || !std::isfinite(pixel.y)) return std::nullopt;
  return Projected{pixel, depth};
}

void View::project(const float* x, const float* y, const float* z, std::size_t count,
                   float* __restrict__ pixelX, float* __restrict__ pixelY,
                   float* __restrict__ viewDepth) const {
  // Copies and __restrict__, so that the compiler need not fear that the results overwrite what is read.
  const Vec3 eye = camera_.eye, right = right_, up = up_, forward = forward_;
  const float tanX = tanHalfX_, tanY = tanHalfY_;
  const auto width = static_cast<float>(width_), height = static_cast<float>(height_);
  for (std::size_t i = 0; i < count; ++i) {
    const float dx = x[i] - eye.x, dy = y[i] - eye.y, dz = z[i] - eye.z;
    const float depth = forward.x * dx + forward.y * dy + forward.z * dz;
    const float across = (right.x * dx + right.y * dy + right.z * dz) / (depth * tanX);
    const float upwards = (up.x * dx + up.y * dy + up.z * dz) / (depth * tanY);
    pixelX[i] = 0.5f * (1 + across) * width;
    pixelY[i] = 0.5f * (1 - upwards) * height;
    viewDepth[i] = depth;
  }
}

}  // namespace saccade::core
