// Many lamps: the tree's probabilities, bounds and depth, and irradiance against its truth.
#include "raytrace/light_tree.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "raytrace/alias_table.h"
#include "tests/unit/raytrace/irradiance.h"
#include "tests/unit/raytrace/test_scene.h"

namespace saccade::raytrace {
namespace {

using tests::planOf;
using tests::SceneMaker;

/// One way of placing lamps; power and orientation at random.
enum class Places { volume, line, plane, onePoint, geometric };

std::vector<LightBounds> lampsAt(Places places, int n) {
  std::mt19937 engine(41);
  std::uniform_real_distribution<float> u(-1, 1);
  std::vector<LightBounds> out;
  for (int i = 0; i < n; ++i) {
    Vec3 p(u(engine), u(engine), u(engine));
    if (places == Places::line) p = Vec3(p.x, 0, 0);
    if (places == Places::plane) p.y = 0;
    if (places == Places::onePoint) p = Vec3(0.3f);
    if (places == Places::geometric) p = Vec3(std::ldexp(1.0f, -(i % 60)), 0, 0);  // ever closer together
    LightBounds b;
    b.box.add(p);
    b.box.add(p + 0.01f * Vec3(u(engine), u(engine), u(engine)));
    b.axis = tests::randomDirection(engine);
    b.spread = i % 7 == 0 ? core::kPi : 0;
    b.emission = i % 5 == 0 ? 0.6f : core::kPi / 2;
    b.power = std::exp(3 * u(engine));
    out.push_back(b);
  }
  return out;
}

constexpr Places kAllPlaces[] = {Places::volume, Places::line, Places::plane, Places::onePoint,
                                 Places::geometric};

TEST(LightTree, ProbabilitiesSumToOneAndAreThoseOfTheDraws) {
  std::mt19937 engine(42);
  std::uniform_real_distribution<float> u(-2, 2);
  for (const Places places : kAllPlaces) {
    for (const int n : {1, 2, 3, 50, 1000}) {
      const std::vector<LightBounds> lamps = lampsAt(places, n);
      const LightTree tree(lamps);
      for (int k = 0; k < 5; ++k) {
        const Vec3 point(u(engine), u(engine), u(engine));
        double sum = 0;
        for (std::uint32_t i = 0; i < lamps.size(); ++i)
          sum += static_cast<double>(tree.probability(point, i));
        LightTree::Drawn drawn;
        int found = 0;
        constexpr int kDraws = 4096;
        for (int d = 0; d < kDraws; ++d) {
          if (!tree.draw(point, (static_cast<float>(d) + 0.5f) / kDraws, drawn)) continue;
          ++found;
          EXPECT_NEAR(drawn.probability, tree.probability(point, drawn.lamp), 1e-4f * drawn.probability);
        }
        // A descent may end where a bound shines and neither of its halves does.
        EXPECT_LE(sum, 1.0001);
        EXPECT_NEAR(sum, static_cast<double>(found) / kDraws, 0.02) << n;
      }
    }
  }
}

TEST(LightTree, EveryLampThatReachesAPointCanBeDrawn) {
  std::mt19937 engine(43);
  std::uniform_real_distribution<float> u(-2, 2);
  for (const Places places : kAllPlaces) {
    const std::vector<LightBounds> lamps = lampsAt(places, 300);
    const LightTree tree(lamps);
    for (int k = 0; k < 300; ++k) {
      const Vec3 point(u(engine), u(engine), u(engine));
      for (std::uint32_t i = 0; i < lamps.size(); ++i) {
        // From some corner of the lamp's box under an angle to its normals at which it shines.
        const LightBounds& lamp = lamps[i];
        bool reaches = false;
        for (const Vec3& from : {lamp.box.lo, lamp.box.hi, lamp.box.center()}) {
          const float angle =
              std::acos(std::clamp(glm::dot(glm::normalize(point - from), lamp.axis), -1.0f, 1.0f));
          reaches = reaches || angle - lamp.spread < lamp.emission - 1e-3f;
        }
        if (reaches) {
          ASSERT_GT(tree.probability(point, i), 0) << i;
        }
      }
    }
  }
}

TEST(LightTree, DepthIsLogarithmicWhereverTheLampsAre) {
  for (const Places places : kAllPlaces) {
    for (const int n : {1, 2, 100, 10000}) {
      const LightTree tree(lampsAt(places, n));
      EXPECT_LE(tree.depth(), 8 + std::log(n) / std::log(8 / 7.0)) << n;
      if (places == Places::volume) {
        EXPECT_LE(tree.depth(), 2 * std::log2(n) + 1) << n;
      }
    }
  }
}

/// Small triangles at random in a slab above the floor, facing anywhere.
struct Swarm {
  SceneMaker maker;
  std::vector<std::array<Vec3, 3>> triangles;
  explicit Swarm(int n, bool oneObject) {
    std::mt19937 engine(44);
    std::uniform_real_distribution<float> u(-1, 1);
    const int material = maker.material(tests::diffuseMaterial(Vec3(0), Vec3(1)));
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;
    for (int i = 0; i < n; ++i) {
      const Vec3 p(20 * u(engine), 1.5f + u(engine), 20 * u(engine));
      const auto corner = [&] { return p + 0.02f * tests::randomDirection(engine); };
      triangles.push_back({corner(), corner(), corner()});
      for (const Vec3& c : triangles.back()) {
        indices.push_back(static_cast<std::uint32_t>(positions.size()));
        positions.push_back(c);
      }
      if (!oneObject) {
        maker.mesh(material, 0, positions, {0, 1, 2});
        positions.clear();
        indices.clear();
      }
    }
    if (oneObject) maker.mesh(material, 0, positions, indices);
  }
  double irradiance(const Vec3& point, const Vec3& normal) const {
    double sum = 0;
    for (const auto& t : triangles) {
      if (glm::dot(glm::cross(t[1] - t[0], t[2] - t[0]), point - t[0]) <= 0) continue;
      sum += polygonIrradiance(point, normal, {t[0], t[1], t[2]});
    }
    return sum;
  }
};

TEST(LightTree, IrradianceOfManyLampsIsUnbiasedAndHardlyNoisier) {
  const Vec3 point(0.3f, 0, -0.2f), normal(0, 1, 0);
  double relative[2];
  int k = 0;
  for (const int n : {100, 10000}) {
    const Swarm swarm(n, n > 1000);
    const World world(swarm.maker.scene, planOf());
    ASSERT_TRUE(world.lights().byTree());
    constexpr int kSamples = 100000;
    const Estimate e = irradianceBySampling(world, point, normal, kSamples);
    const double exact = swarm.irradiance(point, normal);
    // Lamps hide one another a little: far less than the tolerance.
    EXPECT_NEAR(e.mean, exact, 4 * e.sigma + 0.003 * exact) << n;
    relative[k++] = e.sigma * std::sqrt(kSamples) / e.mean;  // of one sample
  }
  EXPECT_LT(relative[1], 2 * relative[0]);
  EXPECT_LT(relative[1], 2);
}

TEST(LightTree, PunctualAndDirectionalLightsBelongToIt) {
  SceneMaker m;
  m.quad(m.material(tests::diffuseMaterial(Vec3(1))), 0, {-5, -1, -5}, {0, 0, 10}, {10, 0, 0});
  m.quad(m.material(tests::diffuseMaterial(Vec3(0), Vec3(5))), 0, {-5, 6, -0.5f}, {1, 0, 0}, {0, 0, 1});
  std::mt19937 engine(45);
  std::uniform_real_distribution<float> u(-1, 1);
  const Vec3 point(0.1f, 0, 0.2f);
  double exact =
      5 * polygonIrradiance(point, {0, 1, 0}, {{-5, 6, -0.5f}, {-4, 6, -0.5f}, {-4, 6, 0.5f}, {-5, 6, 0.5f}});
  for (int i = 0; i < 40; ++i) {
    core::PunctualLight light;
    light.type = static_cast<core::PunctualLight::Type>(i % 3);
    light.position = Vec3(3 * u(engine), 3 + u(engine), 3 * u(engine));
    light.direction = glm::normalize(Vec3(u(engine), -2, u(engine)));
    light.intensity = Vec3(std::exp(u(engine)));
    light.cosInner = 0.9f;
    light.cosOuter = 0.6f;
    m.scene.lights.push_back(light);
    const bool sun = light.type == core::PunctualLight::Type::directional;
    const Vec3 to = sun ? -light.direction : light.position - point;
    const float d = glm::length(to);
    exact += static_cast<double>(light.intensity.x * to.y / (sun ? 1 : d * d * d) *
                                 spotFactor(light, -glm::dot(to / d, light.direction)));
  }
  const World world(m.scene, planOf());
  ASSERT_TRUE(world.lights().byTree());
  const Estimate e = irradianceBySampling(world, point, {0, 1, 0}, 200000);
  EXPECT_NEAR(e.mean, exact, 4 * e.sigma);
  EXPECT_LT(e.sigma, 0.005 * exact);
}

}  // namespace
}  // namespace saccade::raytrace
