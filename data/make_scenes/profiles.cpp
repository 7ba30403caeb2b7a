#include "data/make_scenes/profiles.h"

#include <algorithm>
#include <cmath>

namespace saccade::data {
namespace {

using core::kPi;

Vec2 rightOf(const Vec2& direction) { return {direction.y, -direction.x}; }

Vec2 rotated(const Vec2& v, float angle) {
  const float c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

void addRoundedCorner(Profile& profile, const Corner& corner, const Vec2& in, const Vec2& out, int steps) {
  const float turn = std::atan2(in.x * out.y - in.y * out.x, glm::dot(in, out));
  const float side = turn > 0 ? 1.f : -1.f;  // left turns bulge outwards
  const Vec2 start = corner.position - in * (corner.radius * std::tan(std::abs(turn) / 2));
  const Vec2 center = start - side * corner.radius * rightOf(in);
  for (int k = 0; k <= steps; ++k) {
    const Vec2 normal = rotated(rightOf(in), turn * static_cast<float>(k) / static_cast<float>(steps));
    profile.push_back({center + side * corner.radius * normal, normal});
  }
}

}  // namespace

Profile roundedProfile(const std::vector<Corner>& corners, int arcSteps) {
  Profile profile;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 p = corners[i].position;
    const bool first = i == 0, last = i + 1 == corners.size();
    const Vec2 in = first ? Vec2(0) : glm::normalize(p - corners[i - 1].position);
    const Vec2 out = last ? in : glm::normalize(corners[i + 1].position - p);
    if (!first && !last && corners[i].radius > 0) {
      addRoundedCorner(profile, corners[i], in, out, arcSteps);
    } else {
      if (!first) profile.push_back({p, rightOf(in)});
      if (!last) profile.push_back({p, rightOf(out)});
    }
  }
  return profile;
}

Profile splineProfile(const std::vector<Vec2>& points, int steps) {
  Profile profile;
  const auto count = static_cast<int>(points.size());
  const auto at = [&](int i) { return points[static_cast<std::size_t>(std::clamp(i, 0, count - 1))]; };
  // Centripetal knots keep the curve free of loops where points lie at uneven distances.
  const auto knot = [&](int i) { return std::sqrt(std::max(1e-6f, glm::distance(at(i), at(i + 1)))); };
  const auto slope = [&](int i) {
    const float before = knot(i - 1), after = knot(i);
    return (at(i) - at(i - 1)) / before - (at(i + 1) - at(i - 1)) / (before + after) +
           (at(i + 1) - at(i)) / after;
  };
  for (int i = 0; i + 1 < count; ++i) {
    const Vec2 p0 = at(i), p1 = at(i + 1);
    const Vec2 m0 = i == 0 ? p1 - p0 : knot(i) * slope(i),
               m1 = i + 2 == count ? p1 - p0 : knot(i) * slope(i + 1);
    for (int k = i == 0 ? 0 : 1; k <= steps; ++k) {
      const float t = static_cast<float>(k) / static_cast<float>(steps), t2 = t * t, t3 = t2 * t;
      const Vec2 p =
          (2 * t3 - 3 * t2 + 1) * p0 + (t3 - 2 * t2 + t) * m0 + (3 * t2 - 2 * t3) * p1 + (t3 - t2) * m1;
      const Vec2 d = (6 * t2 - 6 * t) * (p0 - p1) + (3 * t2 - 4 * t + 1) * m0 + (3 * t2 - 2 * t) * m1;
      profile.push_back({k == steps ? p1 : p, rightOf(glm::normalize(d))});
    }
  }
  return profile;
}

Profile sphereProfile(float radius, int stacks) {
  Profile profile;
  for (int k = 0; k <= stacks; ++k) {
    const float angle = kPi * (static_cast<float>(k) / static_cast<float>(stacks) - 0.5f);
    const bool pole = k == 0 || k == stacks;
    const Vec2 normal(pole ? 0.f : std::cos(angle), pole ? (k == 0 ? -1.f : 1.f) : std::sin(angle));
    profile.push_back({radius * normal, normal});
  }
  return profile;
}

Profile torusProfile(float major, float minor, int steps) {
  Profile profile;
  for (int k = 0; k <= steps; ++k) {
    const float angle = 2 * kPi * static_cast<float>(k % steps) / static_cast<float>(steps);
    const Vec2 normal(std::cos(angle), std::sin(angle));
    profile.push_back({Vec2(major, 0) + minor * normal, normal});
  }
  return profile;
}

MeshData lathe(const Profile& profile, int slices) {
  float length = 0;
  for (std::size_t i = 1; i < profile.size(); ++i)
    length += glm::distance(profile[i].position, profile[i - 1].position);
  MeshData mesh;
  float travelled = 0;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const ProfilePoint& p = profile[i];
    if (i > 0) travelled += glm::distance(p.position, profile[i - 1].position);
    for (int j = 0; j <= slices; ++j) {
      const float angle = 2 * kPi * static_cast<float>(j % slices) / static_cast<float>(slices);
      const float c = std::cos(angle), s = std::sin(angle);
      mesh.addVertex({p.position.x * c, p.position.y, p.position.x * s},
                     {p.normal.x * c, p.normal.y, p.normal.x * s},
                     {1 - static_cast<float>(j) / static_cast<float>(slices), 1 - travelled / length});
    }
  }
  const auto stride = static_cast<std::uint32_t>(slices + 1);
  for (std::uint32_t i = 0; i + 1 < profile.size(); ++i) {
    if (profile[i].position == profile[i + 1].position) continue;
    for (std::uint32_t j = 0; j + 1 < stride; ++j) {
      const std::uint32_t a = i * stride + j;
      mesh.addQuad(a, a + stride, a + stride + 1, a + 1);
    }
  }
  return mesh;
}

}  // namespace saccade::data
