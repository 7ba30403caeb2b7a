// The plan says what a scene needs, and why.
#include "core/scene/plan.h"

#include <gtest/gtest.h>

#include "core/scene/load.h"
#include "core/scene/median_edge.h"
#include "core/scene/specular_albedo.h"
#include "tests/unit/core/scene_shapes.h"

namespace saccade::core {
namespace {

using namespace saccade::tests;

Scene sceneOf(const std::vector<Material>& materials) {
  Scene scene;
  scene.materials = materials;
  for (int i = 0; i < static_cast<int>(materials.size()); ++i) {
    const float x = 3.0f * static_cast<float>(i);
    addObject(scene, boxMesh(Vec3(x, 0, 0), Vec3(x + 1, 1, 1)), i, i);
  }
  completeScene(scene, {});
  return scene;
}

const PlanLine& line(const Plan& plan, const std::string& stage) {
  for (const PlanLine& l : plan.lines)
    if (l.stage == stage) return l;
  throw Error("no line " + stage);
}

TEST(Plan, DiffuseSceneNeedsNothingBeyondTheMaps) {
  const Plan plan = makePlan(sceneOf({lambert(), lamp()}));
  EXPECT_FALSE(plan.corrections || plan.glossy || plan.refraction || plan.alphaTest || plan.normalMaps ||
               plan.doubleSided);
  EXPECT_EQ(plan.recursionDepth, 0);
  EXPECT_EQ(plan.diffuseEnergyLeftOut, 0);
  EXPECT_GE(plan.lightmapSize, 128);
  EXPECT_FALSE(line(plan, "corrections").on);
  EXPECT_TRUE(line(plan, "light sampling").on);
  for (const char* stage : {"medium", "volume", "motion"}) {
    EXPECT_FALSE(line(plan, stage).on);
    EXPECT_EQ(line(plan, stage).reason, "not in this scene");
  }
}

TEST(Plan, RecursionFollowsFromWhatOccurs) {
  EXPECT_EQ(makePlan(sceneOf({mirror(), lamp()})).recursionDepth, 4);
  EXPECT_EQ(makePlan(sceneOf({clearGlass(), lamp()})).recursionDepth, 8);
  EXPECT_EQ(makePlan(sceneOf({clearGlass(), clearGlass(), lamp()})).recursionDepth, 10);
  EXPECT_EQ(
      makePlan(sceneOf({clearGlass(), clearGlass(), clearGlass(), clearGlass(), lamp()})).recursionDepth, 12);
}

TEST(Plan, SeesEveryKindOfMaterial) {
  Material rough = mirror();
  rough.roughness = 0.4f;
  Material cutout = lambert();
  cutout.alphaMode = AlphaMode::mask;
  cutout.doubleSided = true;
  const Plan plan = makePlan(sceneOf({mirror(), rough, clearGlass(), cutout, lamp()}));
  EXPECT_TRUE(plan.corrections && plan.glossy && plan.refraction && plan.alphaTest && plan.doubleSided);
  EXPECT_FALSE(makePlan(sceneOf({mirror(), lamp()})).glossy);
  EXPECT_TRUE(line(plan, "object ids").on);
  EXPECT_NE(line(plan, "object ids").reason.find("3 ids"), std::string::npos);
}

TEST(Plan, LightmapStaysWithinItsMemoryAndSaysSo) {
  Material paper = lambert();
  paper.doubleSided = true;
  for (const Material& material : {lambert(), paper}) {
    const Scene scene = sceneOf({material, lamp()});
    for (const int megabytes : {1, 7, 64, 192}) {
      const Plan plan = makePlan(scene, megabytes);
      const double layers = material.doubleSided ? 2 : 1, side = plan.lightmapSize;
      EXPECT_LE(6 * layers * side * side, megabytes * double{1 << 20});
      EXPECT_TRUE(plan.lightmapSize == 4096 ||
                  6 * layers * (side + 64) * (side + 64) > megabytes * double{1 << 20})
          << side << " is not the largest multiple of 64 for " << megabytes;
      EXPECT_EQ(plan.lightmapSize % 64, 0);
      EXPECT_LT(plan.finestTexel, plan.coarsestTexel);
      const std::string& reason = line(plan, "illumination maps").reason;
      EXPECT_NE(reason.find(std::to_string(megabytes) + " MiB"), std::string::npos) << reason;
      EXPECT_NE(reason.find(std::to_string(plan.lightmapSize)), std::string::npos) << reason;
    }
  }
}

TEST(Plan, LightByVertexWantsManyVerticesAndShortEdges) {
  Scene scene = sceneOf({lambert(), lamp()});
  EXPECT_FALSE(line(makePlan(scene), "light by vertex").on);
  Mesh grid;
  constexpr std::uint32_t kSide = 40;
  for (std::uint32_t y = 0; y < kSide; ++y) {
    for (std::uint32_t x = 0; x < kSide; ++x) {
      grid.positions.emplace_back(1e-3f * static_cast<float>(x), 1e-3f * static_cast<float>(y), 0);
      const std::uint32_t v = y * kSide + x;
      if (x > 0 && y > 0) grid.indices.insert(grid.indices.end(), {v, v - 1, v - kSide});
    }
  }
  EXPECT_NEAR(medianEdge(grid), 1e-3, 1e-6);
  Object object;
  scene.add(std::move(object), std::move(grid));
  EXPECT_EQ(makePlan(scene).denseMeshes, 1u);
  EXPECT_TRUE(line(makePlan(scene), "light by vertex").on);
  for (Vec3& p : scene.meshes.back().positions) p *= 1000.0f;  // coarse: edges of a metre
  EXPECT_EQ(makePlan(scene).denseMeshes, 0u);
}

TEST(MedianEdge, OfAThreeFourFiveTriangle) {
  Mesh mesh;
  mesh.positions = {Vec3(0), Vec3(3, 0, 0), Vec3(0, 4, 0)};
  mesh.indices = {0, 1, 2};
  EXPECT_DOUBLE_EQ(medianEdge(mesh), 4);
  EXPECT_EQ(medianEdge({}), 0);
}

TEST(Plan, EnergyLeftOutIsTheAreaWeightedMean) {
  Material plastic;
  plastic.metallic = 0;
  plastic.roughness = 0.6f;
  Scene scene = sceneOf({plastic, lambert(), lamp()});  // three boxes of equal area
  const double albedo = nonDiffuseAlbedo(scene, plastic);
  EXPECT_GT(albedo, 0.03);
  EXPECT_NEAR(makePlan(scene).diffuseEnergyLeftOut, albedo / 3, 1e-5);
}

TEST(NonDiffuseAlbedo, ClosedForms) {
  const Scene scene;
  EXPECT_EQ(nonDiffuseAlbedo(scene, lambert()), 0);
  EXPECT_NEAR(nonDiffuseAlbedo(scene, mirror()), 1, 1e-5f);
  EXPECT_NEAR(nonDiffuseAlbedo(scene, clearGlass()), 1, 1e-5f);
  Material pane = lambert();
  pane.alphaMode = AlphaMode::blend;
  pane.alpha = 0.3f;
  EXPECT_NEAR(nonDiffuseAlbedo(scene, pane), 0.7f, 1e-6f);
  Material plastic;
  plastic.metallic = 0;
  plastic.roughness = 0.5f;
  const AlbedoPair mean = meanAlbedo(0.5f);
  EXPECT_NEAR(nonDiffuseAlbedo(scene, plastic), 0.04f * mean.scale + mean.bias, 1e-6f);
  plastic.unlit = true;
  EXPECT_EQ(nonDiffuseAlbedo(scene, plastic), 0);
}

TEST(NonDiffuseAlbedo, AveragesTexturesInLinearSpace) {
  Scene scene;
  Texture half;
  half.image = ImageRgba8(2, 1);
  half.image.at(0, 0) = {255, 0, 255, 255};  // metallic
  half.image.at(1, 0) = {255, 0, 0, 255};    // dielectric
  scene.textures.push_back(half);
  Texture grey;
  grey.image = ImageRgba8(1, 1, {188, 188, 188, 255});  // sRGB 188 is linear 0.5029
  grey.srgb = true;
  scene.textures.push_back(grey);
  Material m = mirror();
  m.specular = 0;
  m.metallicRoughnessTexture.texture = 0;
  EXPECT_NEAR(nonDiffuseAlbedo(scene, m), 0.5f, 1e-5f);
  m.metallicRoughnessTexture.texture = -1;
  m.baseColorTexture.texture = 1;
  const AlbedoPair e = meanAlbedo(0);
  EXPECT_NEAR(nonDiffuseAlbedo(scene, m), 0.5029f * e.scale + e.bias, 1e-4f);
}

}  // namespace
}  // namespace saccade::core
