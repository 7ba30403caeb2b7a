// bake --export: the light in the files, and the way back through --import.
#include "app/session/light_export.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/image_io.h"
#include "core/math/half.h"
#include "core/scene/load.h"
#include "core/srgb8.h"
#include "raytrace/bake/gutters.h"
#include "raytrace/bake/light_textures.h"
#include "raytrace/bake/texel_map.h"
#include "raytrace/surface.h"
#include "raytrace/surface_points.h"
#include "tests/command_line.h"
#include "tests/unit/app/fixtures.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using core::Vec3;

/// Irradiance that any map of our scenes holds well: linear in the world.
Vec3 smoothLight(const Vec3& p) { return Vec3(4 + p.x, 3 + 0.5f * p.y, 5 - p.z); }

Vec3 positionOf(const raytrace::World& world, const raytrace::MeshPoint& p) {
  const Vec3* corner = world.shape(world.firstTriangle(p.object) + p.triangle).position;
  const Vec3 local = corner[0] * (1 - p.b1 - p.b2) + corner[1] * p.b1 + corner[2] * p.b2;
  return Vec3(world.scene().objects[p.object].meshToWorld * core::Vec4(local, 1));
}

/// Takes the place of what was baked, on both sides.
void lightSmoothly(app::Workspace& w) {
  const raytrace::TexelMap texels(w.scene, w.maps.width);
  std::vector<Vec3> light(texels.texelCount());
  constexpr int kPoints = 16;
  for (std::size_t i = 0; i < light.size(); ++i)
    for (int k = 0; k < kPoints && texels.chartOf(i) >= 0; ++k)
      light[i] += smoothLight(positionOf(*w.world, texels.pointOn(i, (static_cast<float>(k) + 0.5f) / kPoints,
                                                                  static_cast<float>(k % 4) / 4 + 0.125f,
                                                                  static_cast<float>(k / 4) / 4 + 0.125f))) /
                  static_cast<float>(kPoints);
  raytrace::fillGutters(texels, light);
  for (std::size_t at = 0; at < w.maps.texels.size(); ++at)
    w.maps.texels[at] = core::toHalf(light[at / 3 % light.size()][static_cast<int>(at % 3)]);
  w.world->setMaps(&w.maps);
}

std::unique_ptr<app::Workspace> opened(const fs::path& scene, const fs::path& importFile = {}) {
  app::SceneOptions options;
  options.path = scene.string();
  options.quality = "preview";
  options.photons = 1000;
  app::BakeRequest bake;
  bake.file = tests::temporaryFolder() / (scene.stem().string() + "-export.maps");
  bake.threads = 2;
  bake.importFolder = importFile;
  bake.importScale = 1 / core::kPi;
  return app::openWorkspace(options, bake, {});
}

double error(const raytrace::World& world, const raytrace::SurfacePoint& p) {
  const Vec3 truth = smoothLight(positionOf(world, {p.object, p.triangle, p.b1, p.b2}));
  return glm::length(raytrace::mapIrradiance(world, p) - truth) / glm::length(truth);
}

TEST(LightExport, TheLightComesBackThroughImport) {
  const auto from = opened(tests::bundled("cornell.glb"));
  lightSmoothly(*from);
  const fs::path file = tests::temporaryFolder() / "round.glb";
  app::exportLit(*from, file, 2, {});
  const auto to = opened(file, app::LitFiles(file).front);
  EXPECT_EQ(to->scene.warnings, core::Warnings{});
  EXPECT_EQ(from->scene.triangleCount(), to->scene.triangleCount());
  EXPECT_LT(glm::length(from->scene.bounds.lo - to->scene.bounds.lo), 1e-5f);
  EXPECT_LT(glm::length(from->scene.bounds.hi - to->scene.bounds.hi), 1e-5f);
  double squares = 0;
  const auto points = raytrace::surfacePoints(*to->world, 4096, 1);
  for (const raytrace::SurfacePoint& p : points) squares += std::pow(error(*to->world, p), 2);
  // Half floats leave 0.0005; where a chart's border cuts a texel, each of the two maps moves its light by up
  // to half a texel of 1 cm, across which the light changes by 0.001.
  EXPECT_LT(std::sqrt(squares / static_cast<double>(points.size())), 0.002);
}

TEST(LightExport, TexturesHoldIrradianceAndWhatTheBaseLayerShows) {
  const auto smooth = opened(tests::bundled("cornell.glb"));
  app::Workspace& w = *smooth;
  lightSmoothly(w);  // so that a texel's mean is its value
  const core::LightTextures light = raytrace::makeLightTextures(*w.world, w.maps, 2, {});
  const raytrace::TexelMap texels(w.scene, w.maps.width);
  ASSERT_EQ(light.emission.width(), w.maps.width);  // nothing is textured
  const core::Srgb8& code = core::Srgb8::table();
  std::size_t seen = 0, exact = 0;
  for (std::size_t i = 0; i < texels.texelCount(); i += 7) {
    if (texels.chartOf(i) < 0) continue;
    ++seen;
    const int x = static_cast<int>(i) % w.maps.width, y = static_cast<int>(i) / w.maps.width;
    const core::Object& object = w.scene.objects[texels.fragments(i).front().object];
    const auto material = static_cast<std::size_t>(object.material);
    const core::MaterialLight scale = light.materials[material];
    const Vec3 lightmap = w.maps.texel(x, y, 0) / core::kPi;  // both layers hold it
    const Vec3 albedo =
        w.scene.materials[material].baseColor * w.world->material(object.material).diffuseFactor;
    const core::Rgba8 shown = light.lightmap.at(x, y), left = light.emission.at(x, y);
    const int expected = code(lightmap.y / scale.irradiance);
    exact += shown.g == expected;
    EXPECT_NEAR(shown.g, expected, 1) << x << ' ' << y;
    const Vec3 radiance = w.scene.materials[material].emission + albedo * lightmap;
    EXPECT_NEAR(left.g, code(radiance.y / scale.radiance), 1) << x << ' ' << y;
  }
  EXPECT_GT(seen, 4000u);
  // A texel that a chart's border cuts holds the mean of the part it has, not the value at its centre.
  EXPECT_GT(exact, seen - seen / 100);
}

TEST(LightExport, DetailOfTheMapsMakesThePicturesFiner) {
  const auto opens = opened(tests::bundled("cornell.glb"));
  app::Workspace& w = *opens;
  std::fill(w.maps.texels.begin(), w.maps.texels.end(), core::toHalf(0.5f));
  // One block for all: 4 columns of 1, 1, 3 and 3 with their border, and 2 rows alike.
  w.maps.detail.height = 4;
  w.maps.detail.blocks.assign(static_cast<std::size_t>(w.maps.width) * w.maps.height,
                              core::MapBlock{1, 1, 2, 1}.packed());
  for (int row = 0; row < 4 * w.maps.layers; ++row)
    for (int x = 0; x < w.maps.width; ++x)
      w.maps.detail.texels.insert(w.maps.detail.texels.end(), 3, core::toHalf(x < 3 ? 1.0f : 3.0f));
  w.world->setMaps(&w.maps);
  const core::ImageRgb picture = raytrace::irradiancePicture(*w.world, w.maps, 0, 2, {});
  ASSERT_EQ(picture.width(), 4 * w.maps.width);
  const core::LightTextures light = raytrace::makeLightTextures(*w.world, w.maps, 2, {});
  ASSERT_EQ(light.lightmap.width(), picture.width());
  ASSERT_EQ(light.emission.width(), picture.width());
  // Means of bilinear look-ups at a quarter and three quarters of each cell.
  constexpr float kExpected[] = {1, 1.25f, 2.75f, 3};
  const raytrace::TexelMap texels(w.scene, picture.width());
  const auto chartAt = [&](int x, int y) {
    const auto side = static_cast<std::size_t>(picture.width());
    return texels.chartOf(static_cast<std::size_t>(y) * side + static_cast<std::size_t>(x));
  };
  const auto insideChart = [&](int x, int y) {
    const std::int32_t chart = chartAt(x, y);
    return chart >= 0 && x > 0 && y > 0 && x + 1 < picture.width() && y + 1 < picture.height() &&
           chartAt(x - 1, y) == chart && chartAt(x + 1, y) == chart && chartAt(x, y - 1) == chart &&
           chartAt(x, y + 1) == chart;
  };
  const core::Srgb8& code = core::Srgb8::table();
  int compared = 0;
  for (int y = 0; y < picture.height(); y += 5) {
    for (int x = 0; x < picture.width(); ++x) {
      const float expected = kExpected[x % 4];
      ASSERT_NEAR(picture.at(x, y).y, expected, 2e-3) << x << ' ' << y;
      if (!insideChart(x, y)) continue;  // fillGutters moves what a border cuts
      ASSERT_NEAR(light.lightmap.at(x, y).g, code(expected / 3), 1) << x << ' ' << y;
      ++compared;
    }
  }
  EXPECT_GT(compared, 10000);
}

TEST(LightExport, TheCommandExportsWithoutBakingTwice) {
  const fs::path scene = tests::temporaryFolder() / "room.glb",
                 lit = tests::temporaryFolder() / "lit room.glb";
  fs::copy_file(tests::bundled("cornell.glb"), scene, fs::copy_options::overwrite_existing);
  const std::string command =
      "bake '" + scene.string() + "' --quality preview --photons 1000 --export '" + lit.string() + "'";
  const tests::Ran first = tests::saccade(command);
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_EQ(first.out.find("already there"), std::string::npos);
  const app::LitFiles files(lit);
  EXPECT_TRUE(fs::exists(files.front));
  EXPECT_TRUE(fs::exists(files.back));
  const std::string once = tests::slurp(lit);
  const tests::Ran second = tests::saccade(command + " --threads 0");
  ASSERT_EQ(second.status, 0) << second.err;
  EXPECT_NE(second.out.find("already there, not baked again"), std::string::npos);
  EXPECT_EQ(tests::slurp(lit), once);
  EXPECT_EQ(core::loadScene(lit, {}).warnings, core::Warnings{});
}

TEST(LightExport, ErrorsComeBeforeTheBakeInOneLine) {
  const std::string scene = tests::bundled("cornell.glb").string();
  const auto fails = [&](const std::string& file, int status, const std::string& why) {
    const tests::Ran ran = tests::saccade("bake '" + scene + "' --export '" + file + "'");
    EXPECT_EQ(ran.status, status) << file;
    EXPECT_EQ(tests::errorLines(ran.err), 1) << ran.err;
    EXPECT_NE(ran.err.find(why), std::string::npos) << ran.err;
    EXPECT_EQ(ran.err.find("baking"), std::string::npos);
  };
  fails("room.gltf", 2, "ends in .glb");
  fails(scene, 2, "overwrite the scene");
  fails((tests::temporaryFolder() / "no such folder" / "a.glb").string(), 1, "folder that can be written");
}

}  // namespace
}  // namespace saccade
