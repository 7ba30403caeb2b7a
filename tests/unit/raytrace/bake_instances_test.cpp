// Illumination maps of instances: each object has its own light, as if it had a mesh of its own.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <set>

#include "core/scene/instances.h"
#include "raytrace/bake/texel_map.h"
#include "tests/unit/raytrace/bake_scenes.h"

namespace saccade::raytrace {
namespace {

using core::Mat4;
using core::Vec3;

/// A unit cube of two triangles a side, one mesh, normals of its faces.
core::Mesh cube() {
  core::Mesh m;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {0.0f, 1.0f}) {
      Vec3 u(0), v(0), n(0);
      u[(axis + 1) % 3] = v[(axis + 2) % 3] = 1;
      n[axis] = side > 0 ? 1.0f : -1.0f;
      if (side == 0) std::swap(u, v);
      const auto first = static_cast<std::uint32_t>(m.positions.size());
      for (const Vec3& p : {Vec3(0), u, u + v, v}) {
        Vec3 at = p;
        at[axis] = side;
        m.positions.push_back(at);
        m.normals.push_back(n);
      }
      for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) m.indices.push_back(first + k);
    }
  }
  return m;
}

/// A floor, a lamp above its left end, and one cube below the lamp, a mirrored and stretched one farther off,
/// and one twice as large at the other end.
core::Scene cubes() {
  SceneBuilder b;
  b.quad(SceneBuilder::matte(0.6f), Vec3(-6, 0, -3), Vec3(0, 0, 6), Vec3(12, 0, 0));
  b.disk(SceneBuilder::matte(0, Vec3(20)), Vec3(-4, 4, 0), 0.7f, 24);
  core::Scene& scene = b.scene;
  core::Mesh mesh = cube();
  mesh.instanced = true;
  scene.meshes.push_back(mesh);
  scene.materials.push_back(SceneBuilder::matte(0.5f));
  const auto at = [](Vec3 to, Vec3 scale) {
    return glm::translate(Mat4(1), to) * glm::scale(Mat4(1), scale);
  };
  for (const Mat4& place : {at(Vec3(-4.5f, 0.01f, -0.5f), Vec3(1)), at(Vec3(1, 0.01f, -1), Vec3(-1, 1, 1.5f)),
                            at(Vec3(3, 0.01f, -1), Vec3(2))}) {
    core::Object o;
    o.name = "cube";
    o.mesh = static_cast<std::uint32_t>(scene.meshes.size()) - 1;
    o.material = static_cast<int>(scene.materials.size()) - 1;
    o.meshToWorld = place;
    for (const Vec3& p : mesh.positions) o.bounds.add(Vec3(place * core::Vec4(p, 1)));
    scene.bounds.add(o.bounds);
    scene.objects.push_back(o);
  }
  return scene;
}

core::Scene flattened(core::Scene scene) {
  core::chooseInstances(scene, ~std::size_t{0});
  return scene;
}

TEST(BakeInstances, EveryInstanceHasTexelsOfItsOwn) {
  core::Scene scene = cubes();
  core::Plan plan;
  plan.lightmapSize = 192;
  const ChartAtlas atlas = makeCharts(scene, plan, 192);
  core::applyCharts(scene, atlas.charts);
  EXPECT_EQ(atlas.charts.places[2].x, 1);
  EXPECT_EQ(atlas.charts.places[3].x, 1);
  EXPECT_EQ(atlas.charts.places[4].x, 2);
  const TexelMap texels(scene, atlas.size);
  std::vector<double> area(scene.objects.size(), 0);
  for (std::size_t texel = 0; texel < texels.texelCount(); ++texel) {
    std::set<std::uint32_t> objects;
    for (const TexelFragment& f : texels.fragments(texel)) {
      objects.insert(f.object);
      area[f.object] += f.area;
    }
    ASSERT_LE(objects.size(), 1u) << "texel " << texel;
  }
  EXPECT_NEAR(area[2], 6, 0.01);
  EXPECT_NEAR(area[3], 2 * (1 + 1.5 + 1.5), 0.01);
  EXPECT_NEAR(area[4], 24, 0.04);
  EXPECT_EQ(texels.charts().size(), 1u + 3 * 6u);  // the lamp is black
}

TEST(BakeInstances, LightIsThatOfTheFlattenedScene) {
  BakeOptions options;
  options.quality = "preview";
  options.photons = 1 << 18;
  const Baked shared(cubes(), 192, options), flat(flattened(cubes()), 192, options);
  const core::Scene& scene = shared.scene();
  double light[3] = {0, 0, 0};
  for (int object = 2; object < 5; ++object) {
    const Mat4& place = scene.objects[static_cast<std::size_t>(object)].meshToWorld;
    for (int axis = 0; axis < 3; ++axis) {
      for (const float side : {0.0f, 1.0f}) {
        if (axis == 1 && side == 0) continue;  // stands on the floor
        double a = 0, b = 0;
        for (int i = 0; i < 64; ++i) {
          Vec3 p;
          p[axis] = side;
          p[(axis + 1) % 3] = (static_cast<float>(i % 8) + 0.5f) / 8;
          p[(axis + 2) % 3] = (static_cast<float>(i / 8) + 0.5f) / 8;
          const Vec3 world(place * core::Vec4(p, 1));
          a += shared.irradiance(object, world).x / 64;
          b += flat.irradiance(object, world).x / 64;
        }
        EXPECT_NEAR(a, b, 0.03 * b + 0.01) << "object " << object << " axis " << axis << " side " << side;
        if (axis == 1) light[object - 2] = a;
      }
    }
  }
  EXPECT_GT(light[0], 5 * light[1]);  // below the lamp, and far from it
  EXPECT_GT(light[1], light[2]);
}

TEST(BakeInstances, CubesInTheSamePlaceHaveTheSameLight) {
  core::Scene scene = cubes();
  scene.objects[3].meshToWorld = scene.objects[2].meshToWorld;
  BakeOptions options;
  options.quality = "preview";
  options.photons = 1 << 18;
  const Baked baked(scene, 192, options);
  for (int i = 0; i < 10; ++i) {
    const Vec3 side = Vec3(-3.5f, 0.1f * static_cast<float>(i) + 0.05f, 0.1f);  // lit by the floor too
    const double met = baked.irradiance(2, side).x, twin = baked.irradiance(3, side).x;
    EXPECT_NEAR(met, twin, 0.05 * met);
  }
}

}  // namespace
}  // namespace saccade::raytrace
