// completeScene: clusters, watertightness, ids, repairs, normals, tangents, default light and camera.
#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "core/scene/clusters.h"
#include "core/scene/load.h"
#include "core/scene/mesh_repair.h"
#include "tests/hard_case.h"
#include "tests/unit/core/scene_shapes.h"

namespace saccade::core {
namespace {

using namespace saccade::tests;

Scene twoMaterials() {
  Scene scene;
  scene.path = "test";
  scene.materials = {lambert(), mirror(), clearGlass(), lamp()};
  return scene;
}

bool warned(const Scene& scene, const std::string& part) {
  for (const std::string& w : scene.warnings)
    if (w.find(part) != std::string::npos) return true;
  return false;
}

TEST(Clusters, ConnectedMeshIsOneWatertightCluster) {
  const auto clusters = clusterMesh(boxMesh(Vec3(0), Vec3(1)), false);
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_TRUE(clusters[0].closed);
  EXPECT_EQ(clusters[0].triangles.size(), 12u);
}

TEST(Clusters, AMissingOrTurnedTriangleIsNotWatertight) {
  Mesh open = boxMesh(Vec3(0), Vec3(1));
  open.indices.resize(33);
  EXPECT_FALSE(clusterMesh(open, false)[0].closed);
  Mesh turned = boxMesh(Vec3(0), Vec3(1));
  std::swap(turned.indices[0], turned.indices[1]);
  EXPECT_FALSE(clusterMesh(turned, false)[0].closed);
}

TEST(Clusters, WeldsByPositionAcrossSplitVertices) {
  const Mesh box = boxMesh(Vec3(0), Vec3(1));
  Mesh soup = gatherVertices(box, box.indices);
  for (std::uint32_t i = 0; i < box.indices.size(); ++i) soup.indices.push_back(i);
  const auto clusters = clusterMesh(soup, false);
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_TRUE(clusters[0].closed);
}

TEST(Clusters, FarPartsSplitNearOnesStayTogether) {
  const Mesh near = joined(boxMesh(Vec3(0), Vec3(1)), boxMesh(Vec3(1.05f, 0, 0), Vec3(2, 1, 1)));
  EXPECT_EQ(clusterMesh(near, false).size(), 1u);
  const auto far = clusterMesh(joined(near, boxMesh(Vec3(5, 0, 0), Vec3(6, 1, 1))), false);
  ASSERT_EQ(far.size(), 2u);
  EXPECT_EQ(far[0].triangles.size(), 24u);
  EXPECT_EQ(far[1].triangles.size(), 12u);
  EXPECT_EQ(far[1].triangles.front(), 24u);
}

TEST(Clusters, ManyTinyPartsAreNotManyClusters) {
  Mesh grid;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) {
      const Vec3 at(static_cast<float>(i), static_cast<float>(j), 0);
      grid = joined(std::move(grid), boxMesh(at, at + Vec3(0.5f)));
    }
  EXPECT_EQ(clusterMesh(grid, false).size(), 1u);
}

TEST(Clusters, TransmittingSolidsPartFromSheets) {
  Mesh sheet = boxMesh(Vec3(0.2f), Vec3(0.8f));
  sheet.indices.resize(6);
  const Mesh both = joined(boxMesh(Vec3(0), Vec3(1)), sheet);
  EXPECT_EQ(clusterMesh(both, false).size(), 1u);
  const auto parted = clusterMesh(both, true);
  ASSERT_EQ(parted.size(), 2u);
  EXPECT_TRUE(parted[0].closed);
  EXPECT_FALSE(parted[1].closed);
}

TEST(CompleteScene, IdsFollowNodePrimitiveCluster) {
  Scene scene = twoMaterials();
  addObject(scene, boxMesh(Vec3(0), Vec3(1)), 2, 7);
  addObject(scene, joined(boxMesh(Vec3(9, 0, 0), Vec3(10, 1, 1)), boxMesh(Vec3(3, 0, 0), Vec3(4, 1, 1))), 1,
            2, 1);
  addObject(scene, boxMesh(Vec3(0, 5, 0), Vec3(1, 6, 1)), 0, 2, 0);
  completeScene(scene, {});
  ASSERT_EQ(scene.objects.size(), 5u);  // and the default light
  EXPECT_EQ(scene.idCount(), 3u);
  std::uint32_t expected = 1;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& o = scene.objects[i];
    if (o.id != 0) {
      EXPECT_EQ(o.id, expected++);
    }
    if (i == 0) continue;
    const Object& before = scene.objects[i - 1];
    EXPECT_LT(std::tie(before.node, before.primitive, before.cluster),
              std::tie(o.node, o.primitive, o.cluster));
  }
  std::set<std::string> names;
  for (const Object& o : scene.objects) names.insert(o.name);
  EXPECT_EQ(names.size(), scene.objects.size());
}

TEST(CompleteScene, ThresholdDecidesWhoGetsAnId) {
  Scene scene = twoMaterials();
  Material plastic;
  plastic.metallic = 0;
  plastic.roughness = 0.5f;
  scene.materials.push_back(plastic);
  addObject(scene, boxMesh(Vec3(0), Vec3(1)), 4, 0);
  Scene strict = scene;
  completeScene(scene, {});
  EXPECT_EQ(scene.idCount(), 0u);
  LoadOptions all;
  all.nonDiffuseThreshold = 0;
  completeScene(strict, all);
  EXPECT_EQ(strict.idCount(), 1u);
}

TEST(CompleteScene, Hard5DropsWhatCannotBeDrawnAndCounts) {
  Scene scene = twoMaterials();
  Mesh m = boxMesh(Vec3(0), Vec3(1));
  m.positions.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0, 0);
  m.indices.insert(m.indices.end(), {0, 1, 8});   // not finite
  m.indices.insert(m.indices.end(), {0, 1, 99});  // out of range
  m.indices.insert(m.indices.end(), {0, 0, 1});   // no area
  m.uv0.resize(3);
  addObject(scene, m, 3, 0);
  completeScene(scene, {});
  HardCase kept = HardCase::counting(
      "NaN, zero-area and out-of-range triangles of a file that are kept or uncounted", "triangles");
  EXPECT_TRUE(kept.near(static_cast<double>(scene.triangleCount()), 12, 0));
  EXPECT_TRUE(kept.within(!warned(scene, "3 triangles were dropped"), 0));
  EXPECT_TRUE(warned(scene, "1 vertex arrays"));
  EXPECT_EQ(scene.bounds.hi, Vec3(1));
}

TEST(CompleteScene, NothingLeftIsAnError) {
  Scene scene = twoMaterials();
  EXPECT_THROW(completeScene(scene, {}), Error);
}

TEST(CompleteScene, Hard5SmallAndNeedleTrianglesSurvive) {
  Scene scene = twoMaterials();
  Mesh m = boxMesh(Vec3(0), Vec3(1e-12f));
  addObject(scene, m, 3, 0);
  Mesh needle;
  needle.positions = {Vec3(0), Vec3(1000, 0, 0), Vec3(500, 1e-5f, 0)};
  needle.indices = {0, 1, 2};
  addObject(scene, needle, 3, 1);
  completeScene(scene, {});
  EXPECT_TRUE(HardCase::counting("needles of a file that are lost", "triangles")
                  .near(static_cast<double>(scene.triangleCount()), 13, 0));
}

TEST(CompleteScene, FlatNormalsAreTheFaces) {
  Scene scene = twoMaterials();
  addObject(scene, boxMesh(Vec3(0), Vec3(2, 3, 4)), 3, 0);
  completeScene(scene, {});
  const Mesh& m = scene.meshes[0];
  ASSERT_EQ(m.normals.size(), m.positions.size());
  ASSERT_EQ(m.positions.size(), 36u);
  const Vec3 center(1, 1.5f, 2);
  for (std::size_t i = 0; i < m.indices.size(); i += 3) {
    const Vec3 a = m.positions[m.indices[i]], b = m.positions[m.indices[i + 1]],
               c = m.positions[m.indices[i + 2]];
    const Vec3 face = glm::normalize(glm::cross(b - a, c - a));
    EXPECT_GT(glm::dot(face, a - center), 0);
    for (std::size_t k = i; k < i + 3; ++k) EXPECT_LT(glm::length(m.normals[m.indices[k]] - face), 1e-6f);
  }
}

TEST(MeshRepair, TangentsFollowTheTexture) {
  Mesh m;  // a wall in the x-y plane; u to the right, v down
  m.positions = {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(2, 1, 0), Vec3(0, 1, 0)};
  m.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  m.normals.assign(4, Vec3(0, 0, 2));
  m.indices = {0, 1, 2, 0, 2, 3};
  Mesh mirrored = m;
  for (Vec2& uv : mirrored.uv0) uv.x = 1 - uv.x;
  RepairCounts counts;
  Material bumpy;
  bumpy.normalTexture.texture = 0;
  repairMesh(m, bumpy, counts);
  repairMesh(mirrored, bumpy, counts);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(m.normals[i], Vec3(0, 0, 1));
    EXPECT_LT(glm::length(m.tangents[i] - Vec4(1, 0, 0, 1)), 1e-6f);
    EXPECT_LT(glm::length(mirrored.tangents[i] - Vec4(-1, 0, 0, -1)), 1e-6f);
    // The bitangent points up the image in both.
    for (const Mesh* mesh : {&m, &mirrored}) {
      const Vec3 up = glm::cross(mesh->normals[i], Vec3(mesh->tangents[i])) * mesh->tangents[i].w;
      EXPECT_GT(up.y, 0.99f);
    }
  }
}

TEST(MeshRepair, MirroredPicturesShareNoTangents) {
  // Two quads side by side in the x-y plane; the right one shows the left one's picture mirrored, and the
  // vertices between them are shared.
  Mesh m;
  m.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(2, 1, 0)};
  m.uv0 = {{0, 1}, {1, 1}, {0, 1}, {0, 0}, {1, 0}, {0, 0}};
  m.normals.assign(6, Vec3(0, 0, 1));
  m.indices = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};
  Material bumpy;
  bumpy.normalTexture.texture = 0;
  RepairCounts counts;
  repairMesh(m, bumpy, counts);
  EXPECT_EQ(m.positions.size(), 8u);
  ASSERT_EQ(m.tangents.size(), 8u);
  for (std::size_t k = 0; k < m.indices.size(); ++k) {
    const bool left = k < 6;
    const Vec4 expected(left ? 1 : -1, 0, 0, left ? 1 : -1);
    EXPECT_LT(glm::length(m.tangents[m.indices[k]] - expected), 1e-6f) << "corner " << k;
  }
}

TEST(MeshRepair, TangentsWeighTrianglesByTheirAngleNotTheirSize) {
  // At the origin meet a small triangle over 90 degrees, whose picture's u runs along +x, and one of 2,500
  // times the area over 45 degrees, whose picture is turned: u along +y.
  Mesh m;
  m.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(-50, 0, 0), Vec3(-50, -50, 0)};
  m.uv0 = {{0, 0}, {1, 0}, {0, -1}, {0, -50}, {-50, -50}};
  m.normals.assign(5, Vec3(0, 0, 1));
  m.indices = {0, 1, 2, 0, 3, 4};
  Material bumpy;
  bumpy.normalTexture.texture = 0;
  RepairCounts counts;
  repairMesh(m, bumpy, counts);
  const Vec3 expected = glm::normalize(2.0f * Vec3(1, 0, 0) + Vec3(0, 1, 0));
  EXPECT_LT(glm::length(Vec3(m.tangents[0]) - expected), 1e-5f);
}

TEST(MeshRepair, UnusableNormalsAreRebuilt) {
  Mesh m = boxMesh(Vec3(-1), Vec3(1));
  m.normals.assign(8, Vec3(0));
  m.normals[3] = Vec3(std::numeric_limits<float>::infinity(), 0, 0);
  RepairCounts counts;
  repairMesh(m, Material{}, counts);
  EXPECT_EQ(counts.normals, 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(glm::length(m.normals[i]), 1, 1e-6);
    EXPECT_GT(glm::dot(m.normals[i], m.positions[i]), 0.5f);
  }
}

TEST(CompleteScene, DefaultLightInARoomHangsBelowTheCeiling) {
  Scene scene = twoMaterials();
  addObject(scene, turnedInsideOut(boxMesh(Vec3(-3, 0, -4), Vec3(3, 2.5f, 4))), 0, 0);
  completeScene(scene, {});
  ASSERT_TRUE(scene.defaultLight);
  ASSERT_EQ(scene.objects.size(), 2u);
  const Object& panel = scene.objects[1];
  EXPECT_EQ(panel.name, "default light");
  EXPECT_EQ(scene.materials[panel.material].emission, Vec3(15));
  EXPECT_NEAR(panel.bounds.center().y, 0.95f * 2.5f, 1e-5f);
  EXPECT_NEAR(panel.bounds.extent().x, 1, 1e-6f);
  EXPECT_NEAR(panel.bounds.extent().z, 1, 1e-6f);
  for (const Vec3& n : scene.meshOf(panel).normals) EXPECT_EQ(n, Vec3(0, -1, 0));
  const auto& p = scene.meshOf(panel).positions;
  const auto& i = scene.meshOf(panel).indices;
  EXPECT_LT(glm::cross(p[i[1]] - p[i[0]], p[i[2]] - p[i[0]]).y, 0);
}

TEST(CompleteScene, ARoomThatIsNotInMetresIsLitAndSeenAndSaysSo) {
  struct Room {
    float unit;
    bool warns;
  };
  for (const Room& room : {Room{1, false}, Room{30, false}, Room{100, true}, Room{1000, true}}) {
    Scene scene = twoMaterials();
    const float u = room.unit;
    addObject(scene, turnedInsideOut(boxMesh(Vec3(-3, 0, -4) * u, Vec3(3, 2.5f, 4) * u)), 0, 0);
    completeScene(scene, {});
    ASSERT_TRUE(scene.defaultLight);
    const float side = scene.objects[1].bounds.extent().x, floor = 48 * u * u;
    EXPECT_NEAR(side * side, std::max(1.0f, floor / 200), 1e-4f * side * side);
    const float eye = scene.cameras[0].eye.y;
    EXPECT_NEAR(eye, room.warns ? 0.6f * 2.5f * u : std::min(1.6f, 1.5f * u), 1e-4f * u);
    const auto saysSo = [](const std::string& w) { return w.find("--unit-scale") != std::string::npos; };
    EXPECT_EQ(std::any_of(scene.warnings.begin(), scene.warnings.end(), saysSo), room.warns) << u;
  }
}

TEST(CompleteScene, DefaultLightHangsBelowWhatIsAboveTheMiddle) {
  // A shell around the room, as exporters leave it: the light must not hang between the two.
  Scene scene = twoMaterials();
  addObject(scene, turnedInsideOut(boxMesh(Vec3(-3, 0, -4), Vec3(3, 2.5f, 4))), 0, 0);
  addObject(scene, boxMesh(Vec3(-3.1f, -0.1f, -4.1f), Vec3(3.1f, 3.2f, 4.1f)), 0, 1);
  completeScene(scene, {});
  ASSERT_TRUE(scene.defaultLight);
  const float height = scene.objects.back().bounds.center().y;
  EXPECT_LT(height, 2.5f);
  EXPECT_GT(height, 2.25f);
}

TEST(CompleteScene, DefaultLightOfAThingScalesWithItAndLightsTheSideOneSees) {
  const auto panelOf = [](float size) {
    Scene scene = twoMaterials();
    addObject(scene, boxMesh(Vec3(-size), Vec3(size)), 0, 0);
    completeScene(scene, {});
    EXPECT_TRUE(scene.defaultLight);
    const Vec3 center = scene.objects[1].bounds.center();
    EXPECT_GT(glm::dot(scene.meshOf(scene.objects[1]).normals[0], -glm::normalize(center)), 1 - 1e-5f);
    EXPECT_GT(glm::dot(center, scene.cameras[0].eye), 0);
    const View view(scene.cameras[0], 64, 64, scene.bounds);
    for (const Vec3& p : scene.meshOf(scene.objects[1]).positions) {
      const auto at = view.project(p);
      EXPECT_FALSE(at && at->pixel.x > 0 && at->pixel.x < 64 && at->pixel.y > 0 && at->pixel.y < 64);
    }
    return scene.objects[1].bounds;
  };
  const Bounds small = panelOf(0.01f), large = panelOf(20);
  EXPECT_NEAR(glm::length(large.center()) / glm::length(small.center()), 2000, 0.1f);
  EXPECT_NEAR(large.diagonal() / small.diagonal(), 2000, 0.1f);
}

TEST(CompleteScene, DefaultLightComesFromTheSideOfTheFilesCamera) {
  for (const Vec3 eye : {Vec3(0, 1, -9), Vec3(7, -2, 3), Vec3(0, 9, 0)}) {
    Scene scene = twoMaterials();
    addObject(scene, boxMesh(Vec3(-1), Vec3(1)), 0, 0);
    Camera camera;
    camera.eye = eye;
    camera.at = Vec3(0);
    scene.cameras = {camera};
    completeScene(scene, {});
    const Vec3 panel = scene.objects[1].bounds.center();
    EXPECT_GT(panel.y, 1);
    EXPECT_GT(glm::dot(panel, eye), 0);
  }
}

TEST(CompleteScene, EmittersTooDimToSeeByGetADefaultLightUnlessTheUserLit) {
  const auto lit = [](float emission, bool option) {
    Scene scene = twoMaterials();
    addObject(scene, boxMesh(Vec3(0), Vec3(2)), 0, 0);
    addObject(scene, boxMesh(Vec3(3, 0, 0), Vec3(3.1f, 0.1f, 0.1f)), 3, 1);
    scene.materials[3].emission = Vec3(emission);
    LoadOptions options;
    if (option) options.lights = {"panel:at=0,5,0,size=1,1,radiance=0.01"};
    completeScene(scene, options);
    return scene.defaultLight;
  };
  EXPECT_TRUE(lit(1, false));
  EXPECT_FALSE(lit(200, false));
  EXPECT_FALSE(lit(1, true));
}

TEST(CompleteScene, ThingsBesideEachOtherAreNoRoom) {
  Scene scene = twoMaterials();
  addObject(scene, boxMesh(Vec3(-4, -2, -2), Vec3(-0.2f, 2, 2)), 0, 0);
  addObject(scene, boxMesh(Vec3(0.2f, -2, -2), Vec3(4, 2, 2)), 0, 1);
  completeScene(scene, {});
  EXPECT_FALSE(Bounds(scene.objects[0].bounds).contains(scene.cameras[0].eye));
  EXPECT_GT(glm::length(scene.cameras[0].eye), 4);
}

TEST(CompleteScene, NoDefaultLightWhereThereIsOneOrNoneIsNeeded) {
  const auto made = [](int material, bool point) {
    Scene scene = twoMaterials();
    Material unlit;
    unlit.unlit = true;
    scene.materials.push_back(unlit);
    addObject(scene, boxMesh(Vec3(0), Vec3(1)), material, 0);
    if (point) scene.lights.emplace_back();
    completeScene(scene, {});
    return scene.defaultLight;
  };
  EXPECT_TRUE(made(0, false));
  EXPECT_FALSE(made(0, true));
  EXPECT_FALSE(made(3, false));
  EXPECT_FALSE(made(4, false));
}

TEST(CompleteScene, DefaultCameraStandsInsideAClosedRoom) {
  Scene scene = twoMaterials();
  const Mesh room = turnedInsideOut(boxMesh(Vec3(-3, 0, -4), Vec3(3, 2.5f, 4)));
  addObject(scene, room, 0, 0);
  completeScene(scene, {});
  ASSERT_TRUE(scene.defaultCamera);
  const Camera& c = scene.cameras[0];
  EXPECT_EQ(c.fovYDegrees, 60);
  EXPECT_TRUE(scene.bounds.contains(c.eye));
  EXPECT_NEAR(c.eye.y, 1.5f, 0.2f);
  EXPECT_GT(std::abs(c.eye.z), 3);  // along the longer way
}

TEST(CompleteScene, DefaultCameraStandsBeforeTheOpenSide) {
  Scene scene = twoMaterials();
  Mesh box = turnedInsideOut(boxMesh(Vec3(-1, 0, -1), Vec3(1, 2, 1)));
  std::vector<std::uint32_t> kept;
  for (std::uint32_t t = 0; t < 12; ++t) {
    bool front = true;
    for (int k = 0; k < 3; ++k) front = front && box.positions[box.indices[3 * t + k]].z > 0;
    if (!front) kept.push_back(t);
  }
  addObject(scene, subMesh(box, kept), 0, 0);
  completeScene(scene, {});
  const Camera& c = scene.cameras[0];
  EXPECT_GT(c.eye.z, 1.5f);
  EXPECT_NEAR(c.eye.x, 0, 1e-5f);
  const View view(c, 64, 64, scene.bounds);
  for (const Vec3 corner : {Vec3(-1, 0, 1), Vec3(1, 2, 1)}) {
    const auto at = view.project(corner);
    ASSERT_TRUE(at);
    EXPECT_GE(at->pixel.x, 0);
    EXPECT_LE(at->pixel.x, 64);
  }
}

TEST(CompleteScene, DefaultCameraFramesAThingFromOutside) {
  Scene scene = twoMaterials();
  addObject(scene, boxMesh(Vec3(-2, 0, -2), Vec3(2, 3, 2)), 0, 0);
  completeScene(scene, {});
  const View view(scene.cameras[0], 100, 100, scene.bounds);
  for (const Vec3& p : scene.meshes[0].positions) {
    const auto at = view.project(p);
    ASSERT_TRUE(at);
    EXPECT_TRUE(at->pixel.x > 0 && at->pixel.x < 100 && at->pixel.y > 0 && at->pixel.y < 100);
  }
}

TEST(AddLight, ReadsEveryKind) {
  Scene scene = twoMaterials();
  addLight(scene, "point:pos=1,2,3,power=12.566371,0,0");
  addLight(scene, "spot:pos=0,2,0,dir=0,-2,0,power=1,angle=60");
  addLight(scene, "directional:dir=1,0,0,irradiance=2,3,4");
  addLight(scene, "panel:at=0,2,0,size=2,1,radiance=5,6,7");
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[0].position, Vec3(1, 2, 3));
  EXPECT_NEAR(scene.lights[0].intensity.x, 1, 1e-6f);
  EXPECT_EQ(scene.lights[1].direction, Vec3(0, -1, 0));
  EXPECT_NEAR(scene.lights[1].cosOuter, 0.5f, 1e-6f);
  EXPECT_EQ(scene.lights[2].intensity, Vec3(2, 3, 4));
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.materials[scene.objects[0].material].emission, Vec3(5, 6, 7));
  EXPECT_EQ(scene.meshes[0].normals[0], Vec3(0, -1, 0));
}

TEST(AddLight, RefusesWithAnExample) {
  Scene scene;
  for (const char* wrong :
       {"point", "point:", "lamp:pos=0,0,0", "point:pos=0,0,power=1", "point:pos=a,0,0,power=1",
        "point:power=1,1,1", "directional:dir=0,0,0,irradiance=1", "panel:at=0,0,0,size=0,1,radiance=1",
        "point:pos=0,0,0,power=1,colour=2"}) {
    try {
      addLight(scene, wrong);
      ADD_FAILURE() << wrong;
    } catch (const UsageError& e) {
      EXPECT_NE(std::string(e.what()).find("examples"), std::string::npos);
    }
  }
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_TRUE(scene.objects.empty());
}

}  // namespace
}  // namespace saccade::core
