#include "data/make_scenes/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace saccade::data {
namespace {

using glm::dvec3;

constexpr double kTau = 6.283185307179586;

/// The six faces of a box: outward axis, u axis, v axis with u x v = outward.
struct Face {
  Vec3 out, u, v;
};
const std::array<Face, 6> kFaces{{{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                                  {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                  {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
                                  {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
                                  {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
                                  {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}}}};

/// Grid lines across one face: at equal angles over both rounded edges, one cell between. Both ends are
/// exactly +-half, so that neighbouring faces share their border positions bit for bit.
std::vector<float> roundedLines(float half, float radius, int steps) {
  std::vector<float> lines{-half};
  for (int k = 1; k <= steps; ++k) {
    const float angle = core::kPi / 4 * (1 - static_cast<float>(k) / static_cast<float>(steps));
    lines.push_back(-half + radius * (1 - std::tan(angle)));
  }
  for (std::size_t k = lines.size(); k-- > 0;) lines.push_back(-lines[k]);
  return lines;
}

}  // namespace

MeshData panel(const Vec3& corner, const Vec3& edgeU, const Vec3& edgeV, const Vec2& uvSize) {
  MeshData mesh;
  const Vec3 normal = glm::cross(edgeU, edgeV);
  mesh.addVertex(corner, normal, {0, uvSize.y});
  mesh.addVertex(corner + edgeU, normal, uvSize);
  mesh.addVertex(corner + edgeU + edgeV, normal, {uvSize.x, 0});
  mesh.addVertex(corner + edgeV, normal, {0, 0});
  mesh.addQuad(0, 1, 2, 3);
  return mesh;
}

MeshData box(const Vec3& center, const Vec3& size, float uvMetres) {
  MeshData mesh;
  for (const Face& face : kFaces) {
    const Vec3 u = face.u * size, v = face.v * size;
    const Vec3 corner = center + 0.5f * (face.out * size - u - v);
    mesh.append(panel(corner, u, v, Vec2(glm::length(u), glm::length(v)) / uvMetres));
  }
  return mesh;
}

MeshData roundedBox(const Vec3& center, const Vec3& size, float radius, int steps, float uvMetres) {
  MeshData mesh;
  const Vec3 half = 0.5f * size, inner = half - Vec3(radius);
  for (const Face& face : kFaces) {
    const float halfU = glm::dot(glm::abs(face.u), half), halfV = glm::dot(glm::abs(face.v), half);
    const std::vector<float> us = roundedLines(halfU, radius, steps), vs = roundedLines(halfV, radius, steps);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const float v : vs) {
      for (const float u : us) {
        const Vec3 onCube = face.out * half + face.u * u + face.v * v;
        const Vec3 core = glm::clamp(onCube, -inner, inner);
        const Vec3 normal = glm::normalize(onCube - core);
        mesh.addVertex(center + core + radius * normal, normal, Vec2(u + halfU, halfV - v) / uvMetres);
      }
    }
    const auto stride = static_cast<std::uint32_t>(us.size());
    for (std::uint32_t j = 0; j + 1 < vs.size(); ++j)
      for (std::uint32_t i = 0; i + 1 < stride; ++i) {
        const std::uint32_t a = first + j * stride + i;
        mesh.addQuad(a, a + 1, a + stride + 1, a + stride);
      }
  }
  return mesh;
}

MeshData parametric(const Grid& grid, const std::function<dvec3(double u, double v)>& f) {
  constexpr double kStep = 1e-4;
  MeshData mesh;
  const auto inside = [=](double x, bool closed) { return closed ? x : std::clamp(x, kStep, 1 - kStep); };
  for (int j = 0; j <= grid.nv; ++j) {
    for (int i = 0; i <= grid.nu; ++i) {
      const double u = static_cast<double>(i) / grid.nu, v = static_cast<double>(j) / grid.nv;
      const double wrappedU = grid.closedU && i == grid.nu ? 0 : u,
                   wrappedV = grid.closedV && j == grid.nv ? 0 : v;
      // Derivatives a little inside an open border, where poles have none.
      const double du = inside(wrappedU, grid.closedU), dv = inside(wrappedV, grid.closedV);
      const dvec3 alongU = f(du + kStep, dv) - f(du - kStep, dv);
      const dvec3 alongV = f(du, dv + kStep) - f(du, dv - kStep);
      mesh.addVertex(Vec3(f(wrappedU, wrappedV)), Vec3(glm::normalize(glm::cross(alongU, alongV))),
                     Vec2(static_cast<float>(u), static_cast<float>(1 - v)));
    }
  }
  const auto stride = static_cast<std::uint32_t>(grid.nu + 1);
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(grid.nv); ++j)
    for (std::uint32_t i = 0; i + 1 < stride; ++i) {
      const std::uint32_t a = j * stride + i;
      mesh.addQuad(a, a + 1, a + stride + 1, a + stride);
    }
  return mesh;
}

MeshData tube(const std::function<dvec3(double t)>& curve, const std::function<double(double t)>& radius,
              int lengthSteps, int aroundSteps) {
  constexpr double kCap = 0.04;  // share of the length that closes an end
  const dvec3 reference = glm::normalize(dvec3(0.31, 0.83, 0.47));
  return parametric({aroundSteps, lengthSteps, true, false}, [&](double u, double v) {
    const double fromEnd = std::min(v, 1 - v) / kCap;
    const double close = fromEnd >= 1 ? 1 : std::sqrt(std::max(0.0, fromEnd * (2 - fromEnd)));
    const double t = std::clamp(v, 1e-3, 1 - 1e-3);
    const dvec3 tangent = glm::normalize(curve(t + 1e-3) - curve(t - 1e-3));
    const dvec3 side = glm::normalize(glm::cross(tangent, reference)), up = glm::cross(side, tangent);
    const double angle = -kTau * u, r = v <= 0 || v >= 1 ? 0 : radius(v) * close;
    return curve(v) + r * (std::cos(angle) * side + std::sin(angle) * up);
  });
}

MeshData frame(float width, float height, float border, float depth, int profileSteps) {
  MeshData mesh;
  const std::array<Vec2, 4> corners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::size_t side = 0; side < 4; ++side) {
    const Vec2 from = corners[side], to = corners[(side + 1) % 4];
    const Vec2 along = glm::normalize(to - from), out(along.y, -along.x);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int k = 0; k <= profileSteps; ++k) {
      // A half ellipse leaning outwards: steep at the wall, shallow at the picture.
      const float angle = core::kPi * static_cast<float>(k) / static_cast<float>(profileSteps);
      const float across = 0.5f * border * (1 - std::cos(angle)), lift = depth * std::sin(angle);
      const Vec2 slope(-depth * std::cos(angle), 0.5f * border * std::sin(angle));
      const Vec3 normal(out * slope.x, slope.y);
      const Vec2 half = 0.5f * Vec2(width, height) + Vec2(across);
      const float v = static_cast<float>(k) / static_cast<float>(profileSteps);
      mesh.addVertex(Vec3(from * half, lift), normal, {glm::dot(from * half, along) / (4 * border), v});
      mesh.addVertex(Vec3(to * half, lift), normal, {glm::dot(to * half, along) / (4 * border), v});
    }
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(profileSteps); ++k) {
      const std::uint32_t a = first + 2 * k;
      mesh.addQuad(a, a + 2, a + 3, a + 1);
    }
  }
  return mesh;
}

MeshData openCase(const Vec3& size) {
  MeshData mesh;
  for (const Face& face : kFaces) {
    if (face.out.y < 0) continue;
    const Vec3 u = face.u * size, v = face.v * size;
    mesh.append(panel(0.5f * (face.out * size - u - v) + Vec3(0, 0.5f * size.y, 0), u, v));
  }
  return mesh;
}

namespace {

void addFacet(MeshData& mesh, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = glm::cross(b - a, c - a);
  const std::uint32_t i = mesh.addVertex(a, normal, {0, 0});
  mesh.addVertex(b, normal, {1, 0});
  mesh.addVertex(c, normal, {1, 1});
  mesh.addTriangle(i, i + 1, i + 2);
}

}  // namespace

MeshData cutStone(float radius, float height, int sides) {
  MeshData mesh;
  const auto ring = [&](float r, float y, int k, float shift) {
    const float angle = 2 * core::kPi * (static_cast<float>(k % sides) + shift) / static_cast<float>(sides);
    return Vec3(r * std::cos(angle), y, -r * std::sin(angle));
  };
  const Vec3 tip(0), top(0, height, 0);
  for (int k = 0; k < sides; ++k) {
    const Vec3 girdle0 = ring(radius, 0.62f * height, k, 0), girdle1 = ring(radius, 0.62f * height, k + 1, 0);
    const Vec3 table0 = ring(0.58f * radius, height, k, 0.5f),
               table1 = ring(0.58f * radius, height, k + 1, 0.5f);
    addFacet(mesh, tip, girdle1, girdle0);
    addFacet(mesh, girdle0, girdle1, table0);
    addFacet(mesh, girdle1, table1, table0);
    addFacet(mesh, top, table0, table1);
  }
  return mesh;
}

}  // namespace saccade::data
