// Small meshes and scenes for the tests of scene completion.
#pragma once

#include "core/scene/scene.h"

namespace saccade::tests {

/// An axis-aligned box, 8 vertices, 12 triangles facing outwards, no normals.
inline core::Mesh boxMesh(const core::Vec3& lo, const core::Vec3& hi) {
  core::Mesh m;
  for (int i = 0; i < 8; ++i)
    m.positions.emplace_back(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z);
  m.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
               2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return m;
}

inline core::Mesh joined(core::Mesh a, const core::Mesh& b) {
  const auto base = static_cast<std::uint32_t>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (const std::uint32_t i : b.indices) a.indices.push_back(i + base);
  return a;
}

inline core::Mesh turnedInsideOut(core::Mesh m) {
  for (std::size_t i = 0; i + 2 < m.indices.size(); i += 3) std::swap(m.indices[i + 1], m.indices[i + 2]);
  return m;
}

inline core::Material lambert() {
  core::Material m;
  m.name = "lambert";
  m.metallic = 0;
  m.specular = 0;
  return m;
}

inline core::Material mirror() {
  core::Material m;
  m.name = "mirror";
  m.roughness = 0;
  return m;
}

inline core::Material clearGlass() {
  core::Material m;
  m.name = "glass";
  m.metallic = 0;
  m.roughness = 0;
  m.transmission = 1;
  return m;
}

inline core::Material lamp() {
  core::Material m = lambert();
  m.emission = core::Vec3(10);
  return m;
}

inline core::Object& addObject(core::Scene& scene, core::Mesh mesh, int material, int node,
                               int primitive = 0) {
  core::Object o;
  o.name = "object " + std::to_string(node);
  o.material = material;
  o.node = node;
  o.primitive = primitive;
  return scene.add(std::move(o), std::move(mesh));
}

}  // namespace saccade::tests
