#include "render/probe/probe.h"

#include <algorithm>
#include <cmath>

namespace saccade::render {

using core::Vec2;
using core::Vec3;
using core::Vec4;

namespace {

/// Each brings the point that a ray is thought to meet nearer to what the probe sees behind it.
constexpr int kSteps = 2;

/// Face 2 a + s looks along axis a, towards +1 (s = 0) or -1; the axis after next is up in its picture.
Vec3 axis(int a, float sign) {
  Vec3 v(0);
  v[a % 3] = sign;
  return v;
}
float signOf(int face) { return face % 2 == 0 ? 1.0f : -1.0f; }

}  // namespace

Probe::Probe(BaseRenderer& renderer, const core::Scene& scene, const Vec3& center,
             std::span<const char> hidden)
    : center_(center) {
  for (int level = 0; level < kLevels; ++level) {
    const int side = kSide >> level;
    levels_[static_cast<std::size_t>(level)].resize(static_cast<std::size_t>(6) * side * side);
  }
  for (int face = 0; face < 6; ++face) {
    drawFace(face, renderer, scene, hidden);
    for (int level = 1; level < kLevels; ++level) halve(face, level);
  }
}

void Probe::drawFace(int face, BaseRenderer& renderer, const core::Scene& scene,
                     std::span<const char> hidden) {
  core::Camera camera;
  camera.eye = center_;
  // So far that the sum differs from the centre however far that is from the origin.
  const float ahead = std::max(scene.bounds.diagonal(), 1e-3f * glm::length(center_));
  camera.at = center_ + axis(face / 2, signOf(face) * ahead);
  camera.up = axis(face / 2 + 2, 1);
  camera.fovYDegrees = 90;
  const core::View view(camera, kSide, kSide, scene.bounds);
  const core::FramePtr frame = renderer.renderWithout(view, hidden);
  std::copy(frame->baseAndId.begin(), frame->baseAndId.end(),
            levels_[0].begin() + static_cast<std::ptrdiff_t>(face) * kSide * kSide);
  for (int y = 0; y < kDistances; ++y) {
    for (int x = 0; x < kDistances; ++x) {
      const int step = kSide / kDistances;
      const float depth = frame->depth[frame->index(x * step, y * step)];
      const Vec2 pixel(static_cast<float>(x * step) + 0.5f, static_cast<float>(y * step) + 0.5f);
      distances_.push_back(depth > 0 ? view.viewDepth(depth) * glm::length(view.direction(pixel))
                                     : core::kInfinity);
    }
  }
}

void Probe::halve(int face, int level) {
  const int side = kSide >> level;
  const auto index = [face](int s, int x, int y) {
    return (static_cast<std::size_t>(face) * s + static_cast<std::size_t>(y)) * s +
           static_cast<std::size_t>(x);
  };
  const std::vector<Vec4>& fine = levels_[static_cast<std::size_t>(level - 1)];
  std::vector<Vec4>& coarse = levels_[static_cast<std::size_t>(level)];
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      Vec3 sum(0);
      for (const int dy : {0, 1}) {
        for (const int dx : {0, 1}) sum += Vec3(fine[index(2 * side, 2 * x + dx, 2 * y + dy)]);
      }
      coarse[index(side, x, y)] = Vec4(0.25f * sum, 0);
    }
  }
}

Probe::Place Probe::placeOf(const Vec3& d) {
  const Vec3 size = glm::abs(d);
  const int a = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const float scale = 0.5f / size[a];
  const int face = 2 * a + (d[a] < 0 ? 1 : 0);
  // The camera's right is forward x up: minus the next axis for a face that looks towards +1.
  return {face, {0.5f - signOf(face) * d[(a + 1) % 3] * scale, 0.5f - d[(a + 2) % 3] * scale}};
}

float Probe::distance(const Vec3& direction) const {
  const Place p = placeOf(direction);
  const int x = std::min(static_cast<int>(p.at.x * kDistances), kDistances - 1);
  const int y = std::min(static_cast<int>(p.at.y * kDistances), kDistances - 1);
  const int row = p.face * kDistances + y;
  return distances_[static_cast<std::size_t>(row) * kDistances + static_cast<std::size_t>(x)];
}

/// Bilinear within the face.
Vec3 Probe::texel(const Place& place, int level) const {
  const int side = kSide >> level;
  const Vec2 at = glm::clamp(place.at * static_cast<float>(side) - 0.5f, Vec2(0), Vec2(side - 1));
  const int x0 = static_cast<int>(at.x), y0 = static_cast<int>(at.y);
  const int x1 = std::min(x0 + 1, side - 1), y1 = std::min(y0 + 1, side - 1);
  const Vec2 f = at - Vec2(x0, y0);
  const Vec4* t =
      &levels_[static_cast<std::size_t>(level)][static_cast<std::size_t>(place.face) * side * side];
  const Vec4 top = t[y0 * side + x0] * (1 - f.x) + t[y0 * side + x1] * f.x;
  const Vec4 bottom = t[y1 * side + x0] * (1 - f.x) + t[y1 * side + x1] * f.x;
  return Vec3(top * (1 - f.y) + bottom * f.y);
}

Vec3 Probe::radiance(const Vec3& origin, const Vec3& direction, float spread) const {
  const Vec3 from = origin - center_;
  const float along = glm::dot(from, direction), squared = glm::dot(from, from);
  Vec3 towards = direction;
  float travelled = 1, away = 1;  // of the met point, from the origin and from the centre
  for (int i = 0; i < kSteps; ++i) {
    away = distance(towards);
    if (!(away < core::kInfinity)) {
      towards = direction;
      travelled = away = 1;
      break;
    }
    // The ray and the sphere around the centre on which that point lies.
    const float inside = along * along - squared + away * away;
    travelled = std::max(0.0f, std::sqrt(std::max(0.0f, inside)) - along);
    const Vec3 met = from + travelled * direction;
    if (!(glm::dot(met, met) > 0)) break;
    towards = met;
  }
  const Place place = placeOf(towards);
  constexpr float kTexelRadians = 0.5f * core::kPi / kSide;
  const float texels = spread * travelled / (std::max(away, 1e-20f) * kTexelRadians);
  if (!(texels > 1)) return texel(place, 0);
  const float level = std::min(std::log2(texels), static_cast<float>(kLevels - 1));
  const int below = std::min(static_cast<int>(level), kLevels - 2);
  const float part = level - static_cast<float>(below);
  return texel(place, below) * (1 - part) + texel(place, below + 1) * part;
}

}  // namespace saccade::render
