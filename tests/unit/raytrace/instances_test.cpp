// Instances of a mesh are what the same mesh copied into the world is.
#include "core/scene/instances.h"

#include <gtest/gtest.h>

#include <bit>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "core/error.h"
#include "core/scene/load.h"
#include "raytrace/path_tracer.h"
#include "raytrace/surface.h"
#include "raytrace/world.h"
#include "tests/unit/raytrace/test_scene.h"

namespace saccade::raytrace {
namespace {

using core::Mat4;
using tests::planOf;
using tests::SceneMaker;

/// Places the mesh of an object (by index, made in mesh space) here, and once more for each further
/// transform.
void placeAt(core::Scene& scene, std::size_t object, const std::vector<Mat4>& places) {
  scene.meshOf(scene.objects[object]).instanced = true;
  for (std::size_t i = 0; i < places.size(); ++i) {
    core::Object o = scene.objects[object];
    o.meshToWorld = places[i];
    o.name += " at place " + std::to_string(i);
    o.bounds = {};
    for (const Vec3& p : scene.meshOf(o).positions) o.bounds.add(core::Placement(places[i]).point(p));
    scene.bounds.add(o.bounds);
    if (i == 0) {
      scene.objects[object] = o;
    } else {
      scene.objects.push_back(o);
    }
  }
}

core::Scene flattened(core::Scene scene) {
  core::chooseInstances(scene, ~std::size_t{0});
  return scene;
}

Mat4 moved(const Vec3& to, float degrees, const Vec3& scale) {
  const Mat4 turned = glm::rotate(Mat4(1), glm::radians(degrees), glm::normalize(Vec3(1, 2, 3)));
  return glm::translate(Mat4(1), to) * turned * glm::scale(Mat4(1), scale);
}

/// Turned, stretched and mirrored.
std::vector<Mat4> places(const Vec3& at, float scale) {
  return {moved(at, 0, Vec3(scale)), moved(at + scale * Vec3(4, 0, 0), 50, scale * Vec3(1, 2, 0.5f)),
          moved(at + scale * Vec3(0, 5, 0), 130, scale * Vec3(-1, 1, 1.5f)),
          moved(at + scale * Vec3(0, 0, 6), 200, scale * Vec3(-1, -1, -1))};
}

core::Scene balls(const Vec3& at, float scale, int rings = 32) {
  SceneMaker m;
  m.sphere(m.material(tests::metalMaterial(Vec3(1), 0.2f)), 1, Vec3(0), 1, rings);
  placeAt(m.scene, 0, places(at, scale));
  for (std::uint32_t i = 0; i < m.scene.objects.size(); ++i) m.scene.objects[i].id = i + 1;
  return m.scene;
}

TEST(Instances, RandomBitPatternsNeverAbort) {
  SceneMaker m;
  m.sphere(m.material(tests::metalMaterial(Vec3(1), 0)), 1, Vec3(0), 1, 8);
  placeAt(m.scene, 0,
          {moved(Vec3(1e6f), 30, Vec3(0x1p-28f)), moved(Vec3(0), 70, Vec3(0x1p28f, 0x1p27f, 0x1p26f)),
           moved(Vec3(-3e7f, 0, 1), 10, Vec3(1, 2e-3f, 1))});
  const World world(m.scene, planOf());
  std::mt19937 engine(1);
  const auto bits = [&] { return std::bit_cast<float>(static_cast<std::uint32_t>(engine())); };
  RayCounters counters;
  Hit hit;
  for (int i = 0; i < 1'000'000; ++i) {
    const Ray ray{{bits(), bits(), bits()}, {bits(), bits(), bits()}, bits(), bits()};
    world.intersect(ray, hit, counters);
    world.transmittance(ray, counters);
    const auto object = static_cast<std::uint32_t>(i % 3);
    if (i % 16 < 4) world.intersectVisible(object, ray, hit, counters);
    if (i % 16 == 5) world.closestPoint(object, ray.origin, hit);
  }
  EXPECT_GT(counters.refused, 1'000'000u);
  EXPECT_GT(counters.rays, 1000u);
}

/// Rays that leave a ball outwards do not meet it, rays inwards do.
void expectNoSelfHit(const Vec3& at, float scale) {
  const core::Scene scene = balls(at, scale);
  const World world(scene, planOf());
  std::mt19937 engine(2);
  std::uniform_real_distribution<float> u(0, 1);
  RayCounters counters;
  int selfHits = 0, missed = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto object = static_cast<std::uint32_t>(engine() % scene.objects.size());
    const auto triangle = static_cast<std::uint32_t>(engine() % world.triangleCount());
    const float r = std::sqrt(u(engine)), v = u(engine) * r;
    const Surface s = surfaceOn(world, object, triangle, 1 - r, v, true);
    Vec3 d = tests::randomDirection(engine);
    if (glm::dot(d, s.ng) < 0) d = -d;
    Hit hit;
    selfHits += world.intersect(s.leave(d), hit, counters) && hit.object == object;
    if (glm::dot(d, s.ng) > 0.02f) missed += !world.intersect(s.leave(-d), hit, counters);
  }
  EXPECT_EQ(selfHits, 0) << "at " << at.x << " scale " << scale;
  EXPECT_EQ(missed, 0) << "at " << at.x << " scale " << scale;
}

TEST(Instances, NoSelfShadowNearAndFar) {
  for (float distance : {0.0f, 1.0f, 100.0f, 10000.0f}) expectNoSelfHit(distance * Vec3(1, -1, 1), 1);
}

TEST(Instances, NoSelfShadowAtAnyScale) {
  for (int e : {-20, -10, 10, 20}) expectNoSelfHit(std::ldexp(1.0f, e) * Vec3(1, 2, 3), std::ldexp(1.0f, e));
}

TEST(Instances, HitsScaleExactlyWithPowersOfTwo) {
  const auto trace = [](int exponent) {
    const float scale = std::ldexp(1.0f, exponent);
    core::Scene scene = balls(Vec3(0), 1, 16);
    for (core::Object& o : scene.objects) o.meshToWorld = glm::scale(Mat4(1), Vec3(scale)) * o.meshToWorld;
    const World world(scene, planOf());
    std::mt19937 engine(4);
    RayCounters counters;
    std::vector<float> values;
    for (int i = 0; i < 30000; ++i) {
      Hit hit;
      const Ray ray{scale * Vec3(0, 0, 2.5f), tests::randomDirection(engine), 0, core::kInfinity};
      if (!world.intersect(ray, hit, counters)) continue;
      const Surface s = makeSurface(world, hit, ray.direction);
      values.insert(values.end(), {hit.t / scale, hit.u, hit.v, s.ns.x, s.offset / scale,
                                   static_cast<float>(hit.triangle), static_cast<float>(hit.object)});
      if (world.intersect(s.leave(s.ns), hit, counters)) values.push_back(hit.t / scale);
    }
    return values;
  };
  const std::vector<float> one = trace(0);
  ASSERT_GT(one.size(), 5000u);
  EXPECT_EQ(one, trace(20));
  EXPECT_EQ(one, trace(-20));
}

TEST(Instances, HitsAreThoseOfTheFlattenedScene) {
  const core::Scene scene = balls(Vec3(1, 2, 3), 1), flat = flattened(scene);
  ASSERT_EQ(flat.storedTriangleCount(), scene.triangleCount());
  const World world(scene, planOf()), flatWorld(flat, planOf());
  EXPECT_EQ(4 * world.triangleCount(), flatWorld.triangleCount());
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> u(-3, 12);
  RayCounters counters;
  int hits = 0, others = 0;
  for (int i = 0; i < 40000; ++i) {
    const Vec3 from(u(engine), u(engine), u(engine)), center(scene.objects[i % 4].meshToWorld[3]);
    const Ray ray{from, glm::normalize(center + tests::randomDirection(engine) - from), 0, core::kInfinity};
    Hit a, b;
    const bool met = world.intersect(ray, a, counters), flatMet = flatWorld.intersect(ray, b, counters);
    if (!met && !flatMet) continue;
    ++hits;
    const std::uint32_t first = flatWorld.firstTriangle(b.object);
    if (met != flatMet || a.object != b.object || a.triangle != b.triangle - first) {
      ++others;  // an edge, met on this side or on that
      continue;
    }
    const Surface s = makeSurface(world, a, ray.direction), f = makeSurface(flatWorld, b, ray.direction);
    ASSERT_NEAR(a.t, b.t, 1e-4f * (1 + b.t));
    ASSERT_EQ(s.front, f.front);
    ASSERT_GT(glm::dot(s.ng, f.ng), 0.9999f);
    ASSERT_GT(glm::dot(s.ns, f.ns), 0.999f);
    ASSERT_LT(glm::length(s.position - f.position), 1e-4f * (1 + b.t));
  }
  EXPECT_GT(hits, 5000);
  EXPECT_LT(others, hits / 500);
}

TEST(Instances, AClosedBodyHoldsItsRays) {
  const core::Scene scene = balls(Vec3(100, 0, -50), 1);
  const World world(scene, planOf());
  std::mt19937 engine(6);
  RayCounters counters;
  int escaped = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vec3 center(scene.objects[i % scene.objects.size()].meshToWorld[3]);
    Hit hit;
    escaped += !world.intersect({center, tests::randomDirection(engine), 0, core::kInfinity}, hit, counters);
  }
  EXPECT_EQ(escaped, 0);
}

TEST(Instances, OneObjectAloneIsMetInItsPlace) {
  const core::Scene scene = balls(Vec3(1, 2, 3), 1), flat = flattened(scene);
  const World world(scene, planOf()), flatWorld(flat, planOf());
  std::mt19937 engine(7);
  RayCounters counters;
  for (int i = 0; i < 4000; ++i) {
    const auto object = static_cast<std::uint32_t>(engine() % scene.objects.size());
    const Vec3 center(scene.objects[object].meshToWorld[3]),
        from = center + 8.0f * tests::randomDirection(engine);
    const Ray ray{from, center - from + 0.2f * tests::randomDirection(engine), 0, core::kInfinity};
    Hit a, b;
    ASSERT_TRUE(world.intersectVisible(object, ray, a, counters));
    ASSERT_TRUE(flatWorld.intersectVisible(object, ray, b, counters));
    ASSERT_EQ(a.object, object);
    ASSERT_NEAR(a.t, b.t, 1e-4f);
    ASSERT_TRUE(world.closestPoint(object, from, a) && flatWorld.closestPoint(object, from, b));
    const Surface s = makeSurface(world, a, ray.direction), f = makeSurface(flatWorld, b, ray.direction);
    ASSERT_NEAR(glm::length(s.position - from), glm::length(f.position - from), 1e-4f);
  }
}

TEST(Instances, EachShowsItsOwnMaterial) {
  SceneMaker m;
  core::Texture t;
  t.image = core::ImageRgba8(2, 1);
  t.image.at(0, 0) = {255, 255, 255, 0};
  t.image.at(1, 0) = {255, 255, 255, 255};
  t.nearest = true;
  m.scene.textures.push_back(t);
  core::Material masked = tests::diffuseMaterial(Vec3(1)), blended = masked;
  masked.alphaMode = core::AlphaMode::mask;
  masked.baseColorTexture.texture = 0;
  blended.alphaMode = core::AlphaMode::blend;
  blended.alpha = 0.25f;
  m.quad(m.material(tests::diffuseMaterial(Vec3(1))), 1, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});  // uv0 = (x, z)
  placeAt(m.scene, 0,
          {moved(Vec3(0), 0, Vec3(1)), moved(Vec3(2, 0, 0), 0, Vec3(1)), moved(Vec3(4, 0, 0), 0, Vec3(1))});
  m.scene.objects[1].material = m.material(masked);
  m.scene.objects[2].material = m.material(blended);
  for (std::uint32_t o = 0; o < 3; ++o) m.scene.objects[o].id = o + 1;
  const World world(m.scene, planOf());
  RayCounters counters;
  Hit hit;
  const auto at = [](float x) { return Ray{{x, 0.5f, 1}, {0, 0, -1}, 0, core::kInfinity}; };
  EXPECT_EQ(world.transmittance(at(0.25f), counters), 0);
  EXPECT_EQ(world.transmittance(at(2.25f), counters), 1);  // cut out
  EXPECT_EQ(world.transmittance(at(2.75f), counters), 0);
  EXPECT_EQ(world.transmittance(at(4.25f), counters), 0.75f);
  EXPECT_FALSE(world.intersectVisible(1, at(2.25f), hit, counters));
  EXPECT_TRUE(world.intersectVisible(0, at(0.25f), hit, counters));
  EXPECT_TRUE(world.intersectVisible(1, at(2.75f), hit, counters));
}

TEST(Instances, TheSamePlaceTwiceGoesToTheFirst) {
  core::Scene scene = balls(Vec3(0), 1, 8);
  scene.objects[3].meshToWorld = scene.objects[1].meshToWorld;
  const World world(scene, planOf());
  ASSERT_EQ(world.twinsOf(1).size(), 1u);
  EXPECT_EQ(world.twinsOf(1)[0].object, 3u);
  EXPECT_TRUE(world.twinsOf(0).empty() && world.twinsOf(3).empty());
  RayCounters counters;
  const Vec3 center(scene.objects[1].meshToWorld[3]);
  std::mt19937 engine(8);
  for (int i = 0; i < 500; ++i) {
    const Vec3 d = tests::randomDirection(engine);
    const Ray ray{center + 4.0f * d, -d, 0, core::kInfinity};
    Hit hit;
    ASSERT_TRUE(world.intersect(ray, hit, counters));
    ASSERT_NE(hit.object, 3u);
    ASSERT_TRUE(world.intersectVisible(3, ray, hit, counters));
    ASSERT_EQ(hit.object, 3u);
  }
}

TEST(Instances, WhatCannotBeOneIsRefused) {
  core::Scene scene = balls(Vec3(0), 1, 8);
  scene.objects[2].meshToWorld = glm::scale(Mat4(1), Vec3(1, 1, 0));
  EXPECT_THROW(World(scene, planOf()), core::Error);
  scene = balls(Vec3(0), 1, 8);
  scene.materials[0].emission = Vec3(1);
  EXPECT_THROW(World(scene, planOf()), core::Error);
}

core::Scene litRoom() {
  SceneMaker m;
  m.sphere(m.material(tests::metalMaterial({0.9f, 0.8f, 0.7f}, 0.2f)), 1, Vec3(0), 1, 24);
  placeAt(m.scene, 0,
          {moved({-1.5f, -1, 0}, 20, Vec3(1, 1.4f, 0.8f)), moved({1.5f, 0, 0}, 80, Vec3(-0.8f, 1, 0.6f)),
           moved({0, 1, -1}, 140, Vec3(0.7f))});
  m.scene.objects[1].material = m.material(tests::diffuseMaterial({0.2f, 0.6f, 0.9f}));
  m.scene.objects[2].material = m.material(tests::glassMaterial(1.5f, 0));
  m.box(m.material(tests::diffuseMaterial({0.6f, 0.5f, 0.4f})), 0, Vec3(-3), Vec3(3), true);
  m.quad(m.material(tests::diffuseMaterial(Vec3(0), Vec3(10))), 0, {-1, 2.9f, -1}, {2, 0, 0}, {0, 0, 2});
  for (std::uint32_t o = 0; o < 3; ++o) m.scene.objects[o].id = o == 1 ? 0 : o / 2 + 1;
  return m.scene;
}

TEST(Instances, PathsCarryTheLightOfTheFlattenedScene) {
  const core::Scene scene = litRoom(), flat = flattened(scene);
  const World world(scene, planOf()), flatWorld(flat, planOf());
  core::Camera camera;
  camera.eye = {0, 0.5f, 2.9f};
  camera.at = {0, 0, 0};
  const core::View view(camera, 24, 24, scene.bounds);
  PathOptions options;
  options.samplesPerPixel = 32;
  options.bounces = 5;
  options.variance = true;
  const PathResult a = tracePaths(world, view, options, {}), b = tracePaths(flatWorld, view, options, {});
  // The same random numbers: paths part only where roundings decide.
  double difference = 0, sum = 0, variance = 0;
  for (std::size_t i = 0; i < a.radiance.pixels().size(); ++i) {
    difference += core::luminance(a.radiance.pixels()[i] - b.radiance.pixels()[i]);
    sum += core::luminance(b.radiance.pixels()[i]);
    variance += core::luminance(a.variance.pixels()[i] + b.variance.pixels()[i]);
  }
  EXPECT_GT(sum, 0);
  EXPECT_LT(std::abs(difference), 3 * std::sqrt(variance));
  EXPECT_LT(std::abs(difference), 0.02 * sum);
}

TEST(Instances, TenMillionTrianglesInLittleMemory) {
  SceneMaker m;
  m.sphere(m.material(tests::metalMaterial(Vec3(0.8f), 0.1f)), 0, Vec3(0), 0.4f,
           16);  // 2 * 16 * 30 triangles
  std::vector<Mat4> grid;
  for (int i = 0; i < 10000; ++i) {
    grid.push_back(moved(Vec3(i % 100, i / 100 % 10, i / 1000), static_cast<float>(i), Vec3(1)));
  }
  placeAt(m.scene, 0, grid);
  const std::size_t own = m.scene.storedTriangleCount();
  core::completeScene(m.scene, {});
  EXPECT_GT(m.scene.triangleCount(), 9'500'000u);
  EXPECT_EQ(m.scene.storedTriangleCount(), own + 2);  // and the default light
  std::size_t bytes = m.scene.objects.size() * (sizeof(core::Object) + 2 * sizeof(core::HierarchyNode));
  for (const core::Mesh& mesh : m.scene.meshes) bytes += mesh.positions.size() * 64 + mesh.indices.size() * 4;
  const World world(m.scene, core::makePlan(m.scene));
  bytes += world.bytes();
  EXPECT_LT(bytes, 100u << 20);
  RecordProperty("bytes", static_cast<int>(bytes));
  RayCounters counters;
  int hits = 0;
  for (int i = 0; i < 1000; ++i) {
    Hit hit;
    const Vec3 at(i % 100, i / 100, 0);
    hits += world.intersect({at + Vec3(0, 0, -5), {0, 0, 1}, 0, core::kInfinity}, hit, counters) &&
            std::abs(hit.t - 4.6f) < 0.02f;
  }
  EXPECT_EQ(hits, 1000);
}

}  // namespace
}  // namespace saccade::raytrace
