// Animated nodes at a time: interpolation against glTF 2.0's appendix C, and scenes that show it.
#include "core/scene/gltf_animation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/maps.h"
#include "core/scene/load.h"
#include "tests/unit/core/gltf_builder.h"
#include "tests/unit/core/temporary_folder.h"

namespace saccade::core {
namespace {

using saccade::tests::GltfBuilder;
using saccade::tests::TemporaryFolder;

constexpr double kHalf = 0.70710678118654752;

void expectNear(const glm::dvec4& a, const glm::dvec4& b, double tolerance = 1e-6) {
  EXPECT_LT(glm::length(a - b), tolerance) << a.x << ' ' << a.y << ' ' << a.z << ' ' << a.w;
}

AnimationTrack line(Interpolation how) { return {how, 3, {1, 3, 4}, {1, 0, 0, 5, 2, 0, 5, 2, 8}}; }

TEST(AnimationTracks, LinearIsStraightBetweenItsKeys) {
  const AnimationTrack t = line(Interpolation::linear);
  expectNear(sampleTrack(t, 1.5), {2, 0.5, 0, 0});
  expectNear(sampleTrack(t, 3), {5, 2, 0, 0});
  expectNear(sampleTrack(t, 3.25), {5, 2, 2, 0});
}

TEST(AnimationTracks, StepHoldsUntilTheNextKey) {
  const AnimationTrack t = line(Interpolation::step);
  expectNear(sampleTrack(t, std::nextafter(3.0, 0.0)), {1, 0, 0, 0}, 1e-12);
  expectNear(sampleTrack(t, 3), {5, 2, 0, 0}, 1e-12);
  expectNear(sampleTrack(t, 3.99), {5, 2, 0, 0}, 1e-12);
}

TEST(AnimationTracks, EndsAreHeldBeforeTheFirstAndAfterTheLastKey) {
  for (const Interpolation how : {Interpolation::step, Interpolation::linear}) {
    expectNear(sampleTrack(line(how), 0), {1, 0, 0, 0}, 1e-12);
    expectNear(sampleTrack(line(how), 4), {5, 2, 8, 0}, 1e-12);
    expectNear(sampleTrack(line(how), 1e9), {5, 2, 8, 0}, 1e-12);
  }
  const AnimationTrack one{Interpolation::linear, 3, {2}, {7, 8, 9}};
  for (const double at : {0.0, 2.0, 5.0}) expectNear(sampleTrack(one, at), {7, 8, 9, 0}, 1e-12);
}

TEST(AnimationTracks, RotationsTurnEvenlyByTheShorterArc) {
  // From none to 90 degrees about y, once with the second key's sign turned: the same rotation.
  for (const float sign : {1.0f, -1.0f}) {
    const auto h = sign * static_cast<float>(kHalf);
    const AnimationTrack t{Interpolation::linear, 4, {0, 3}, {0, 0, 0, 1, 0, h, 0, h}};
    const double angle = M_PI / 2 / 3 / 2;  // half of a third of the way
    glm::dvec4 q = sampleTrack(t, 1);
    if (q.w < 0) q = -q;
    expectNear(q, {0, std::sin(angle), 0, std::cos(angle)});
    EXPECT_NEAR(glm::length(q), 1, 1e-12);
  }
}

TEST(AnimationTracks, EqualRotationsAndKeysOfZeroGiveNoNan) {
  const AnimationTrack same{Interpolation::linear, 4, {0, 1}, {0, 0, 1, 0, 0, 0, 1, 0}};
  expectNear(sampleTrack(same, 0.3), {0, 0, 1, 0});
  const AnimationTrack zero{Interpolation::linear, 4, {0, 1}, {0, 0, 0, 0, 0, 0, 0, 1}};
  expectNear(sampleTrack(zero, 0.3), {0, 0, 0, 1});
}

TEST(AnimationTracks, CubicSplinesReproduceACubicOfAnyKeySpacing) {
  // p(t) = t^3 - 2t + 1 has the slope 3t^2 - 2; exact only when tangents are scaled by the keys' distance.
  const auto p = [](double t) { return t * t * t - 2 * t + 1; };
  AnimationTrack track{Interpolation::cubicSpline, 3, {0.5f, 1, 3}, {}};
  for (const float t : track.times) {
    const float slope = 3 * t * t - 2, value = static_cast<float>(p(t));
    track.values.insert(track.values.end(), {slope, 0, 0, value, 0, 0, slope, 0, 0});
  }
  for (double t = 0.5; t < 3; t += 0.0625) expectNear(sampleTrack(track, t), {p(t), 0, 0, 0}, 1e-12);
  expectNear(sampleTrack(track, 0), {p(0.5), 0, 0, 0}, 1e-12);
  expectNear(sampleTrack(track, 9), {p(3), 0, 0, 0}, 1e-12);
}

TEST(AnimationTracks, CubicSplineTangentsAreInValueOut) {
  // Only the first key's out-tangent and the second's in-tangent shape what lies between.
  const AnimationTrack track{
      Interpolation::cubicSpline, 3, {0, 2}, {9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 0, 9, 9, 9}};
  expectNear(sampleTrack(track, 1), {2 * 0.125 * 1, -2 * 0.125 * 2, 0, 0}, 1e-12);
}

// ---- scenes

int addTrack(GltfBuilder& b, int node, const char* path, const char* how, const std::vector<float>& times,
             int output, int animation = 0) {
  auto& animations = b.json["animations"];
  while (static_cast<int>(animations.size()) <= animation)
    animations.push_back({{"samplers", nlohmann::json::array()}, {"channels", nlohmann::json::array()}});
  auto& into = animations[static_cast<std::size_t>(animation)];
  into["samplers"].push_back(
      {{"input", b.floats("SCALAR", times)}, {"output", output}, {"interpolation", how}});
  into["channels"].push_back(
      {{"sampler", into["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
  return output;
}

Scene loadAt(GltfBuilder& b, double seconds) {
  TemporaryFolder folder;
  LoadOptions options;
  options.timeSeconds = seconds;
  return loadScene(b.write(folder / "a.glb"), options);
}

bool warned(const Scene& scene, const std::string& part) {
  for (const std::string& w : scene.warnings)
    if (w.find(part) != std::string::npos) return true;
  return false;
}

const std::vector<Vec3>& positions(const Scene& scene) { return scene.meshOf(scene.objects[0]).positions; }

TEST(AnimatedScenes, ANodeStandsWhereItIsAtTheTime) {
  GltfBuilder b;
  addTrack(b, 0, "translation", "LINEAR", {0, 2}, b.floats("VEC3", {0, 0, 0, 4, 0, 0}));
  const Scene still = loadAt(b, 0), moved = loadAt(b, 0.5), ended = loadAt(b, 100);
  EXPECT_EQ(positions(still)[0], Vec3(0));
  EXPECT_EQ(positions(moved)[0], Vec3(1, 0, 0));
  EXPECT_EQ(positions(ended)[1], Vec3(5, 0, 0));
  EXPECT_EQ(moved.objects[0].bounds.lo.x, 1);
  EXPECT_EQ(moved.timeSeconds, 0.5);
  EXPECT_NE(sceneKey(still), sceneKey(moved));
  EXPECT_EQ(sceneKey(ended), sceneKey(loadAt(b, 2)));
  ASSERT_EQ(still.animations.size(), 1u);
  EXPECT_EQ(still.animations[0].lastSeconds, 2);
  // The default camera looks at where the triangle is, not where it was.
  ASSERT_TRUE(ended.defaultCamera);
  const View view(ended.cameras[0], 64, 64, ended.bounds);
  const auto seen = view.project(Vec3(4.3f, 0.3f, 0));
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->pixel.x, 32, 24);
}

TEST(AnimatedScenes, TwoChannelsOnOneNodeWithRotationInNormalizedShorts) {
  GltfBuilder b;
  b.json["nodes"][0]["scale"] = {2, 2, 2};  // what no channel moves stays
  addTrack(b, 0, "translation", "STEP", {0, 1}, b.floats("VEC3", {0, 0, 0, 0, 0, 3}));
  addTrack(b, 0, "rotation", "LINEAR", {0, 1},
           b.accessor<std::int16_t>("VEC4", 5122, {0, 0, 0, 32767, 0, 0, 32767, 0}, true));
  const Scene scene = loadAt(b, 0.5);  // 90 degrees about z: x turns to y
  EXPECT_LT(glm::length(positions(scene)[1] - Vec3(0, 2, 0)), 1e-6f);
  EXPECT_LT(glm::length(positions(loadAt(b, 1))[1] - Vec3(-2, 0, 3)), 1e-6f);
}

TEST(AnimatedScenes, ChildrenCamerasAndLightsMoveAlong) {
  GltfBuilder b;
  b.json["nodes"][0]["children"] = {1, 2};
  b.json["nodes"].push_back({{"name", "eye"}, {"camera", 0}});
  b.json["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  b.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
  b.json["extensionsUsed"] = {"KHR_lights_punctual"};
  b.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"}, {"spot", nlohmann::json::object()}}};
  const auto h = static_cast<float>(kHalf);
  addTrack(b, 0, "rotation", "LINEAR", {0, 1}, b.floats("VEC4", {0, 0, 0, 1, 0, h, 0, h}));
  addTrack(b, 0, "translation", "LINEAR", {0, 1}, b.floats("VEC3", {0, 0, 0, 0, 6, 0}), 1);
  const Scene scene = loadAt(b, 1);
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.cameras[0].eye, Vec3(0, 6, 0));
  EXPECT_LT(glm::length(scene.cameras[0].at - Vec3(-1, 6, 0)), 1e-6f);  // -z turns to -x
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].position, Vec3(0, 6, 0));
  EXPECT_LT(glm::length(scene.lights[0].direction - Vec3(-1, 0, 0)), 1e-6f);
  EXPECT_EQ(scene.animations.size(), 2u);
}

TEST(AnimatedScenes, TheFirstAnimationOfAPropertyCounts) {
  GltfBuilder b;
  addTrack(b, 0, "translation", "LINEAR", {0}, b.floats("VEC3", {1, 0, 0}), 0);
  addTrack(b, 0, "translation", "LINEAR", {0}, b.floats("VEC3", {2, 0, 0}), 1);
  const Scene scene = loadAt(b, 0);
  EXPECT_EQ(positions(scene)[0], Vec3(1, 0, 0));
  EXPECT_TRUE(warned(scene, "1 animation channels move what an earlier animation moves"));
}

TEST(AnimatedScenes, NodesWithAMatrixStayAndAreCounted) {
  GltfBuilder b;
  b.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 7, 1};
  addTrack(b, 0, "translation", "LINEAR", {0, 1}, b.floats("VEC3", {1, 0, 0, 2, 0, 0}));
  const Scene scene = loadAt(b, 1);
  EXPECT_EQ(positions(scene)[0], Vec3(0, 0, 7));
  EXPECT_TRUE(warned(scene, "1 animation channels of nodes that have a matrix"));
}

TEST(AnimatedScenes, MorphWeightsAndPointersAreCounted) {
  GltfBuilder b;
  addTrack(b, 0, "weights", "LINEAR", {0}, b.floats("SCALAR", {1}));
  addTrack(b, 0, "pointer", "LINEAR", {0}, b.floats("SCALAR", {1}));
  b.json["animations"][0]["channels"][1]["target"] = {
      {"path", "pointer"},
      {"extensions", {{"KHR_animation_pointer", {{"pointer", "/materials/0/alphaCutoff"}}}}}};
  b.json["extensionsUsed"] = {"KHR_animation_pointer"};
  const Scene scene = loadAt(b, 0);
  EXPECT_TRUE(warned(scene, "1 animation channels of morph targets"));
  EXPECT_TRUE(warned(scene, "1 animation channels of properties other than node transforms"));
  EXPECT_TRUE(scene.animations.empty());
}

TEST(AnimatedScenes, TimesMustBeUsable) {
  GltfBuilder b;
  for (const double bad : {-1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)})
    EXPECT_THROW(loadAt(b, bad), UsageError);
}

}  // namespace
}  // namespace saccade::core
