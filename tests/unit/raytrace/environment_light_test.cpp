// Light from environment maps: densities, and energy against closed forms.
#include "raytrace/environment_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "raytrace/lights.h"
#include "raytrace/path_tracer.h"
#include "raytrace/surface.h"
#include "raytrace/world.h"
#include "tests/unit/raytrace/bake_scenes.h"
#include "tests/unit/raytrace/test_scene.h"

namespace saccade::raytrace {
namespace {

using tests::planOf;
using tests::SceneMaker;

std::shared_ptr<const core::Environment> environmentOf(core::ImageRgb image, float degrees = 0) {
  core::Environment e;
  e.radiance = std::move(image);
  e.rotation = glm::radians(degrees);
  return std::make_shared<const core::Environment>(std::move(e));
}

core::ImageRgb constant(const Vec3& radiance) { return {8, 4, radiance}; }

/// Black but for one texel.
core::ImageRgb sun(int width, int height, int x, int y, float radiance) {
  core::ImageRgb image(width, height);
  image.at(x, y) = Vec3(radiance);
  return image;
}

/// Pictures that are hard to sample.
struct Picture {
  const char* name;
  core::ImageRgb image;
};
std::vector<Picture> pictures() {
  std::vector<Picture> out;
  out.push_back({"constant", constant(Vec3(1, 2, 3))});
  out.push_back({"sun", sun(64, 32, 40, 9, 1e5f)});
  out.push_back({"sun on the seam", sun(64, 32, 0, 16, 1e5f)});
  out.push_back({"sun at the upper pole", sun(64, 32, 20, 0, 1e5f)});
  out.push_back({"sun at the lower pole", sun(64, 32, 20, 31, 1e5f)});
  out.push_back({"one texel", core::ImageRgb(1, 1, Vec3(2))});
  out.push_back({"one column", core::ImageRgb(1, 7, Vec3(2))});
  std::mt19937 random(4);
  core::ImageRgb noise(37, 19);
  for (Vec3& p : noise.pixels()) p = Vec3(std::pow(static_cast<float>(random() % 1000) / 500, 6.0f));
  out.push_back({"noise", noise});
  return out;
}

constexpr float kTurned = 77;  // degrees

/// Calls visit(place, solid angle) for each texel's cell; place(s, t), in [0, 1]^2, is uniform in solid
/// angle.
template <class Visit>
void eachCell(const core::ImageRgb& image, Visit&& visit) {
  const auto environment = environmentOf(image, kTurned);
  const double width = image.width(), height = image.height();
  for (int y = 0; y < image.height(); ++y) {
    const double upper = std::cos(M_PI * y / height), lower = std::cos(M_PI * (y + 1) / height);
    for (int x = 0; x < image.width(); ++x) {
      const auto place = [&](float s, float t) {
        const double colatitude = std::acos(upper + (lower - upper) * static_cast<double>(t));
        return core::environmentDirection(*environment,
                                          {static_cast<float>((x + static_cast<double>(s)) / width),
                                           static_cast<float>(colatitude / M_PI)});
      };
      visit(place, 2 * M_PI / width * (upper - lower));
    }
  }
}

TEST(EnvironmentLight, DensityIntegratesToOne) {
  for (const Picture& p : pictures()) {
    const auto environment = environmentOf(p.image, kTurned);
    const EnvironmentLight light(environment);
    ASSERT_TRUE(light.shines());
    // Over the picture, where the interpolation is bilinear between the texels' centres and the midpoint rule
    // with an even number of points a texel is exact.
    const int width = 4 * p.image.width(), height = 4 * p.image.height();
    double sum = 0;
    for (int i = 0; i < width * height; ++i) {
      const Vec2 uv((i % width + 0.5f) / width, (i / width + 0.5f) / height);
      const double sine = std::sin(M_PI * static_cast<double>(uv.y));
      sum += static_cast<double>(light.pdf(core::environmentDirection(*environment, uv))) * sine;
    }
    EXPECT_NEAR(sum * 2 * M_PI * M_PI / (width * height), 1, 1e-4) << p.name;
  }
}

TEST(EnvironmentLight, SamplesHaveTheirDensityAndFindAllLight) {
  std::mt19937 engine(32);
  std::uniform_real_distribution<float> u(0, 1);
  for (const Picture& p : pictures()) {
    const EnvironmentLight light(environmentOf(p.image, kTurned));
    constexpr int kSamples = 100000;
    int disagree = 0;
    double sum = 0;
    for (int i = 0; i < kSamples; ++i) {
      const EnvironmentSample s = light.sample({u(engine), u(engine)});
      ASSERT_GT(s.pdf, 0) << p.name;
      ASSERT_NEAR(glm::length(s.direction), 1, 1e-5);
      disagree += !(std::fabs(light.pdf(s.direction) - s.pdf) <= 1e-3f * s.pdf);
      sum += static_cast<double>(core::luminance(s.radiance) / s.pdf) / kSamples;
    }
    EXPECT_LT(disagree, kSamples / 1000) << p.name;  // rounding at the feet of tents
    double integral = 0;
    constexpr int kSide = 16;
    eachCell(p.image, [&](const std::function<Vec3(float, float)>& place, double solidAngle) {
      for (int i = 0; i < kSide * kSide; ++i) {
        const Vec3 d = place((i / kSide + 0.5f) / kSide, (i % kSide + 0.5f) / kSide);
        integral += static_cast<double>(core::luminance(light.radiance(d))) * solidAngle / (kSide * kSide);
      }
    });
    EXPECT_NEAR(sum / integral, 1, 0.01) << p.name;
    EXPECT_NEAR(light.total() / integral, 1, 0.2) << p.name;  // it only steers: tents are not boxes
  }
}

TEST(EnvironmentLight, ASingleTexelIsSampledWithoutMuchNoise) {
  // The interpolated texel's solid angle: a tent in longitude times a tent in colatitude times the sine.
  const double step = M_PI / 32, colatitude = step * 9.5;
  const double exact = 1e5 * 2 * M_PI / 64 * std::sin(colatitude) * 2 * (1 - std::cos(step)) / step;
  const EnvironmentLight light(environmentOf(sun(64, 32, 40, 9, 1e5f)));
  std::mt19937 engine(33);
  std::uniform_real_distribution<float> u(0, 1);
  constexpr int kSamples = 20000;
  double mean = 0, squares = 0;
  for (int i = 0; i < kSamples; ++i) {
    const EnvironmentSample s = light.sample({u(engine), u(engine)});
    const double e = s.radiance.x / s.pdf;
    mean += e / kSamples;
    squares += e * e / kSamples;
  }
  EXPECT_NEAR(mean, exact, 0.01 * exact);
  EXPECT_LT(std::sqrt(squares - mean * mean), 0.1 * mean);  // of one sample; uniform ones: 30 times the mean
}

TEST(EnvironmentLight, BlackIsNoLight) {
  SceneMaker m;
  m.quad(m.material(tests::diffuseMaterial(Vec3(1))), 0, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
  m.scene.environment = environmentOf(constant(Vec3(0)));
  const World world(m.scene, planOf());
  EXPECT_TRUE(world.lights().empty());
  EXPECT_EQ(world.lights().environment(), nullptr);
}

/// White above, black below: the irradiance of a plane whose normal has cosine c against the vertical is
/// pi (1 + c) / 2.
core::ImageRgb upperHalf(int height) {
  core::ImageRgb image(2 * height, height);
  for (int y = 0; y < height / 2; ++y) {
    for (int x = 0; x < 2 * height; ++x) image.at(x, y) = Vec3(1);
  }
  return image;
}

PathOptions paths(int samples, int bounces) {
  PathOptions o;
  o.samplesPerPixel = samples;
  o.bounces = bounces;
  return o;
}

TEST(EnvironmentLight, PathsThatMissShowItAtAnyNumberOfBounces) {
  SceneMaker m;
  m.quad(m.material(tests::diffuseMaterial(Vec3(1))), 0, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
  m.scene.environment = environmentOf(sun(64, 32, 40, 9, 50), 20);
  const World world(m.scene, planOf());
  const EnvironmentLight& light = *world.lights().environment();
  RayCounters counters;
  std::mt19937 engine(34);
  for (int i = 0; i < 100; ++i) {
    Vec3 d = tests::randomDirection(engine);
    d.y = std::fabs(d.y);
    EXPECT_EQ(pathRadiance(world, {{0, 1, 0}, d, 0, core::kInfinity}, paths(1, 0), counters),
              light.radiance(d));
  }
}

TEST(EnvironmentLight, PlaneUnderHalfASky) {
  for (const float degrees : {0.0f, 40.0f, 90.0f, 150.0f}) {
    SceneMaker m;
    m.quad(m.material(tests::diffuseMaterial(Vec3(0.5f))), 0, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
    const float a = glm::radians(degrees);
    const auto turn = [&](const Vec3& v) {
      return Vec3(v.x * std::cos(a) + v.y * std::sin(a), -v.x * std::sin(a) + v.y * std::cos(a), v.z);
    };
    for (core::Mesh& mesh : m.scene.meshes) {
      for (Vec3& p : mesh.positions) p = turn(p);
      for (Vec3& n : mesh.normals) n = turn(n);
    }
    m.scene.environment = environmentOf(upperHalf(64));
    const World world(m.scene, planOf());
    RayCounters counters;
    const Ray ray{turn({0.1f, 1, 0.2f}), turn({0, -1, 0}), 0, core::kInfinity};
    const Vec3 l = pathRadiance(world, ray, paths(40000, 1), counters);
    EXPECT_NEAR(l.x, 0.5 * (1 + std::cos(a)) / 2, 0.004) << degrees;
  }
}

TEST(EnvironmentLight, WhiteThingsVanishInAConstantOne) {
  for (const bool lamp : {false, true}) {
    SceneMaker m;
    m.sphere(m.material(tests::diffuseMaterial(Vec3(1))), 0, Vec3(0), 1, 24);
    m.sphere(m.material(tests::glassMaterial(1.5f, 0)), 1, Vec3(3, 0, 0), 1, 24);
    m.sphere(m.material(tests::diffuseMaterial(Vec3(1))), 0, Vec3(-3, 0, 0), 1, 24);
    // A lamp that adds nothing but a second thing to sample.
    if (lamp)
      m.quad(m.material(tests::diffuseMaterial(Vec3(0), Vec3(1))), 0, {-1, 4, -1}, {2, 0, 0}, {0, 0, 2});
    m.scene.environment = environmentOf(constant(Vec3(1)));
    const World world(m.scene, planOf());
    RayCounters counters;
    for (const float x : {0.2f, 3.3f, -2.5f}) {
      const Ray ray{{x, 0.3f, 6}, {0, 0, -1}, 0, core::kInfinity};
      EXPECT_NEAR(pathRadiance(world, ray, paths(8000, 100), counters).x, 1, 0.015) << x << " " << lamp;
    }
  }
}

TEST(EnvironmentLight, LightAndScatteringSamplesAgreeAtEveryRoughness) {
  // The same sky as a light and as an unlit shell, which only scattered rays find.
  for (const float roughness : {0.2f, 0.5f, 1.0f}) {
    const auto radiance = [&](bool sampled) {
      SceneMaker m;
      m.quad(m.material(tests::metalMaterial(Vec3(0.9f), roughness)), 1, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
      if (sampled) {
        m.scene.environment = environmentOf(constant(Vec3(1)));
      } else {
        core::Material shell = tests::diffuseMaterial(Vec3(1));
        shell.unlit = true;
        m.box(m.material(shell), 0, Vec3(-50), Vec3(50), true);
      }
      const World world(m.scene, planOf());
      RayCounters counters;
      const Ray ray{{-0.5f, 0.5f, 0}, glm::normalize(Vec3(1, -1, 0)), 0, core::kInfinity};
      return pathRadiance(world, ray, paths(40000, 2), counters).x;
    };
    const float joined = radiance(true), scattered = radiance(false);
    EXPECT_GT(joined, 0.1f);
    EXPECT_NEAR(joined, scattered, 0.01f * joined) << roughness;
  }
}

TEST(EnvironmentLight, PhotonsCarryThePowerThroughTheBoundingSphere) {
  for (const Picture& p : pictures()) {
    SceneMaker m;
    m.box(m.material(tests::diffuseMaterial(Vec3(1))), 0, Vec3(1), Vec3(2, 3, 4));
    m.scene.environment = environmentOf(p.image, kTurned);
    const World world(m.scene, planOf());
    const Vec3 center = m.scene.bounds.center();
    const float radius = 0.5f * m.scene.bounds.diagonal();
    std::mt19937 engine(35);
    std::uniform_real_distribution<float> u(0, 1);
    double power = 0, flux = 0;
    eachCell(p.image, [&](const std::function<Vec3(float, float)>& place, double solidAngle) {
      for (int i = 0; i < 64; ++i) {
        const Vec3 d = place((i / 8 + 0.5f) / 8, (i % 8 + 0.5f) / 8);
        power += M_PI * radius * radius * solidAngle / 64 *
                 static_cast<double>(core::luminance(world.lights().environment()->radiance(d)));
      }
    });
    constexpr int kPhotons = 50000;
    for (int i = 0; i < kPhotons; ++i) {
      const EmissionSample s =
          world.lights().sampleEmission(u(engine), {u(engine), u(engine)}, {u(engine), u(engine)});
      flux += static_cast<double>(core::luminance(s.flux)) / kPhotons;
      const Vec3 from = s.origin - center;
      ASSERT_LE(glm::length(from - glm::dot(from, s.direction) * s.direction), radius * 1.0001f);
      ASSERT_LE(glm::dot(from, s.direction), -radius);  // starts outside
    }
    EXPECT_NEAR(flux / power, 1, 0.02) << p.name;
  }
}

BakeOptions bakeOptions(const std::string& quality, std::uint64_t photons) {
  BakeOptions o;
  o.quality = quality;
  o.photons = photons;
  o.threads = 2;
  return o;
}

TEST(EnvironmentBake, ConvexBodyUnderAConstantSkyHasIrradiancePiEverywhere) {
  SceneBuilder b;
  b.box(SceneBuilder::matte(0.5f), Vec3(0), Vec3(1, 1.2f, 0.8f), false);
  b.scene.environment = environmentOf(constant(Vec3(1, 2, 0.5f)));
  const Baked baked(std::move(b.scene), 64, bakeOptions("medium", 50000));
  for (int face = 0; face < 6; ++face) {
    const core::Bounds& bounds = baked.scene().objects[static_cast<std::size_t>(face)].bounds;
    for (const float s : {0.1f, 0.5f, 0.9f}) {
      const Vec3 e = baked.irradiance(face, glm::mix(bounds.lo, bounds.hi, s));
      EXPECT_NEAR(e.x / core::kPi, 1, 0.02) << face;
      EXPECT_NEAR(e.y / core::kPi, 2, 0.04) << face;
    }
  }
}

TEST(EnvironmentBake, SphereUnderHalfASkyFollowsTheCosine) {
  SceneBuilder b;
  const int sphere = b.patch(SceneBuilder::matte(0.5f), 48, 24, [](float s, float t) {
    const float phi = 2 * core::kPi * s, theta = core::kPi * (1 - t);
    return Vec3(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi));
  });
  b.scene.environment = environmentOf(upperHalf(64));
  const Baked baked(std::move(b.scene), 128, bakeOptions("medium", 1000));
  const core::Mesh& mesh =
      baked.scene()
          .meshes[static_cast<std::size_t>(baked.scene().objects[static_cast<std::size_t>(sphere)].mesh)];
  double squares = 0;
  int n = 0;
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const auto corner = [&](std::size_t k) { return mesh.positions[mesh.indices[3 * t + k]]; };
    const Vec3 cross = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
    if (!(glm::length(cross) > 1e-6f)) continue;  // at the poles of the patch
    Vec3 at(0);
    Vec2 uv(0);
    for (std::size_t k = 0; k < 3; ++k) {
      at += corner(k) / 3.0f;
      uv += mesh.lightmapUv[mesh.indices[3 * t + k]] / 3.0f;
    }
    const double truth = M_PI * (1 + static_cast<double>(glm::normalize(at).y)) / 2;
    squares += std::pow(static_cast<double>(baked.world().irradiance(uv, 0).x) - truth, 2);
    ++n;
  }
  EXPECT_LT(std::sqrt(squares / n) / (M_PI / 2), 0.02);
}

TEST(EnvironmentBake, MapsAgreeWithPathsWhereLightGoesRoundCorners) {
  // A corner of two walls and a floor under a sky with a sun; a post that throws a shadow.
  SceneBuilder b;
  const int floor = b.quad(SceneBuilder::matte(0.6f), Vec3(-1, 0, 1), Vec3(2, 0, 0), Vec3(0, 0, -2));
  b.quad(SceneBuilder::matte(0.7f), Vec3(-1, 0, -1), Vec3(2, 0, 0), Vec3(0, 1.5f, 0));
  b.quad(SceneBuilder::matte(0.8f), Vec3(-1, 0, 1), Vec3(0, 0, -2), Vec3(0, 1.5f, 0));
  b.box(SceneBuilder::matte(0.5f), Vec3(0.2f, 0.001f, -0.2f), Vec3(0.4f, 0.8f, 0), false);
  core::ImageRgb sky(64, 32, Vec3(0.3f, 0.4f, 0.6f));
  sky.at(42, 8) = Vec3(150, 140, 120);
  b.scene.environment = environmentOf(sky);
  const Baked baked(std::move(b.scene), 128, bakeOptions("medium", 1000000));
  RayCounters counters;
  PathOptions o = paths(10000, 40);
  o.transport = Transport::diffuse;
  double squares = 0, sum = 0;
  int n = 0;
  for (const float x : {-0.8f, -0.4f, 0.1f, 0.6f}) {
    for (const float z : {-0.7f, 0.25f, 0.7f}) {
      const Vec3 at(x, 0, z);
      const float base = 0.6f / core::kPi * baked.irradiance(floor, at).x;
      const float path =
          pathRadiance(baked.world(), {at + Vec3(0, 0.05f, 0), {0, -1, 0}, 0, core::kInfinity}, o, counters)
              .x;
      squares += std::pow(base - path, 2.0);
      sum += path;
      ++n;
    }
  }
  EXPECT_LT(std::sqrt(squares / n) / (sum / n), 0.04);
}

}  // namespace
}  // namespace saccade::raytrace
