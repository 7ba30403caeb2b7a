// Real scenes load, and load right.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/scene/load.h"
#include "core/scene/plan.h"
#include "tests/shared_folder.h"

namespace saccade::core {
namespace {

const Object* named(const Scene& scene, const std::string& name) {
  for (const Object& o : scene.objects)
    if (o.name == name) return &o;
  return nullptr;
}

const Material& materialOf(const Scene& scene, const Object& o) {
  return scene.materials[static_cast<std::size_t>(o.material)];
}

/// What holds for every completed scene.
void expectWhole(const Scene& scene) {
  EXPECT_FALSE(scene.cameras.empty());
  EXPECT_EQ(scene.hierarchy.size(), 2 * scene.objects.size() - 1);
  std::uint32_t ids = 0;
  for (const Object& o : scene.objects) {
    const Mesh& mesh = scene.meshOf(o);
    const std::size_t n = mesh.positions.size();
    EXPECT_EQ(mesh.normals.size(), n);
    EXPECT_TRUE(mesh.tangents.empty() || mesh.tangents.size() == n);
    EXPECT_EQ(materialOf(scene, o).needsTangents() ? n : 0, mesh.tangents.size());
    EXPECT_TRUE(
        std::all_of(mesh.indices.begin(), mesh.indices.end(), [&](std::uint32_t i) { return i < n; }));
    EXPECT_TRUE(std::all_of(mesh.normals.begin(), mesh.normals.end(),
                            [](const Vec3& v) { return std::abs(glm::length(v) - 1) < 1e-4f; }));
    if (o.id != 0) {
      EXPECT_EQ(o.id, ++ids);
    }
  }
  EXPECT_NO_THROW(View(scene.cameras[0], 64, 64, scene.bounds));
}

TEST(SharedScenes, CornellGlossy) {
  SACCADE_SHARED_FILE(path, "references/cycles/cornell_glossy.glb");
  const Scene scene = loadScene(path, {});
  expectWhole(scene);
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.idCount(), 3u);
  for (const char* name : {"mirror_sphere", "glass_sphere", "glossy_box"}) {
    ASSERT_TRUE(named(scene, name)) << name;
    EXPECT_NE(named(scene, name)->id, 0u);
    EXPECT_TRUE(named(scene, name)->closed) << name;
  }
  EXPECT_EQ(materialOf(scene, *named(scene, "glass_sphere")).transmission, 1);
  EXPECT_EQ(nonDiffuseAlbedo(scene, materialOf(scene, *named(scene, "floor"))), 0);
  EXPECT_EQ(scene.cameras[0].eye, Vec3(0, 1, 3.8f));
  EXPECT_NEAR(scene.cameras[0].fovYDegrees, 39.5, 0.01);
  const Plan plan = makePlan(scene);
  EXPECT_TRUE(plan.corrections && plan.glossy && plan.refraction && plan.doubleSided);
  EXPECT_FALSE(plan.alphaTest || plan.normalMaps);
  EXPECT_EQ(plan.recursionDepth, 8);
}

TEST(SharedScenes, CornellBoxes) {
  for (const auto& [file, ids, triangles] :
       {std::tuple{"Original", 0u, 36u}, {"Mirror", 1u, 36u}, {"Sphere", 2u, 2188u}}) {
    SACCADE_SHARED_FILE(path, std::string("scenes/cornell/CornellBox-") + file + ".obj");
    const Scene scene = loadScene(path, {});
    expectWhole(scene);
    EXPECT_EQ(scene.idCount(), ids) << file;
    EXPECT_EQ(scene.triangleCount(), triangles);
    EXPECT_FALSE(scene.defaultLight);
    ASSERT_TRUE(named(scene, "light"));
    EXPECT_LT(scene.meshOf(*named(scene, "light")).normals[0].y, -0.99f);  // its front faces the room
    EXPECT_GT(scene.cameras[0].eye.z, 1.5f);                               // before the open side
  }
}

TEST(SharedScenes, CornellSpheresAreMirrorAndGlass) {
  SACCADE_SHARED_FILE(path, "scenes/cornell/CornellBox-Sphere.obj");
  const Scene scene = loadScene(path, {});
  const Object *left = named(scene, "leftSphere"), *right = named(scene, "rightSphere");
  ASSERT_TRUE(left && right);
  EXPECT_TRUE(left->closed && right->closed);
  EXPECT_EQ(materialOf(scene, *left).metallic, 1);
  EXPECT_EQ(materialOf(scene, *left).roughness, 0);
  EXPECT_EQ(materialOf(scene, *right).transmission, 1);
  EXPECT_EQ(materialOf(scene, *right).ior, 2.5f);
}

TEST(SharedScenes, ConferenceRoom) {
  SACCADE_SHARED_FILE(path, "scenes/conference/conference.obj");
  LoadOptions options;
  options.unitScale = 0.003f;
  const Scene scene = loadScene(path, options);
  expectWhole(scene);
  EXPECT_EQ(scene.triangleCount(), 331179u + 2u);  // and the default light
  EXPECT_TRUE(scene.defaultLight);
  EXPECT_TRUE(scene.bounds.contains(scene.cameras[0].eye));
  EXPECT_LT(scene.objects.size(), 1000u);
  EXPECT_NEAR(scene.bounds.extent().y, 1.96f, 0.01f);
}

TEST(SharedScenes, Rooms) {
  for (const auto& [file, triangles] :
       {std::pair{"vr-gallery", 1930u}, {"glass-table", 592u}, {"home-theater", 7915u}, {"garage", 11358u}}) {
    SACCADE_SHARED_FILE(path, std::string("scenes/rooms/") + file + ".glb");
    const Scene scene = loadScene(path, {});
    expectWhole(scene);
    EXPECT_NEAR(static_cast<double>(scene.triangleCount()), triangles, 12) << file;  // less what has no area
  }
}

TEST(SharedScenes, VrGalleryIsUnlitAndSeenFromInside) {
  SACCADE_SHARED_FILE(path, "scenes/rooms/vr-gallery.glb");
  const Scene scene = loadScene(path, {});
  EXPECT_FALSE(scene.defaultLight);
  EXPECT_TRUE(scene.materials[0].unlit);
  EXPECT_EQ(scene.idCount(), 0u);
  EXPECT_TRUE(scene.bounds.contains(scene.cameras[0].eye));
}

TEST(SharedScenes, GlassTableTransmits) {
  SACCADE_SHARED_FILE(path, "scenes/rooms/glass-table.glb");
  const Scene scene = loadScene(path, {});
  const Plan plan = makePlan(scene);
  EXPECT_TRUE(plan.refraction && plan.alphaTest && plan.corrections);
  EXPECT_TRUE(scene.defaultLight);
}

}  // namespace
}  // namespace saccade::core
