// Illumination maps against closed-form light.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "raytrace/bake/direct.h"
#include "raytrace/bake/particles.h"
#include "raytrace/bake/texel_map.h"
#include "tests/hard_case.h"
#include "tests/unit/raytrace/bake_scenes.h"

namespace saccade::raytrace {
namespace {

using core::Vec3;
using tests::HardCase;
using Builder = SceneBuilder;

BakeOptions optionsOf(const std::string& quality, std::uint64_t photons = 0) {
  BakeOptions o;
  o.quality = quality;
  o.photons = photons;
  o.threads = 2;
  return o;
}

double quarterSolid(double a, double b, double h) {
  // Differential area to a parallel rectangle a x b with a corner above it at height h.
  const double x = a / h, y = b / h;
  return (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) +
          y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y))) /
         (2 * core::kPi);
}

/// Form factor from a horizontal point at the origin to the rectangle [x0, x1] x [z0, z1] at height h.
double rectangleAbove(double x0, double x1, double z0, double z1, double h) {
  const auto corner = [&](double x, double z) {
    return std::copysign(1.0, x) * std::copysign(1.0, z) * quarterSolid(std::abs(x), std::abs(z), h);
  };
  return corner(x1, z1) - corner(x0, z1) - corner(x1, z0) + corner(x0, z0);
}

TEST(BakeLight, Hard8DiskLightWithinHalfAPercent) {
  Builder b;
  const float r = 0.4f, h = 0.7f, radiance = 3;
  const int floor = b.quad(Builder::matte(0), Vec3(-1, 0, 1), Vec3(2, 0, 0), Vec3(0, 0, -2));
  b.disk(Builder::matte(0, Vec3(radiance)), Vec3(0, h, 0), r, 64);
  // A black floor shows no irradiance: give it a little albedo, nothing comes back from the black disk.
  b.scene.materials[0].baseColor = Vec3(0.5f);
  const Baked baked(std::move(b.scene), 64, optionsOf("medium", 1));
  const double truth = core::kPi * radiance * r * r / (r * r + h * h);
  EXPECT_TRUE(HardCase("disk light in the maps, relative")
                  .near(baked.irradiance(floor, Vec3(0)).x / truth, 1, 0.005));
}

TEST(BakeLight, Hard8RectangleAboveWithinOnePercentRms) {
  Builder b;
  const int floor = b.quad(Builder::matte(0.5f), Vec3(-2, 0, 2), Vec3(4, 0, 0), Vec3(0, 0, -4));
  b.quad(Builder::matte(0, Vec3(2)), Vec3(-0.5f, 1, -0.3f), Vec3(1, 0, 0), Vec3(0, 0, 0.6f));
  const Baked baked(std::move(b.scene), 64, optionsOf("high", 1));
  double squares = 0, mean = 0;
  constexpr int n = 24;
  for (int i = 0; i < n * n; ++i) {
    const float x = -2 + 4 * (i % n + 0.5f) / n, z = -2 + 4 * (i / n + 0.5f) / n;
    const double truth = 2 * core::kPi * rectangleAbove(-0.5 - x, 0.5 - x, -0.3 - z, 0.3 - z, 1);
    squares += std::pow(baked.irradiance(floor, Vec3(x, 0, z)).x - truth, 2.0) / (n * n);
    mean += truth / (n * n);
  }
  EXPECT_TRUE(
      HardCase("rectangle light in the maps, RMS of the mean").within(std::sqrt(squares) / mean, 0.01));
}

TEST(BakeLight, Hard8ParallelPlatesExchangeTheirFormFactorWithinOnePercent) {
  Builder b;  // two unit squares one apart; F = 0.1998
  const int lower = b.quad(Builder::matte(0.5f), Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 0, -1));
  b.quad(Builder::matte(0, Vec3(1)), Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0, 0, 1));
  const Baked baked(std::move(b.scene), 64, optionsOf("medium", 1));
  double sum = 0;
  constexpr int n = 40;
  for (int i = 0; i < n * n; ++i) {
    sum += baked.irradiance(lower, Vec3((i % n + 0.5f) / n, 0, (i / n + 0.5f) / n)).x;
  }
  EXPECT_TRUE(
      HardCase("parallel plates in the maps, relative").near(sum / (n * n) / core::kPi / 0.199825, 1, 0.01));
}

TEST(BakeLight, PointLightFallsWithTheSquareWithinOnePercent) {
  Builder b;
  const int floor = b.quad(Builder::matte(0.5f), Vec3(-2, 0, 2), Vec3(4, 0, 0), Vec3(0, 0, -4));
  core::PunctualLight light;
  light.position = Vec3(0, 1, 0);
  light.intensity = Vec3(5, 3, 1);
  b.scene.lights.push_back(light);
  const Baked baked(std::move(b.scene), 256, optionsOf("preview", 1));
  for (const float x : {0.0f, 0.5f, 1.0f, 1.9f}) {
    const Vec3 e = baked.irradiance(floor, Vec3(x, 0, 0.1f));
    const float squared = x * x + 0.01f + 1;
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(e[c] * squared * std::sqrt(squared) / light.intensity[c], 1, 0.01) << x;
    }
  }
}

TEST(BakeLight, DirectionalLightIsItsCosine) {
  Builder b;
  const int floor = b.quad(Builder::matte(0.5f), Vec3(-1, 0, 1), Vec3(2, 0, 0), Vec3(0, 0, -2));
  core::PunctualLight sun;
  sun.type = core::PunctualLight::Type::directional;
  sun.direction = glm::normalize(Vec3(1, -2, 0.5f));
  sun.intensity = Vec3(4);
  b.scene.lights.push_back(sun);
  const Baked baked(std::move(b.scene), 32, optionsOf("preview", 1));
  EXPECT_NEAR(baked.irradiance(floor, Vec3(0.3f, 0, 0.2f)).x, 4 * -sun.direction.y, 0.004);
}

TEST(BakeLight, Hard10ClosedFurnaceMeanWithinHalfAPercentRmsWithinFive) {
  Builder b;  // every wall glows with L and reflects one half: E = pi L / (1 - 0.5)
  b.box(Builder::matte(0.5f, Vec3(1)), Vec3(0), Vec3(1, 1.2f, 0.8f), true);
  const Baked baked(std::move(b.scene), 64, optionsOf("medium", 400000));
  double sum = 0, squares = 0;
  int n = 0;
  for (int o = 0; o < 6; ++o) {
    const core::Mesh& mesh = baked.scene().meshOf(baked.scene().objects[static_cast<std::size_t>(o)]);
    const Vec3 corner = mesh.positions[0], u = mesh.positions[1] - corner, v = mesh.positions[2] - corner - u;
    for (int i = 0; i < 400; ++i) {
      const Vec3 p = corner + u * ((i % 20 + 0.5f) / 20) + v * ((i / 20 + 0.5f) / 20);
      const double ratio = baked.irradiance(o, p).y / (2 * core::kPi);
      sum += ratio;
      squares += (ratio - 1) * (ratio - 1);
      ++n;
    }
  }
  EXPECT_TRUE(HardCase("closed furnace in the maps, mean").near(sum / n, 1, 0.005));
  EXPECT_TRUE(HardCase("closed furnace in the maps, RMS").within(std::sqrt(squares / n), 0.05));
}

TEST(BakeLight, Hard3AThinWallKeepsTheDarkRoomDark) {
  Builder b;  // two closed rooms, 1 cm between their walls; a lamp in the left one only
  b.box(Builder::matte(0.7f), Vec3(0), Vec3(1), true);
  b.box(Builder::matte(0.7f), Vec3(1.01f, 0, 0), Vec3(2.01f, 1, 1), true);
  b.quad(Builder::matte(0, Vec3(10)), Vec3(0.3f, 0.99f, 0.3f), Vec3(0.4f, 0, 0), Vec3(0, 0, 0.4f));
  const Baked baked(std::move(b.scene), 128, optionsOf("preview", 100000));
  double lit = 0, dark = 0;
  for (int o = 0; o < 12; ++o) {
    const core::Mesh& mesh = baked.scene().meshOf(baked.scene().objects[static_cast<std::size_t>(o)]);
    const Vec3 corner = mesh.positions[0], u = mesh.positions[1] - corner, v = mesh.positions[2] - corner - u;
    for (int i = 0; i < 2500; ++i) {
      const double e = baked.irradiance(o, corner + u * (i % 50 / 49.0f) + v * (i / 50 / 49.0f)).y;
      (o < 6 ? lit : dark) = std::max(o < 6 ? lit : dark, e);
    }
  }
  EXPECT_GT(lit, 1);
  EXPECT_TRUE(HardCase("light through a thin wall in the maps").within(dark, 0));
}

TEST(BakeLight, AWallOnOneFloorLeaksNoFurtherThanThreeTexels) {
  Builder b;  // one room with one floor; a wall of 1 cm with two faces parts it
  b.box(Builder::matte(0.7f), Vec3(0), Vec3(2.01f, 1, 1), true);
  b.quad(Builder::matte(0.7f), Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0, 1, 0));
  b.quad(Builder::matte(0.7f), Vec3(1.01f, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1));
  b.quad(Builder::matte(0, Vec3(10)), Vec3(0.3f, 0.99f, 0.3f), Vec3(0.4f, 0, 0), Vec3(0, 0, 0.4f));
  const Baked baked(std::move(b.scene), 256, optionsOf("preview", 400000));
  const double lit = baked.irradiance(0, Vec3(0.9f, 0, 0.5f)).y;
  for (float z = 0.02f; z < 1; z += 0.02f) {
    for (float x = 1.01f + 3 * baked.texelMetres(); x < 2; x += 0.5f * baked.texelMetres()) {
      ASSERT_LT(baked.irradiance(0, Vec3(x, 0, z)).y, 1e-3 * lit) << (x - 1.01f) / baked.texelMetres();
    }
  }
}

TEST(BakeLight, ManyChartsUnderEvenLightStayEvenWithinFourPercent) {
  Builder b;  // a grey cube's inside lit by indirect light only, once as whole walls, once in 14 x 14 pieces
  const core::Material glow = Builder::matte(0.5f, Vec3(1));
  b.box(glow, Vec3(0), Vec3(1), true);
  const int whole = b.quad(Builder::matte(0.5f), Vec3(0.1f, 0.5f, 0.4f), Vec3(0.3f, 0, 0), Vec3(0, 0, -0.3f));
  std::vector<int> pieces;
  for (int i = 0; i < 196; ++i) {
    const Vec3 corner(0.6f + 0.3f / 14 * static_cast<float>(i % 14), 0.5f,
                      0.4f - 0.3f / 14 * static_cast<float>(i / 14));
    pieces.push_back(b.quad(Builder::matte(0.5f), corner, Vec3(0.3f / 14, 0, 0), Vec3(0, 0, -0.3f / 14)));
  }
  const Baked baked(std::move(b.scene), 256, optionsOf("preview", 500000));
  double reference = 0, middle = 0, border = 0;
  for (const int o : pieces) {
    const core::Mesh& mesh = baked.scene().meshOf(baked.scene().objects[static_cast<std::size_t>(o)]);
    const Vec3 c = mesh.positions[0], u = mesh.positions[1] - c,
               v = mesh.positions[2] - mesh.positions[0] - u;
    const Vec3 center = c + 0.5f * (u + v);
    reference += baked.irradiance(whole, Vec3(1 - center.x, center.y, center.z)).y / 196;
    middle += baked.irradiance(o, center).y / 196;
    border += baked.irradiance(o, c + 0.01f * u + 0.5f * v).y / 196;
  }
  EXPECT_NEAR(middle / reference, 1, 0.04);
  EXPECT_NEAR(border / middle, 1, 0.02) << "no darkening along chart borders";
}

TEST(BakeLight, ParticlesCarryTheFluxThatBouncesWithinOnePercent) {
  Builder b;  // furnace of albedo 0.5: of the emitted power P, P / 2 + P / 4 + ... = P arrives indirectly
  b.box(Builder::matte(0.5f, Vec3(1)), Vec3(0), Vec3(1), true);
  core::Plan plan;
  plan.lightmapSize = 64;
  const ChartAtlas atlas = makeCharts(b.scene, plan, 64);
  core::applyCharts(b.scene, atlas.charts);
  const World world(b.scene, plan);
  const TexelMap texels(b.scene, atlas.size);
  ParticleState state(world, texels.texelCount(), 1);
  traceParticles(world, texels, {.whole = 200000, .threads = 2}, 200000, {}, state);
  double arrived = 0, area = 0;
  for (std::size_t t = 0; t < texels.texelCount(); ++t) {
    arrived += static_cast<double>(state.flux.cell(t, 0).rgb[1]) / FluxGrid::kUnitsPerWeight;
    area += texels.area(t);
  }
  EXPECT_NEAR(area, 6, 1e-4) << "texels cover the walls exactly";
  EXPECT_NEAR(arrived * wattsPerWeight(world, state.emitted) / (6 * core::kPi), 1, 0.01);
}

TEST(BakeLight, Hard20ParticlesBeyondFourThousandMillion) {
  // As above, but those emitted so far are 2^32 and more: the next ones carry their share all the same.
  HardCase share("flux of 200,000 particles after 2^32 and 2^40, relative");
  for (const std::uint64_t before : {(1ull << 32) - 100000, 1ull << 40}) {
    Builder b;
    b.box(Builder::matte(0.5f, Vec3(1)), Vec3(0), Vec3(1), true);
    core::Plan plan;
    plan.lightmapSize = 64;
    const ChartAtlas atlas = makeCharts(b.scene, plan, 64);
    core::applyCharts(b.scene, atlas.charts);
    const World world(b.scene, plan);
    const TexelMap texels(b.scene, atlas.size);
    ParticleState state(world, texels.texelCount(), 1);
    state.emitted = before;
    traceParticles(world, texels, {.whole = before + 200000, .threads = 2}, before + 200000, {}, state);
    ASSERT_EQ(state.emitted, before + 200000);
    double arrived = 0;
    for (std::size_t t = 0; t < texels.texelCount(); ++t)
      arrived += static_cast<double>(state.flux.cell(t, 0).rgb[1]) / FluxGrid::kUnitsPerWeight;
    const double truth = 6 * core::kPi * 200000 / static_cast<double>(before + 200000);
    EXPECT_TRUE(share.near(arrived * wattsPerWeight(world, state.emitted) / truth, 1, 0.01)) << before;
  }
}

TEST(BakeLight, AFaceThatTheFileHoldsTwiceIsLitTwice) {
  Builder b;  // rays meet only the first of equal triangles
  b.box(Builder::matte(0.7f), Vec3(0), Vec3(1), true);
  b.quad(Builder::matte(0, Vec3(10)), Vec3(0.3f, 0.99f, 0.3f), Vec3(0.4f, 0, 0), Vec3(0, 0, 0.4f));
  const int again =
      b.quad(Builder::matte(0.7f), Vec3(0), Vec3(0, 0, 1), Vec3(1, 0, 0));  // the floor, object 0
  const Baked baked(std::move(b.scene), 96, optionsOf("medium", 200000));
  for (const Vec3 p : {Vec3(0.5f, 0, 0.5f), Vec3(0.2f, 0, 0.7f), Vec3(0.9f, 0, 0.1f)}) {
    EXPECT_NEAR(baked.irradiance(again, p).y / baked.irradiance(0, p).y, 1, 0.05);
  }
}

core::Scene smallRoom() {
  Builder b;
  core::Material sheet = Builder::matte(0.6f);
  sheet.doubleSided = true;
  core::Material glass = Builder::matte(1);
  glass.transmission = 1;
  glass.specular = 1;
  glass.roughness = 0;
  core::Material shiny = Builder::matte(0.5f);
  shiny.specular = 1;
  shiny.roughness = 0.2f;
  b.box(Builder::matte(0.7f), Vec3(0), Vec3(1), true);
  b.quad(sheet, Vec3(0.2f, 0.3f, 0.5f), Vec3(0.4f, 0, 0.1f), Vec3(0, 0.4f, 0));
  b.quad(glass, Vec3(0.5f, 0.6f, 0.6f), Vec3(0.3f, 0, 0), Vec3(0, 0, -0.3f));
  b.patch(shiny, 12, 6, [](float s, float t) {
    const float a = -2 * core::kPi * s, c = core::kPi * (0.02f + 0.96f * t);
    return Vec3(0.7f, 0.2f, 0.3f) +
           0.15f * Vec3(std::sin(c) * std::cos(a), std::cos(c), std::sin(c) * std::sin(a));
  });
  b.quad(Builder::matte(0, Vec3(5, 4, 3)), Vec3(0.3f, 0.99f, 0.3f), Vec3(0.4f, 0, 0), Vec3(0, 0, 0.4f));
  return std::move(b.scene);
}

TEST(BakeLight, Hard28TheSameBitsForAnyNumberOfThreads) {
  BakeOptions options = optionsOf("preview", 20000);
  options.threads = 0;
  const Baked reference(smallRoom(), 64, options);
  EXPECT_EQ(reference.maps().layers, 2);
  HardCase changed =
      HardCase::counting("numbers of the maps on 1, 2 and 8 threads that differ from 0", "numbers");
  for (const int threads : {1, 2, 8}) {
    options.threads = threads;
    const Baked again(smallRoom(), 64, options);
    EXPECT_TRUE(changed.within(tests::differing(again.maps().texels, reference.maps().texels), 0)) << threads;
  }
  options.seed = 2;
  EXPECT_NE(Baked(smallRoom(), 64, options).maps().texels, reference.maps().texels);
}

TEST(BakeLight, BothSidesOfASheetHaveTheirOwnLight) {
  Builder b;
  core::Material sheet = Builder::matte(0.5f);
  sheet.doubleSided = true;
  const int object = b.quad(sheet, Vec3(-1, 0, 1), Vec3(2, 0, 0), Vec3(0, 0, -2));
  core::PunctualLight light;
  light.position = Vec3(0, 1, 0);
  b.scene.lights.push_back(light);
  light.position = Vec3(0, -2, 0);
  light.intensity = Vec3(8);
  b.scene.lights.push_back(light);
  const Baked baked(std::move(b.scene), 64, optionsOf("preview", 1));
  EXPECT_NEAR(baked.irradiance(object, Vec3(0), 0).x, 1, 0.01);
  EXPECT_NEAR(baked.irradiance(object, Vec3(0), 1).x, 2, 0.02);
}

TEST(BakeLight, ProgressRisesToOneAndAStopEndsTheBake) {
  core::Scene scene = smallRoom();
  core::Plan plan;
  plan.lightmapSize = 64;
  const ChartAtlas atlas = makeCharts(scene, plan, 64);
  core::applyCharts(scene, atlas.charts);
  const World world(scene, plan);
  double last = 0;
  core::Progress progress;
  progress.report = [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
  };
  bakeMaps(world, atlas.charts, atlas.size, optionsOf("preview", 20000), progress);
  EXPECT_DOUBLE_EQ(last, 1);

  std::stop_source source;
  source.request_stop();
  core::Progress stopped;
  stopped.stop = source.get_token();
  EXPECT_THROW(bakeMaps(world, atlas.charts, atlas.size, optionsOf("preview"), stopped), core::Error);
  EXPECT_THROW(bakeMaps(world, atlas.charts, atlas.size, optionsOf("best"), {}), core::UsageError);
}

TEST(BakeLight, Hard22FireflyIsClampedAndItsEnergyReported) {
  // A lamp above a plate, once of the radiance of a lamp, once 10^30: what is kept and what is reported left
  // out add up to what the plate receives.
  const auto bake = [](float radiance) {
    Builder b;
    b.quad(Builder::matte(0.5f), Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 0, -1));
    b.quad(Builder::matte(0, Vec3(radiance)), Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0, 0, 1));
    return Baked(std::move(b.scene), 32, optionsOf("preview", 1000));
  };
  EXPECT_EQ(bake(1).maps().clampedTexels, 0u);
  HardCase energy("kept and clamped energy of a 1e30 firefly in the maps, relative"),
      unsound = HardCase::counting("texels of the maps beyond 65504 under a 1e30 firefly", "texels");
  const Baked lit = bake(1e30f);
  EXPECT_TRUE(energy.near(lit.maps().clampedWatts / (1e30 * core::kPi * 0.199825), 1, 0.01));
  int beyond = 0;
  for (const std::uint16_t half : lit.maps().texels) beyond += half > 0x7BFF;
  EXPECT_TRUE(unsound.within(beyond, 0));
}

TEST(BakeLight, NoLightGivesBlackMapsAndATexelNeverHoldsNaN) {
  Builder b;
  b.box(Builder::matte(0.7f), Vec3(0), Vec3(1), true);
  const Baked dark(std::move(b.scene), 32, optionsOf("preview"));
  EXPECT_EQ(std::count(dark.maps().texels.begin(), dark.maps().texels.end(), 0),
            static_cast<std::ptrdiff_t>(dark.maps().texels.size()));
}

}  // namespace
}  // namespace saccade::raytrace
