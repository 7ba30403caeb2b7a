// Light from another program's lightmaps: known values come out as irradiance at known points.
#include "raytrace/bake/imported_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/raytrace/bake_scenes.h"

namespace saccade::raytrace {
namespace {

using core::Vec2;
using core::Vec3;

/// Irradiance (u, v, 3) at the place (u, v).
core::ImageRgb ramp(int width, int height) {
  core::ImageRgb image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.at(x, y) = Vec3((static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                            (static_cast<float>(y) + 0.5f) / static_cast<float>(height), 3);
  return image;
}

/// A floor of 1 x 1 m (object 0), another beside it (1) and a lamp over both (2). The floor's second UV set
/// is place(x, z).
template <class Place>
core::Scene floors(Place&& place, bool doubleSided = false) {
  SceneBuilder b;
  core::Material matte = SceneBuilder::matte(0.5f);
  matte.doubleSided = doubleSided;
  b.patch(matte, 4, 4, [](float s, float t) { return Vec3(t, 0, s); });
  b.quad(SceneBuilder::matte(0.5f), Vec3(2, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 0));
  b.disk(SceneBuilder::matte(0, Vec3(10)), Vec3(1.5f, 2, 0.5f), 0.5f, 16);
  core::Mesh& floor = b.scene.meshes[0];
  for (const Vec3& p : floor.positions) floor.uv1.push_back(place(p.x, p.z));
  return b.scene;
}

ImportedLight forTheFloor(core::ImageRgb image) {
  ImportedLight light;
  light.images.push_back(std::move(image));
  light.imageOfObject = {0, -1, -1};
  return light;
}

Baked baked(core::Scene scene, const ImportedLight* imported, int threads = 0) {
  BakeOptions options;
  options.quality = "preview";
  options.photons = 5000;
  options.threads = threads;
  options.imported = imported;
  return Baked(std::move(scene), 128, options);
}

void expectNear(const Vec3& value, const Vec3& truth) {
  EXPECT_LT(glm::length(value - truth), 0.01f) << value.x << ' ' << value.y << ' ' << value.z;
}

TEST(ImportedLightmap, KnownValuesAtKnownPoints) {
  const auto place = [](float x, float z) { return Vec2(0.1f + 0.5f * z, 0.9f - 0.6f * x); };
  const ImportedLight light = forTheFloor(ramp(64, 32));
  const Baked scene = baked(floors(place), &light);
  for (const float x : {0.05f, 0.3f, 0.77f}) {
    for (const float z : {0.1f, 0.5f, 0.95f}) {
      const Vec2 uv = place(x, z);
      expectNear(scene.irradiance(0, Vec3(x, 0, z)), Vec3(uv.x, uv.y, 3));
    }
  }
}

TEST(ImportedLightmap, WhatHasNoLightmapIsBakedAsEver) {
  const auto place = [](float x, float z) { return Vec2(x, z); };
  const ImportedLight light = forTheFloor(core::ImageRgb(2, 2, Vec3(7)));
  const Baked with = baked(floors(place), &light), without = baked(floors(place), nullptr);
  const Vec3 middle(2.5f, 0, 0.5f);
  EXPECT_EQ(with.irradiance(1, middle), without.irradiance(1, middle));
  EXPECT_GT(without.irradiance(1, middle).x, 0.5f);
  expectNear(with.irradiance(0, Vec3(0.5f, 0, 0.5f)), Vec3(7));
}

TEST(ImportedLightmap, AtlasResolutionAveragesFinerImages) {
  // A checkerboard far finer than our texels: its mean arrives.
  core::ImageRgb checks(2048, 2048);
  for (int y = 0; y < 2048; ++y)
    for (int x = 0; x < 2048; ++x) checks.at(x, y) = Vec3((x + y) % 2 == 0 ? 0.0f : 2.0f);
  const ImportedLight light = forTheFloor(std::move(checks));
  const Baked scene = baked(floors([](float x, float z) { return Vec2(x, z); }), &light);
  float mean = 0;
  for (int i = 0; i < 25; ++i) {
    const Vec3 at(0.1f + 0.2f * static_cast<float>(i % 5), 0, 0.1f + 0.2f * static_cast<float>(i / 5));
    const float value = scene.irradiance(0, at).x;
    EXPECT_TRUE(value > 0.1f && value < 1.9f) << value;  // no single texel of the image
    mean += value / 25;
  }
  EXPECT_NEAR(mean, 1, 0.1f);
}

TEST(ImportedLightmap, CoordinatesOutsideRepeatAndTheEdgeStaysInside) {
  const ImportedLight light = forTheFloor(ramp(64, 64));
  const Baked scene = baked(floors([](float x, float z) { return Vec2(x + 3, z - 1); }), &light);
  expectNear(scene.irradiance(0, Vec3(0.3f, 0, 0.6f)), Vec3(0.3f, 0.6f, 3));
  // Two texels, left dark and right bright: u = 1 shows the right one alone, not the left one beyond the
  // edge.
  core::ImageRgb two(2, 1);
  two.at(1, 0) = Vec3(4);
  const ImportedLight halves = forTheFloor(std::move(two));
  const Baked edge = baked(floors([](float x, float) { return Vec2(x, 0.5f); }), &halves);
  expectNear(edge.irradiance(0, Vec3(0.995f, 0, 0.5f)), Vec3(4));
  expectNear(edge.irradiance(0, Vec3(0.005f, 0, 0.5f)), Vec3(0));
}

TEST(ImportedLightmap, PartsOverEachOtherShareTheirLight) {
  // Both halves of the floor lie on the whole image.
  const auto folded = [](float x, float z) { return Vec2(1 - std::abs(2 * x - 1), z); };
  const ImportedLight light = forTheFloor(ramp(64, 64));
  const Baked scene = baked(floors(folded), &light);
  expectNear(scene.irradiance(0, Vec3(0.2f, 0, 0.5f)), Vec3(0.4f, 0.5f, 3));
  expectNear(scene.irradiance(0, Vec3(0.8f, 0, 0.5f)), Vec3(0.4f, 0.5f, 3));
}

TEST(ImportedLightmap, BacksGetTheSame) {
  const ImportedLight light = forTheFloor(ramp(32, 32));
  const Baked scene = baked(floors([](float x, float z) { return Vec2(x, z); }, true), &light);
  ASSERT_EQ(scene.maps().layers, 2);
  for (const int layer : {0, 1})
    expectNear(scene.irradiance(0, Vec3(0.25f, 0, 0.75f), layer), Vec3(0.25f, 0.75f, 3));
}

TEST(ImportedLightmap, SameOnAnyNumberOfThreads) {
  const ImportedLight light = forTheFloor(ramp(32, 32));
  const auto place = [](float x, float z) { return Vec2(x, z); };
  EXPECT_EQ(baked(floors(place), &light, 0).maps().texels, baked(floors(place), &light, 3).maps().texels);
}

TEST(ImportedLightmap, NeedsASecondUvSetOfFiniteNumbers) {
  core::Mesh mesh;
  EXPECT_FALSE(hasLightmapUv(mesh));
  mesh.uv1 = {Vec2(0), Vec2(2, -1)};
  EXPECT_TRUE(hasLightmapUv(mesh));
  mesh.uv1.emplace_back(NAN, 0);
  EXPECT_FALSE(hasLightmapUv(mesh));
}

}  // namespace
}  // namespace saccade::raytrace
