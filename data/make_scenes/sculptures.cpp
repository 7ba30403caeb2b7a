#include "data/make_scenes/sculptures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

#include "data/make_scenes/shapes.h"

namespace saccade::data {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double kTau = 6.283185307179586;

/// Moved so that its lowest point is at y = 0.
MeshData grounded(MeshData mesh) {
  float lowest = core::kInfinity;
  for (const Vec3& p : mesh.positions) lowest = std::min(lowest, p.y);
  for (Vec3& p : mesh.positions) p.y -= lowest;
  return mesh;
}

/// Point of a cross-section around a curve: `at` in the plane of `side` and its perpendicular.
dvec3 around(const dvec3& center, const dvec3& tangent, const dvec3& sideHint, const dvec2& at) {
  const dvec3 side = glm::normalize(sideHint - tangent * glm::dot(tangent, sideHint));
  return center + at.x * side + at.y * glm::cross(side, tangent);
}

/// Point on a circle (power 2) or rounded square (power above 2) of radius 1, clockwise.
dvec2 superCircle(double u, double power) {
  const double c = std::cos(-kTau * u), s = std::sin(-kTau * u);
  return {std::copysign(std::pow(std::abs(c), 2 / power), c),
          std::copysign(std::pow(std::abs(s), 2 / power), s)};
}

dvec3 polar(double radius, double y, double u) {
  return {radius * std::cos(kTau * u), y, -radius * std::sin(kTau * u)};
}

}  // namespace

MeshData torusKnot(int windings, int turns, int lengthSteps, int aroundSteps) {
  const auto curve = [&](double t) {
    const double ring = kTau * windings * t, loop = kTau * turns * t;
    const double r = 0.31 + 0.13 * std::cos(loop);
    return dvec3(r * std::cos(ring), r * std::sin(ring), 0.16 * std::sin(loop));
  };
  return grounded(parametric({aroundSteps, lengthSteps, true, true}, [&](double u, double v) {
    const dvec3 center = curve(v), tangent = glm::normalize(curve(v + 1e-3) - curve(v - 1e-3));
    const double ring = kTau * windings * v;
    return around(center, tangent, center - 0.31 * dvec3(std::cos(ring), std::sin(ring), 0),
                  0.062 * superCircle(u, 2));
  }));
}

MeshData twistedRing() {
  return grounded(parametric({16, 72, true, true}, [](double u, double v) {
    const double a = kTau * v;
    const dvec3 out(std::cos(a), std::sin(a), 0), tangent(-out.y, out.x, 0);
    const dvec2 flat = superCircle(u, 4) * dvec2(0.035, 0.17);
    const dvec2 turned(std::cos(a) * flat.x - std::sin(a) * flat.y,
                       std::sin(a) * flat.x + std::cos(a) * flat.y);
    return around(0.36 * out, tangent, out, turned);
  }));
}

MeshData twistedTower() {
  return grounded(parametric({28, 34, true, false}, [](double u, double v) {
    const double ends = std::min(1.0, std::min(v, 1 - v) / 0.03);
    const double close = v <= 0 || v >= 1 ? 0 : std::sqrt(ends * (2 - ends));
    const double radius = close * (0.19 - 0.09 * v + 0.02 * std::sin(3 * kTau * v));
    const dvec2 p = radius * superCircle(u, 3.2);
    const double turn = 3.4 * v;
    return dvec3(p.x * std::cos(turn) - p.y * std::sin(turn), 1.1 * v,
                 p.x * std::sin(turn) + p.y * std::cos(turn));
  }));
}

MeshData flame() {
  return grounded(parametric({24, 36, true, false}, [](double u, double v) {
    const double body = std::pow(std::sin(kTau / 2 * std::pow(v, 0.62)), 0.9) * (1 - 0.35 * v);
    const double radius = v <= 0 || v >= 1 ? 0 : 0.13 * body + 0.03 * (1 - v) * std::min(1.0, 30 * v);
    const dvec3 p = polar(radius, 1.35 * v, u);
    return p + dvec3(0.07 * std::sin(kTau * 0.5 * v) + 0.05 * v * v, 0, 0.25 * p.x * v);
  }));
}

MeshData bean() {
  return grounded(parametric({72, 40, true, false}, [](double u, double v) {
    const double latitude = kTau / 2 * (v - 0.5);
    const double pole = v <= 0 || v >= 1 ? 0 : std::cos(latitude);
    const dvec3 p = polar(pole, std::sin(latitude), u);
    const double arch = p.y < 0 ? 0.42 * std::exp(-6 * p.x * p.x) * p.y * p.y : 0;
    return dvec3(1.0 * p.x, 0.58 * p.y + arch + 0.10 * p.x * p.x, 0.62 * p.z * (1 + 0.12 * p.x));
  }));
}

MeshData starfruit() {
  return grounded(parametric({60, 26, true, false}, [](double u, double v) {
    const double latitude = kTau / 2 * (v - 0.5), c = v <= 0 || v >= 1 ? 0 : std::cos(latitude);
    const double radius = 0.36 * (1 + 0.16 * std::cos(5 * kTau * u + 2.2 * latitude) * c * c);
    return polar(radius * c, 0.40 * std::sin(latitude), u);
  }));
}

MeshData seashell() {
  return grounded(parametric({14, 96, true, false}, [](double u, double v) {
    const double turns = 3.2 * kTau * v, growth = std::exp(-1.9 * v);
    const double end = std::min(1.0, std::min(v, 1 - v) / 0.025);
    const double radius = v <= 0 || v >= 1 ? 0 : 0.17 * growth * std::sqrt(end * (2 - end));
    const dvec3 out(std::cos(turns), 0, -std::sin(turns));
    const dvec3 center = 0.24 * growth * out + dvec3(0, 0.85 * (1 - growth), 0);
    return around(center, glm::normalize(dvec3(out.z, 0.35, -out.x)), out, radius * superCircle(u, 2.4));
  }));
}

MeshData beadTower() {
  MeshData tower;
  float y = 0;
  for (const float radius : {0.24f, 0.19f, 0.15f, 0.115f, 0.085f}) {
    y += radius;
    tower.append(lathe(sphereProfile(radius, 14), 24), glm::translate(Mat4(1), Vec3(0, y, 0)));
    y += radius * 0.97f;
  }
  return tower;
}

MeshData crown() {
  MeshData mesh = lathe(splineProfile({{0.26f, 0.02f},
                                       {0.285f, 0.0f},
                                       {0.30f, 0.03f},
                                       {0.28f, 0.13f},
                                       {0.33f, 0.26f},
                                       {0.32f, 0.265f},
                                       {0.265f, 0.13f},
                                       {0.26f, 0.02f}},
                                      3),
                        40);
  constexpr int kBalls = 10;
  for (int k = 0; k < kBalls; ++k) {
    const float angle = 2 * core::kPi * static_cast<float>(k) / kBalls;
    const Vec3 at(0.325f * std::cos(angle), k % 2 == 0 ? 0.30f : 0.285f, 0.325f * std::sin(angle));
    mesh.append(lathe(sphereProfile(k % 2 == 0 ? 0.045f : 0.03f, 8), 12), glm::translate(Mat4(1), at));
  }
  return grounded(std::move(mesh));
}

MeshData bust() {
  return grounded(lathe(splineProfile({{0, 0},
                                       {0.16f, 0.0f},
                                       {0.17f, 0.05f},
                                       {0.12f, 0.09f},
                                       {0.22f, 0.20f},
                                       {0.25f, 0.32f},
                                       {0.18f, 0.42f},
                                       {0.085f, 0.48f},
                                       {0.08f, 0.54f},
                                       {0.13f, 0.62f},
                                       {0.155f, 0.74f},
                                       {0.12f, 0.86f},
                                       {0, 0.91f}},
                                      3),
                        30));
}

namespace {

/// Up the outside, over the rim, down the inside.
const std::array<std::vector<Vec2>, 4> kVaseOutlines{{
    {{0, 0},
     {0.12f, 0},
     {0.14f, 0.02f},
     {0.24f, 0.30f},
     {0.22f, 0.48f},
     {0.09f, 0.62f},
     {0.08f, 0.70f},
     {0.13f, 0.78f},
     {0.12f, 0.785f},
     {0.068f, 0.70f},
     {0.078f, 0.62f},
     {0.205f, 0.47f},
     {0.225f, 0.30f},
     {0.12f, 0.04f},
     {0, 0.03f}},
    {{0, 0},
     {0.10f, 0},
     {0.11f, 0.03f},
     {0.27f, 0.14f},
     {0.33f, 0.27f},
     {0.34f, 0.32f},
     {0.325f, 0.325f},
     {0.31f, 0.27f},
     {0.25f, 0.16f},
     {0.10f, 0.06f},
     {0, 0.05f}},
    {{0, 0},
     {0.13f, 0},
     {0.14f, 0.02f},
     {0.15f, 0.2f},
     {0.21f, 0.44f},
     {0.26f, 0.62f},
     {0.20f, 0.74f},
     {0.15f, 0.78f},
     {0.17f, 0.83f},
     {0.155f, 0.832f},
     {0.135f, 0.78f},
     {0.19f, 0.72f},
     {0.245f, 0.61f},
     {0.19f, 0.44f},
     {0.13f, 0.2f},
     {0.11f, 0.04f},
     {0, 0.03f}},
    {{0, 0},
     {0.15f, 0},
     {0.16f, 0.02f},
     {0.05f, 0.10f},
     {0.045f, 0.24f},
     {0.20f, 0.36f},
     {0.24f, 0.50f},
     {0.22f, 0.70f},
     {0.205f, 0.70f},
     {0.225f, 0.50f},
     {0.185f, 0.375f},
     {0, 0.31f}},
}};

}  // namespace

MeshData vase(int shape, int slices) {
  return grounded(lathe(splineProfile(kVaseOutlines[static_cast<std::size_t>(shape)], 2), slices));
}

MeshData column(float height, float radius) {
  constexpr int kFlutes = 20;
  const double r = radius, base = 1.3 * r, capital = 1.2 * r, top = height - capital;
  MeshData mesh = parametric({kFlutes * 3, 4, true, false}, [&](double u, double v) {
    const double taper = 1 - 0.13 * v * v,
                 flute = 0.055 * std::pow(std::abs(std::sin(kTau / 2 * kFlutes * u)), 0.8);
    return polar(r * taper * (1 - flute), base + (top - base) * v, u);
  });
  const auto f = [&](double x) { return static_cast<float>(x * r); };
  const float h = height;
  const Profile foot = roundedProfile({{{f(1.42), f(0.4)}, 0},
                                       {{f(1.42), f(0.85)}, f(0.2)},
                                       {{f(1.12), f(0.85)}, 0},
                                       {{f(1.12), f(1.0)}, 0},
                                       {{f(1.22), f(1.0)}, f(0.08)},
                                       {{f(1.22), f(1.22)}, f(0.1)},
                                       {{f(1.0), f(1.22)}, 0},
                                       {{f(0.96), f(1.34)}, 0}},
                                      3);
  const Profile head = splineProfile({{f(0.84), h - f(1.25)},
                                      {f(0.92), h - f(1.2)},
                                      {f(0.94), h - f(1.08)},
                                      {f(0.86), h - f(1.0)},
                                      {f(0.9), h - f(0.75)},
                                      {f(1.15), h - f(0.42)},
                                      {f(1.3), h - f(0.34)}},
                                     2);
  mesh.append(lathe(foot, 24));
  mesh.append(lathe(head, 24));
  mesh.append(box({0, f(0.2), 0}, {f(3), f(0.4), f(3)}, 0.5f));
  mesh.append(box({0, h - f(0.17), 0}, {f(2.8), f(0.34), f(2.8)}, 0.5f));
  return mesh;
}

}  // namespace saccade::data
