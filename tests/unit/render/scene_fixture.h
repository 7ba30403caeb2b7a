// Small scenes made by hand and contexts, for the tests of the base layer.
#pragma once

#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>
#include <string>
#include <utility>

#include "core/maps.h"
#include "core/scene/scene.h"
#include "core/scene/specular_albedo.h"
#include "render/context/gl_context.h"

namespace saccade::tests {

struct Thing {
  core::Object object;
  core::Mesh mesh;
};

/// A rectangle corner + s * a + t * b, facing along cross(a, b); UVs (s, t) in all sets.
inline Thing makeQuad(core::Vec3 corner, core::Vec3 a, core::Vec3 b, int material = 0, std::uint32_t id = 0) {
  Thing quad;
  auto& [object, mesh] = quad;
  object.material = material;
  object.id = id;
  for (const core::Vec2 uv : {core::Vec2(0, 0), core::Vec2(1, 0), core::Vec2(1, 1), core::Vec2(0, 1)}) {
    mesh.positions.push_back(corner + uv.x * a + uv.y * b);
    mesh.normals.push_back(glm::normalize(glm::cross(a, b)));
    mesh.uv0.push_back(uv);
    mesh.uv1.push_back(uv);
    mesh.lightmapUv.push_back(uv);
    object.bounds.add(mesh.positions.back());
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return quad;
}

inline Thing makeBox(core::Vec3 lo, core::Vec3 hi, int material = 0, std::uint32_t id = 0) {
  Thing box;
  box.object.material = material;
  box.object.id = id;
  box.object.closed = true;
  const core::Vec3 e = hi - lo;
  const core::Vec3 x(e.x, 0, 0), y(0, e.y, 0), z(0, 0, e.z);
  for (const Thing& side : {makeQuad(lo, y, x), makeQuad(lo + z, x, y), makeQuad(lo, x, z),
                            makeQuad(lo + y, z, x), makeQuad(lo, z, y), makeQuad(lo + x, y, z)}) {
    const auto base = static_cast<std::uint32_t>(box.mesh.positions.size());
    const core::Mesh& m = side.mesh;
    box.mesh.positions.insert(box.mesh.positions.end(), m.positions.begin(), m.positions.end());
    box.mesh.normals.insert(box.mesh.normals.end(), m.normals.begin(), m.normals.end());
    box.mesh.uv0.insert(box.mesh.uv0.end(), m.uv0.begin(), m.uv0.end());
    box.mesh.uv1.insert(box.mesh.uv1.end(), m.uv1.begin(), m.uv1.end());
    box.mesh.lightmapUv.insert(box.mesh.lightmapUv.end(), m.lightmapUv.begin(), m.lightmapUv.end());
    for (std::uint32_t index : m.indices) box.mesh.indices.push_back(base + index);
    box.object.bounds.add(side.object.bounds);
  }
  return box;
}

inline void addObject(core::Scene& scene, Thing thing) {
  scene.bounds.add(thing.object.bounds);
  scene.add(std::move(thing.object), std::move(thing.mesh));
}

inline core::Material lambert(core::Vec3 color) {
  core::Material m;
  m.baseColor = color;
  m.metallic = 0;
  m.roughness = 1;
  return m;
}

/// One quad of 2 x 2 m at z = -2 around the line of sight, facing the default camera (eye 0, looking to -z).
inline core::Scene oneQuad(const core::Material& material, std::uint32_t id = 0) {
  core::Scene scene;
  scene.materials.push_back(material);
  addObject(scene, makeQuad({-1, -1, -2}, {2, 0, 0}, {0, 2, 0}, 0, id));
  return scene;
}

/// The same quad seen from behind by the default camera.
inline core::Scene oneQuadFromBehind(const core::Material& material) {
  core::Scene scene;
  scene.materials.push_back(material);
  addObject(scene, makeQuad({-1, -1, -2}, {0, 2, 0}, {2, 0, 0}));
  return scene;
}

/// Maps whose layer i is `irradiance[i]` everywhere.
inline core::IlluminationMaps constantMaps(const std::vector<core::Vec3>& irradiance) {
  core::IlluminationMaps maps;
  maps.width = 5;  // odd, so that rows are not aligned to 4 bytes
  maps.height = 3;
  maps.layers = static_cast<int>(irradiance.size());
  for (const core::Vec3& layer : irradiance) {
    for (int i = 0; i < maps.width * maps.height; ++i) {
      for (int c = 0; c < 3; ++c) maps.texels.push_back(glm::packHalf1x16(layer[c]));
    }
  }
  return maps;
}

inline core::Texture makeTexture(int width, int height, std::vector<core::Rgba8> texels, bool srgb) {
  core::Texture texture;
  texture.image = core::ImageRgba8(width, height);
  texture.image.pixels() = std::move(texels);
  texture.nearest = true;
  texture.wrapS = texture.wrapT = core::Wrap::clamp;
  texture.srgb = srgb;
  return texture;
}

/// Runs each test in each off-screen context.
class EachContext : public testing::TestWithParam<render::ContextKind> {
 protected:
  std::unique_ptr<render::GlContext> context_ = render::makeHeadlessContext(GetParam());
};

#define SACCADE_EACH_CONTEXT(suite)                                                            \
  INSTANTIATE_TEST_SUITE_P(                                                                    \
      Headless, suite, testing::Values(render::ContextKind::osmesa, render::ContextKind::egl), \
      [](const auto& p) { return std::string(p.param == render::ContextKind::osmesa ? "osmesa" : "egl"); })

}  // namespace saccade::tests
