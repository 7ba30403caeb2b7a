// Which meshes stay shared, and that sharing changes nothing but memory.
#include "core/scene/instances.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "core/scene/clusters.h"
#include "core/scene/load.h"
#include "core/scene/placement.h"
#include "tests/unit/core/gltf_builder.h"
#include "tests/unit/core/scene_shapes.h"
#include "tests/unit/core/temporary_folder.h"

namespace saccade::core {
namespace {

using namespace saccade::tests;

/// Side by side unit quads in the x-y plane, two triangles each.
Mesh strip(int quads) {
  Mesh m;
  for (int i = 0; i <= quads; ++i) {
    m.positions.emplace_back(static_cast<float>(i), 0, 0);
    m.positions.emplace_back(static_cast<float>(i), 1, 0);
  }
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(quads); ++i)
    m.indices.insert(m.indices.end(), {2 * i, 2 * i + 2, 2 * i + 1, 2 * i + 1, 2 * i + 2, 2 * i + 3});
  m.normals.assign(m.positions.size(), Vec3(0, 0, 1));
  m.tangents.assign(m.positions.size(), Vec4(1, 0, 0, 1));
  return m;
}

/// `count` objects of one instanced mesh, material 0, at x = 0, 100, 200, ...
Scene sharedScene(Mesh mesh, int count) {
  Scene scene;
  scene.materials = {lambert(), mirror(), clearGlass(), lamp()};
  mesh.instanced = true;
  scene.meshes.push_back(std::move(mesh));
  for (int i = 0; i < count; ++i) {
    Object o;
    o.name = "object " + std::to_string(i);
    o.node = i;
    o.meshToWorld = glm::translate(Mat4(1), Vec3(100.0f * static_cast<float>(i), 0, 0));
    scene.objects.push_back(o);
  }
  return scene;
}

std::size_t instancedObjects(const Scene& scene) {
  std::size_t n = 0;
  for (const Object& o : scene.objects) n += scene.meshOf(o).instanced;
  return n;
}

TEST(ChooseInstances, SharesWhatPaysAndIsLargeEnough) {
  Scene scene = sharedScene(strip(32), 3);
  chooseInstances(scene, 128);  // saves exactly that
  EXPECT_EQ(instancedObjects(scene), 3u);
  scene = sharedScene(strip(32), 3);
  chooseInstances(scene, 129);
  EXPECT_EQ(instancedObjects(scene), 0u);
  scene = sharedScene(strip(31), 3);  // 62 triangles
  chooseInstances(scene, 0);
  EXPECT_EQ(instancedObjects(scene), 0u);
  scene = sharedScene(strip(32), 1);
  chooseInstances(scene, 0);
  EXPECT_EQ(instancedObjects(scene), 0u);
}

TEST(ChooseInstances, WhatCannotShareHasAMeshOfItsOwn) {
  Scene scene = sharedScene(strip(32), 7);
  scene.objects[1].material = 3;                                      // emits
  scene.objects[3].meshToWorld = glm::scale(Mat4(1), Vec3(1, 1, 0));  // flat
  scene.objects[4].meshToWorld[3].x = kInfinity;
  scene.objects[5].meshToWorld = glm::scale(Mat4(1), Vec3(1, 1, 1e-5f));  // next to flat
  chooseInstances(scene, 0);
  EXPECT_EQ(instancedObjects(scene), 3u);
  for (const std::size_t o : {0u, 2u, 6u}) EXPECT_EQ(scene.objects[o].mesh, 0u);
  for (const std::size_t o : {1u, 3u, 4u, 5u}) {
    EXPECT_EQ(scene.objects[o].meshToWorld, Mat4(1));
    EXPECT_EQ(scene.meshOf(scene.objects[o]).triangleCount(), 64u);
  }
}

TEST(ChooseInstances, FlatteningKeepsFrontsNormalsAndHandedness) {
  const Mat4 mirrored = glm::translate(Mat4(1), Vec3(1, 2, 3)) * glm::scale(Mat4(1), Vec3(-2, 1, 1));
  Scene scene = sharedScene(strip(1), 1);
  scene.objects[0].meshToWorld = mirrored;
  chooseInstances(scene, ~std::size_t{0});
  const Mesh& m = scene.meshOf(scene.objects[0]);
  EXPECT_FALSE(m.instanced);
  const auto corner = [&](std::size_t i) { return m.positions[m.indices[i]]; };
  EXPECT_GT(glm::cross(corner(1) - corner(0), corner(2) - corner(0)).z, 0);
  EXPECT_EQ(m.normals[0], Vec3(0, 0, 1));
  EXPECT_EQ(m.tangents[0], Vec4(-1, 0, 0, -1));
  EXPECT_EQ(m.positions[2], Vec3(-1, 2, 3));
}

TEST(ChooseInstances, CountsWhatIsStoredAndWhatIsShownApart) {
  Mesh large = strip(1 << 15);  // 2^16 triangles
  Scene scene = sharedScene(large, 1 << 14);
  chooseInstances(scene, 0);
  EXPECT_EQ(scene.triangleCount(), kMaxShownTriangles);
  EXPECT_EQ(scene.storedTriangleCount(), 1u << 16);
  scene.objects.push_back(scene.objects.front());
  EXPECT_THROW(chooseInstances(scene, 0), Error);
  scene.objects.resize(1025);
  for (Object& o : scene.objects) o.material = 3;  // every one would have to be copied
  EXPECT_THROW(chooseInstances(scene, 0), Error);
}

/// Whatever completeScene finds out about a scene does not depend on sharing.
TEST(CompleteScene, SharingChangesNothingButMemory) {
  Mesh boxes;  // three close together, three far away
  for (const float x : {0.0f, 1.05f, 2.1f, 30.0f, 31.05f, 32.1f})
    boxes = joined(std::move(boxes), boxMesh(Vec3(x, 0, 0), Vec3(x + 1, 1, 1)));
  Scene shared = sharedScene(boxes, 4);
  shared.objects[1].meshToWorld = shared.objects[1].meshToWorld * glm::scale(Mat4(1), Vec3(-1, 2, 1));
  shared.objects[2].material = 2;  // transmits: closed parts are kept apart
  Scene flat = shared;
  LoadOptions always, never;
  always.sharingPays = 0;
  never.sharingPays = ~std::size_t{0};
  completeScene(shared, always);
  completeScene(flat, never);
  EXPECT_EQ(instancedObjects(shared), shared.objects.size() - 1);  // the default light is alone
  EXPECT_EQ(instancedObjects(flat), 0u);
  EXPECT_EQ(shared.triangleCount(), flat.triangleCount());
  EXPECT_LE(2 * shared.storedTriangleCount(), shared.triangleCount() + 2);
  ASSERT_EQ(shared.objects.size(), flat.objects.size());
  for (std::size_t i = 0; i < shared.objects.size(); ++i) {
    const Object &a = shared.objects[i], &b = flat.objects[i];
    EXPECT_EQ(std::tie(a.name, a.id, a.closed, a.cluster), std::tie(b.name, b.id, b.closed, b.cluster));
    EXPECT_LT(glm::length(a.bounds.lo - b.bounds.lo) + glm::length(a.bounds.hi - b.bounds.hi), 1e-4f);
    EXPECT_NEAR(surfaceArea(shared, a), surfaceArea(flat, b), 1e-4);
  }
  EXPECT_EQ(shared.cameras[0].eye, flat.cameras[0].eye);
}

TEST(CompleteScene, OneMeshServesMaterialsWithAndWithoutTangents) {
  Mesh mesh = strip(40);
  mesh.tangents.clear();
  for (const Vec3& p : mesh.positions) mesh.uv0.emplace_back(p.x, -p.y);
  Scene scene = sharedScene(mesh, 2);
  Texture t;
  t.image = ImageRgba8(1, 1);
  scene.textures.push_back(t);
  scene.materials[1].normalTexture.texture = 0;
  scene.objects[1].material = 1;
  LoadOptions always;
  always.sharingPays = 0;
  completeScene(scene, always);
  EXPECT_EQ(scene.objects[0].mesh, scene.objects[1].mesh);
  ASSERT_EQ(scene.meshes[0].tangents.size(), scene.meshes[0].positions.size());
  EXPECT_EQ(scene.meshes[0].tangents[0], Vec4(1, 0, 0, 1));
}

TEST(GltfLoad, PrimitivesOfTheSameAccessorsAreOneMesh) {
  GltfBuilder b;
  const Mesh mesh = strip(40);
  std::vector<float> xyz;
  for (const Vec3& p : mesh.positions) xyz.insert(xyz.end(), {p.x, p.y, p.z});
  const int positions = b.floats("VEC3", xyz), indices = b.accessor("SCALAR", 5125, mesh.indices);
  const nlohmann::json primitive = {{"attributes", {{"POSITION", positions}}}, {"indices", indices}};
  nlohmann::json red = primitive, fan = primitive;
  red["material"] = 0;
  fan["mode"] = 6;
  b.json["materials"] = {{{"name", "red"}}};
  b.json["meshes"] = {{{"primitives", {primitive}}}, {{"primitives", {red}}}, {{"primitives", {fan}}}};
  b.json["nodes"] = {{{"mesh", 0}},
                     {{"mesh", 1}, {"translation", {0, 9, 0}}},
                     {{"mesh", 1}, {"scale", {-1, 1, 1}}},
                     {{"mesh", 2}}};
  b.json["scenes"] = {{{"nodes", {0, 1, 2, 3}}}};
  const TemporaryFolder folder;
  LoadOptions options;
  options.sharingPays = 0;
  const Scene scene = loadScene(b.write(folder.path() / "shared.glb"), options);
  ASSERT_EQ(scene.objects.size(), 5u);  // and the default light
  EXPECT_EQ(instancedObjects(scene), 3u);
  EXPECT_EQ(scene.objects[0].mesh, scene.objects[1].mesh);
  EXPECT_EQ(scene.objects[0].mesh, scene.objects[2].mesh);
  EXPECT_NE(scene.objects[0].mesh, scene.objects[3].mesh);
  EXPECT_NE(scene.objects[0].material, scene.objects[1].material);
  EXPECT_EQ(scene.objects[1].bounds.lo.y, 9);
  EXPECT_EQ(scene.objects[2].bounds.lo.x, -40);
  options.sharingPays = kSharingPays;
  EXPECT_EQ(instancedObjects(loadScene(folder.path() / "shared.glb", options)), 0u);
}

}  // namespace
}  // namespace saccade::core
