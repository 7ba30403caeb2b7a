// Particles aimed at mirrors and glass: the light they bring is that of plain emission, from far more of
// them.
#include "raytrace/emission_aim.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "raytrace/bake/particles.h"
#include "raytrace/bake/texel_map.h"
#include "tests/unit/raytrace/bake_scenes.h"

namespace saccade::raytrace {
namespace {

using core::Vec2;
using core::Vec3;
using Builder = SceneBuilder;
using Light = core::PunctualLight;

core::Material mirror() {
  core::Material m = Builder::matte(0.9f);
  m.metallic = 1;
  m.roughness = 0;
  return m;
}

core::Material glass() {
  core::Material m = Builder::matte(1);
  m.roughness = 0;
  m.specular = 1;
  m.transmission = 1;
  return m;
}

void ball(Builder& b, const core::Material& material, Vec3 center, float radius) {
  const int object = b.patch(material, 32, 16, [=](float s, float t) {
    const float phi = 2 * core::kPi * s, theta = core::kPi * std::clamp(t, 1e-3f, 1 - 1e-3f);
    return center +
           radius * Vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
  });
  b.scene.objects[static_cast<std::size_t>(object)].closed = true;
}

/// Four matte squares that make a floor of 4 m x 4 m at y = 0: objects 0 to 3.
void addFloor(Builder& b) {
  for (int i = 0; i < 4; ++i) {
    const Vec3 corner(i & 1 ? 0 : -2, 0, i & 2 ? 0 : -2);
    b.quad(Builder::matte(0.5f), corner, Vec3(0, 0, 2), Vec3(2, 0, 0));
  }
}

/// Facing down.
void addPanel(Builder& b, Vec3 center, float side) {
  b.quad(Builder::matte(0, Vec3(5)), center - Vec3(side / 2, 0, side / 2), Vec3(side, 0, 0),
         Vec3(0, 0, side));
}

/// What caustic particles brought to each square of the floor, in watts.
struct Arrived {
  double watts[4] = {}, variance[4] = {};
  double weight = 0, squared = 0;
  double effectiveCount() const { return weight * weight / squared; }
};

class Lit {
 public:
  explicit Lit(core::Scene built) : scene_(std::move(built)) {
    core::Plan plan;
    plan.lightmapSize = 64;
    const ChartAtlas atlas = makeCharts(scene_, plan, 64);
    core::applyCharts(scene_, atlas.charts);
    world_ = std::make_unique<World>(scene_, plan);
    texels_ = std::make_unique<TexelMap>(scene_, atlas.size);
  }

  ParticleState trace(const ParticleOptions& options, std::vector<std::uint64_t> stops = {}) const {
    ParticleState state(*world_, texels_->texelCount(), 1);
    stops.push_back(options.total());
    for (const std::uint64_t last : stops) traceParticles(*world_, *texels_, options, last, {}, state);
    return state;
  }
  /// Emitted plainly, since they are followed through all surfaces; or aimed.
  Arrived plain(std::uint64_t count) const { return arrived(trace({.whole = count, .threads = 2})); }
  Arrived aimed(std::uint64_t count) const {
    return arrived(trace({.caustic = count, .seed = 2, .threads = 2}));
  }

 private:
  Arrived arrived(const ParticleState& state) const {
    Arrived out;
    const double watts = wattsPerWeight(*world_, state.emitted);
    for (std::size_t t = 0; t < texels_->texelCount(); ++t) {
      for (std::uint32_t o = 0; o < 4; ++o) {
        if (texels_->chartOf(t) < 0 || texels_->chartOf(t) != chartOf(o)) continue;
        const FluxGrid::Cell& cell = state.flux.cell(t, state.causticPlane(0));
        const double w = static_cast<double>(cell.rgb[1]) / FluxGrid::kUnitsPerWeight,
                     squared = static_cast<double>(cell.squared) / FluxGrid::kUnitsPerWeight;
        out.watts[o] += w * watts;
        out.variance[o] += squared * watts * watts;
        out.weight += w;
        out.squared += squared;
      }
    }
    return out;
  }
  std::int32_t chartOf(std::uint32_t object) const {
    return texels_->chartOf(
        texels_->texelAt(world_->lightmapUv(object, world_->firstTriangle(object), 0.3f, 0.3f)));
  }

  core::Scene scene_;
  std::unique_ptr<World> world_;
  std::unique_ptr<TexelMap> texels_;
};

constexpr std::uint64_t kMany = 400000;

/// Each square of the floor gets as much, within 4 standard errors of the difference.
void expectSameLight(Builder b, const char* what) {
  const Lit lit(std::move(b.scene));
  const Arrived plain = lit.plain(kMany), aimed = lit.aimed(kMany);
  EXPECT_GT(plain.effectiveCount(), 1000) << what;
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(aimed.watts[i], plain.watts[i], 4 * std::sqrt(plain.variance[i] + aimed.variance[i]))
        << what << ", square " << i;
  }
}

/// Balls whose cones overlap, behind and beside one another, unevenly over the floor.
Builder overlappingBalls() {
  Builder b;
  addFloor(b);
  ball(b, mirror(), {0.3f, 0.6f, 0.2f}, 0.3f);
  ball(b, glass(), {0.2f, 1.1f, 0.3f}, 0.25f);
  ball(b, mirror(), {-0.4f, 0.9f, -0.1f}, 0.4f);
  return b;
}

TEST(EmissionAim, AnEmittingSurfaceBringsTheLightOfPlainEmission) {
  Builder b = overlappingBalls();
  addPanel(b, {0, 2, 0}, 0.5f);
  expectSameLight(std::move(b), "panel");
}

TEST(EmissionAim, APanelThatCutsASpheresHorizonDoesToo) {
  Builder b = overlappingBalls();  // some of the aimed directions lie behind the panel
  addPanel(b, {0.7f, 0.95f, 0}, 0.2f);
  expectSameLight(std::move(b), "panel at the balls' height");
}

TEST(EmissionAim, PointAndSpotLightsDoToo) {
  for (const Light::Type type : {Light::Type::point, Light::Type::spot}) {
    Builder b = overlappingBalls();
    Light light;
    light.type = type;
    light.position = {0.3f, 2, 0.1f};
    light.direction = glm::normalize(Vec3(-0.2f, -1, 0));
    light.cosInner = 0.98f;
    light.cosOuter = 0.93f;  // the cones reach beyond the spot's
    b.scene.lights.push_back(light);
    expectSameLight(std::move(b), type == Light::Type::spot ? "spot" : "point");
  }
}

TEST(EmissionAim, ParallelAndEnvironmentLightDoToo) {
  Builder sun = overlappingBalls();
  Light light;
  light.type = Light::Type::directional;
  light.direction = glm::normalize(Vec3(0.3f, -1, 0.2f));
  sun.scene.lights.push_back(light);
  expectSameLight(std::move(sun), "sun");

  Builder sky = overlappingBalls();
  auto environment = std::make_shared<core::Environment>();
  environment->radiance = core::ImageRgb(8, 4);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 8; ++x)
      environment->radiance.at(x, y) = Vec3(y < 2 ? 1.0f + static_cast<float>(x) : 0.1f);
  }
  sky.scene.environment = environment;
  expectSameLight(std::move(sky), "environment");
}

TEST(EmissionAim, ALampInsideABowlDoesToo) {
  Builder b;  // the lamp lies in the bounding sphere of its own reflector
  addFloor(b);
  b.patch(mirror(), 16, 8, [](float s, float t) {
    const float phi = 2 * core::kPi * s, theta = 0.5f * core::kPi * std::clamp(t, 1e-3f, 1.0f);
    return Vec3(0, 1.5f, 0) +
           0.5f * Vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
  });
  b.scene.materials.back().doubleSided = true;
  ball(b, mirror(), {0.4f, 0.5f, 0}, 0.3f);
  Light light;
  light.position = {0, 1.55f, 0};
  b.scene.lights.push_back(light);
  expectSameLight(std::move(b), "bowl");
}

TEST(EmissionAim, ASmallFarMirrorIsMetByAHundredTimesAsMany) {
  Builder b;
  addFloor(b);
  ball(b, mirror(), {0.5f, 0.3f, 0.5f}, 0.06f);
  addPanel(b, {0, 3, 0}, 0.3f);
  const Lit lit(std::move(b.scene));
  const double plain = lit.plain(kMany).effectiveCount(), aimed = lit.aimed(kMany).effectiveCount();
  EXPECT_GT(aimed, 100 * plain) << plain << " of " << kMany;
}

TEST(EmissionAim, HasTheSameBitsForAnyThreadsAndPauses) {
  Builder b = overlappingBalls();
  addPanel(b, {0, 2, 0}, 0.5f);
  const Lit lit(std::move(b.scene));
  ParticleOptions options{.whole = 10000, .caustic = 40000};
  ParticleState one = lit.trace(options);
  options.threads = 3;
  ParticleState three = lit.trace(options, {5000, 9000, 20001});
  ASSERT_EQ(one.emitted, three.emitted);
  EXPECT_EQ(std::memcmp(one.flux.cells().data(), three.flux.cells().data(), one.flux.cells().size_bytes()),
            0);
}

TEST(EmissionAim, FromWithinATargetOrWithoutAnyEmissionIsPlain) {
  const Vec3 drawn = glm::normalize(Vec3(1, 2, 3));
  const auto density = [](const Vec3&) { return 1 / (4 * core::kPi); };
  for (const EmissionAim& aim : {EmissionAim(std::vector<EmissionAim::Target>{}),
                                 EmissionAim({{.center = Vec3(0, 0.5f, 0), .radius = 1, .weight = 1}})}) {
    Vec3 direction = drawn;
    EXPECT_EQ(aim.fromPoint(Vec3(0), Vec3(0), {0.1f, 0.2f, Vec2(0.3f, 0.4f)}, density, direction), 1);
    EXPECT_EQ(direction, drawn);
  }
}

TEST(EmissionAim, SharesAverageToOneOverAllDirections) {
  // Nested and overlapping cones, more than fill one quad of lanes, one behind the emitter's plane.
  std::vector<EmissionAim::Target> targets;
  for (int i = 0; i < 7; ++i) {
    const auto x = static_cast<float>(i);
    targets.push_back({Vec3(0.3f * x, 2 + 0.5f * x, 1 - 0.2f * x), 0.2f + 0.1f * x, 0.1f + 0.3f * x});
  }
  targets.push_back({Vec3(0, -3, 0), 1, 5});
  const EmissionAim aim(targets);
  const auto density = [](const Vec3& d) { return std::max(0.0f, d.y) / core::kPi; };
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> u(0, 1);
  double sum = 0, squares = 0;
  constexpr int kDraws = 400000;
  for (int i = 0; i < kDraws; ++i) {
    const float r = u(engine), phi = 2 * core::kPi * u(engine);
    Vec3 direction(std::sqrt(r) * std::cos(phi), std::sqrt(1 - r), std::sqrt(r) * std::sin(phi));
    const EmissionAim::Chance chance{u(engine), u(engine), {u(engine), u(engine)}};
    const double share = aim.fromPoint(Vec3(0), Vec3(0, 1, 0), chance, density, direction);
    ASSERT_GE(share, 0);
    ASSERT_LE(share, 2.0001);
    ASSERT_NEAR(glm::length(direction), 1, 1e-5);
    sum += share;
    squares += share * share;
  }
  const double error = std::sqrt(squares) / kDraws;
  EXPECT_NEAR(sum / kDraws, 1, 4 * error);
}

}  // namespace
}  // namespace saccade::raytrace
