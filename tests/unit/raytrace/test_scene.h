// Scenes made by hand for the tracer's tests; nothing is loaded or completed.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/scene/plan.h"
#include "core/scene/scene.h"

namespace saccade::tests {

using core::Vec2;
using core::Vec3;

/// Lambert alone: index 1 leaves no dielectric lobe.
inline core::Material diffuseMaterial(const Vec3& color, const Vec3& emission = Vec3(0)) {
  core::Material m;
  m.baseColor = color;
  m.metallic = 0;
  m.roughness = 1;
  m.ior = 1;
  m.emission = emission;
  return m;
}

inline core::Material metalMaterial(const Vec3& color, float roughness) {
  core::Material m;
  m.baseColor = color;
  m.metallic = 1;
  m.roughness = roughness;
  return m;
}

inline core::Material glassMaterial(float ior, float roughness) {
  core::Material m;
  m.metallic = 0;
  m.roughness = roughness;
  m.transmission = 1;
  m.ior = ior;
  return m;
}

class SceneMaker {
 public:
  core::Scene scene;

  int material(const core::Material& m) {
    scene.materials.push_back(m);
    return static_cast<int>(scene.materials.size()) - 1;
  }
  /// Flat normals; counter-clockwise seen from the front. `id` 0 = diffuse.
  core::Object& mesh(int materialIndex, std::uint32_t id, const std::vector<Vec3>& positions,
                     const std::vector<std::uint32_t>& indices, bool closed = false) {
    core::Object o;
    core::Mesh m;
    o.name = "object " + std::to_string(scene.objects.size());
    o.material = materialIndex;
    o.id = id;
    o.closed = closed;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      const Vec3 a = positions[indices[i]], b = positions[indices[i + 1]], c = positions[indices[i + 2]];
      const Vec3 cross = glm::cross(b - a, c - a);
      const Vec3 n = glm::length(cross) > 0 ? glm::normalize(cross) : Vec3(0, 1, 0);
      for (const Vec3& p : {a, b, c}) {
        m.indices.push_back(static_cast<std::uint32_t>(m.positions.size()));
        m.positions.push_back(p);
        m.normals.push_back(n);
        m.uv0.emplace_back(p.x, p.z);
        m.lightmapUv.emplace_back(0.5f, 0.5f);
        o.bounds.add(p);
      }
    }
    scene.bounds.add(o.bounds);
    return scene.add(std::move(o), std::move(m));
  }
  /// Corner, two edges; the front is where cross(e1, e2) points.
  core::Object& quad(int materialIndex, std::uint32_t id, const Vec3& corner, const Vec3& e1,
                     const Vec3& e2) {
    return mesh(materialIndex, id, {corner, corner + e1, corner + e1 + e2, corner + e2}, {0, 1, 2, 0, 2, 3});
  }
  /// Axis-aligned box; its front outwards, or inwards.
  core::Object& box(int materialIndex, std::uint32_t id, const Vec3& lo, const Vec3& hi,
                    bool inwards = false) {
    std::vector<Vec3> p;
    for (int i = 0; i < 8; ++i) p.emplace_back(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z);
    std::vector<std::uint32_t> indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                          2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    if (inwards) {
      for (std::size_t i = 0; i < indices.size(); i += 3) std::swap(indices[i + 1], indices[i + 2]);
    }
    return mesh(materialIndex, id, p, indices, true);
  }
  /// UV sphere with smooth normals.
  core::Object& sphere(int materialIndex, std::uint32_t id, const Vec3& center, float radius,
                       int rings = 32) {
    std::vector<Vec3> p;
    const int columns = 2 * rings;
    for (int i = 0; i <= rings; ++i) {
      for (int j = 0; j < columns; ++j) {
        const double theta = M_PI * i / rings, phi = 2 * M_PI * j / columns;
        const double s = i == 0 || i == rings ? 0 : std::sin(theta);
        p.push_back(center + radius * Vec3(s * std::cos(phi), std::cos(theta), s * std::sin(phi)));
      }
    }
    std::vector<std::uint32_t> indices;
    for (int i = 0; i < rings; ++i) {
      for (int j = 0; j < columns; ++j) {
        const std::uint32_t a = i * columns + j, b = i * columns + (j + 1) % columns;
        const std::uint32_t c = a + columns, d = b + columns;
        if (i > 0) indices.insert(indices.end(), {a, b, c});
        if (i < rings - 1) indices.insert(indices.end(), {b, d, c});
      }
    }
    core::Object& o = mesh(materialIndex, id, p, indices, true);
    core::Mesh& m = scene.meshOf(o);
    for (std::size_t i = 0; i < m.positions.size(); ++i) {
      m.normals[i] = glm::normalize(m.positions[i] - center);
    }
    return o;
  }
};

inline core::Plan planOf(int recursionDepth = 6) {
  core::Plan plan;
  plan.corrections = plan.glossy = plan.refraction = true;
  plan.recursionDepth = recursionDepth;
  return plan;
}

/// Uniform direction.
template <class Engine>
Vec3 randomDirection(Engine& engine) {
  std::uniform_real_distribution<float> u(0, 1);
  const float z = 2 * u(engine) - 1, phi = 2 * core::kPi * u(engine);
  const float s = std::sqrt(std::max(0.0f, 1 - z * z));
  return {s * std::cos(phi), s * std::sin(phi), z};
}

}  // namespace saccade::tests
