// Light probes against truths that are known: a room whose walls shine each in its own colour.
#include "render/probe/probe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/scene/specular_albedo.h"
#include "render/probe/approximation.h"
#include "tests/unit/render/base_layer_fixture.h"

namespace saccade {
namespace {

using core::Vec3;

/// From -3 to 3; half of it in z.
constexpr Vec3 kHalfRoom{3, 3, 1.5f};
constexpr Vec3 kColors[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}};

/// Walls towards +x, -x, +y, -y, +z, -z in the order of kColors, seen from inside; material 6 is left for
/// others.
core::Scene coloredRoom() {
  core::Scene scene;
  for (const Vec3& color : kColors) {
    core::Material m;
    m.baseColor = color;
    m.unlit = true;
    scene.materials.push_back(m);
  }
  scene.materials.push_back(tests::lambert(Vec3(1)));
  for (int wall = 0; wall < 6; ++wall) {
    const int a = wall / 2, u = (a + 1) % 3, v = (a + 2) % 3;
    const float sign = wall % 2 == 0 ? 1 : -1;
    Vec3 corner = -kHalfRoom, along(0), up(0);
    corner[a] = sign * kHalfRoom[a];
    along[u] = 2 * kHalfRoom[u];
    up[v] = 2 * kHalfRoom[v];
    if (sign > 0) std::swap(along, up);  // u x v looks along +a: the front is towards the inside
    tests::addObject(scene, tests::makeQuad(corner, along, up, wall));
  }
  return scene;
}

/// The wall that a ray from inside the room meets, and how far from the wall's rim.
struct Met {
  int wall;
  float toRim;
};
Met wallMet(const Vec3& from, const Vec3& direction) {
  Met met{0, 0};
  float nearest = core::kInfinity;
  for (int a = 0; a < 3; ++a) {
    const float t = (std::copysign(kHalfRoom[a], direction[a]) - from[a]) / direction[a];
    if (!(t < nearest)) continue;
    nearest = t;
    const Vec3 left = kHalfRoom - glm::abs(from + t * direction);
    met = {2 * a + (direction[a] < 0 ? 1 : 0), std::min(left[(a + 1) % 3], left[(a + 2) % 3])};
  }
  return met;
}

float largest(const Vec3& v) { return std::max({v.x, v.y, v.z}); }

Vec3 randomDirection(std::mt19937& random) {
  std::normal_distribution<float> normal;
  return glm::normalize(Vec3(normal(random), normal(random), normal(random)));
}

class Probes : public tests::EachContext {};

TEST_P(Probes, ShowsWhatARayFromItsCenterMeets) {
  const core::Scene scene = coloredRoom();
  render::BaseRenderer renderer(*context_, scene);
  const Vec3 center(0.7f, -1.1f, 0.4f);
  const render::Probe probe(renderer, scene, center, {});
  std::mt19937 random(3);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 direction = randomDirection(random);
    const Met met = wallMet(center, direction);
    if (met.toRim < 0.3f) continue;  // more than two texels
    EXPECT_EQ(probe.radiance(center, direction, 0), kColors[met.wall]);
  }
}

TEST_P(Probes, FollowsRaysFromElsewhereToWhatTheyMeet) {
  const core::Scene scene = coloredRoom();
  render::BaseRenderer renderer(*context_, scene);
  const render::Probe probe(renderer, scene, Vec3(0), {});
  std::mt19937 random(4);
  std::uniform_real_distribution<float> place(-0.5f, 0.5f);
  int right = 0, rightWithoutDistance = 0, all = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3 from = Vec3(place(random), place(random), place(random)) * kHalfRoom;
    const Vec3 direction = randomDirection(random);
    const Met met = wallMet(from, direction);
    if (met.toRim < 0.3f) continue;
    ++all;
    right += probe.radiance(from, direction, 0) == kColors[met.wall];
    rightWithoutDistance += probe.radiance(Vec3(0), direction, 0) == kColors[met.wall];
  }
  RecordProperty("right", right);
  RecordProperty("without_distance", rightWithoutDistance);
  EXPECT_GT(right, 0.98 * all) << right << " of " << all;
  EXPECT_LT(rightWithoutDistance, 0.9 * all) << "or the distances would be idle";
}

TEST_P(Probes, AWideConeSeesTheMeanOfAllAround) {
  const core::Scene scene = coloredRoom();
  render::BaseRenderer renderer(*context_, scene);
  const render::Probe probe(renderer, scene, Vec3(0), {});
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 direction(0.01f);
    direction[axis] = 1;
    const Vec3 narrow = probe.radiance(Vec3(0), direction, 0.05f);
    const Vec3 wide = probe.radiance(Vec3(0), direction, core::kPi);
    EXPECT_EQ(narrow, kColors[2 * axis]);
    EXPECT_GE(largest(glm::abs(wide - narrow)), axis == 2 ? 0.0f : 0.2f);
  }
}

TEST_P(Probes, DoesNotSeeWhatIsHidden) {
  core::Scene scene = coloredRoom();
  scene.materials[6].unlit = true;
  tests::addObject(scene, tests::makeBox(Vec3(-0.5f), Vec3(0.5f), 6, 1));
  render::BaseRenderer renderer(*context_, scene);
  const Vec3 outside(0, 0, 1.2f);
  const Vec3 down(0, 0, -1);
  std::vector<char> hidden(scene.objects.size(), 0);
  EXPECT_EQ(render::Probe(renderer, scene, outside, {}).radiance(outside, down, 0), Vec3(1));
  hidden.back() = 1;
  EXPECT_EQ(render::Probe(renderer, scene, outside, hidden).radiance(outside, down, 0), kColors[5]);
}

SACCADE_EACH_CONTEXT(Probes);

class Approximations : public tests::EachContext {
 protected:
  /// The room with a box of material 6 in it, seen from the front: front face and one side in view.
  static core::Scene roomWith(const core::Material& material) {
    core::Scene scene = coloredRoom();
    scene.materials[6] = material;
    tests::addObject(scene, tests::makeBox({-0.6f, -0.5f, -0.5f}, {0.6f, 0.5f, 0.3f}, 6, 1));
    scene.objects.back().nonDiffuseAlbedo = 1;
    return scene;
  }
  static core::Camera camera() {
    core::Camera c;
    c.eye = {0.4f, 0.3f, 1.4f};
    c.at = {0, 0, 0.3f};
    c.fovYDegrees = 70;
    return c;
  }
  struct Result {
    std::shared_ptr<core::FrameSnapshot> frame;
    std::vector<core::Pixel> pixels;
    std::vector<Vec3> corrections;
  };
  Result approximated(const core::Scene& scene) {
    render::BaseRenderer renderer(*context_, scene);
    Result r;
    r.frame = renderer.render(core::View(camera(), 96, 96, scene.bounds), 1, 10);
    for (int y = 0; y < 96; ++y) {
      for (int x = 0; x < 96; ++x) {
        if (r.frame->idAt(x, y) != 0) r.pixels.push_back({x, y});
      }
    }
    render::Approximation approximation(scene, renderer);
    approximation.prepare(*r.frame, r.pixels);
    EXPECT_EQ(approximation.probesMade(), 1u);
    approximation.at(*r.frame, r.pixels, r.corrections);
    return r;
  }
};

TEST_P(Approximations, AMirrorShowsTheWallsThatItsRaysMeet) {
  core::Material mirror;
  mirror.baseColor = Vec3(0.9f, 0.8f, 0.7f);
  mirror.metallic = 1;
  mirror.roughness = 0;
  const core::Scene scene = roomWith(mirror);
  const Result r = approximated(scene);
  ASSERT_GT(r.pixels.size(), 1000u);
  int right = 0, all = 0;
  for (std::size_t i = 0; i < r.pixels.size(); ++i) {
    const auto [x, y] = r.pixels[i];
    const core::Vec2 center(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
    const Vec3 point = r.frame->view.unproject(center, r.frame->depth[r.frame->index(x, y)]);
    if (std::abs(point.z - 0.3f) > 1e-3f) continue;  // the front face
    const Vec3 direction = glm::normalize(point - camera().eye);
    const Met met = wallMet(point, direction * Vec3(1, 1, -1));
    if (met.toRim < 0.4f) continue;
    ++all;
    const core::AlbedoPair pair = core::directionalAlbedo(-direction.z, 0);
    const Vec3 truth = core::lobeAlbedo(pair, mirror.baseColor, 1) * kColors[met.wall];
    right += largest(glm::abs(r.corrections[i] - truth)) < 0.03f;
  }
  ASSERT_GT(all, 500);
  EXPECT_GT(right, 0.97 * all) << right << " of " << all;
}

TEST_P(Approximations, AThinSheetShowsWhatIsBehindIt) {
  core::Material sheet;
  sheet.metallic = 0;
  sheet.roughness = 0;
  sheet.transmission = 1;
  sheet.thinWalled = true;
  const Result r = approximated(roomWith(sheet));
  int right = 0, all = 0;
  for (std::size_t i = 0; i < r.pixels.size(); ++i) {
    const auto [x, y] = r.pixels[i];
    const core::Vec2 center(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
    const Vec3 direction = glm::normalize(r.frame->view.direction(center));
    const Met met = wallMet(camera().eye, direction);
    if (met.toRim < 0.4f || direction.z > -0.7f) continue;
    ++all;
    // All of it but what the surface reflects, at most a tenth at these angles.
    right += largest(glm::abs(r.corrections[i] - kColors[met.wall])) < 0.15f;
  }
  ASSERT_GT(all, 500);
  EXPECT_GT(right, 0.97 * all) << right << " of " << all;
}

TEST_P(Approximations, NewMapsMakeNewProbes) {
  core::Scene scene = roomWith(tests::lambert(Vec3(0)));
  for (int i = 0; i < 6; ++i) scene.materials[static_cast<std::size_t>(i)] = tests::lambert(Vec3(0.5f));
  scene.materials[6].metallic = 1;
  scene.materials[6].roughness = 0;
  scene.materials[6].baseColor = Vec3(1);
  render::BaseRenderer renderer(*context_, scene);
  const auto bright = tests::constantMaps({Vec3(core::kPi)}), dark = tests::constantMaps({Vec3(0)});
  render::Approximation approximation(scene, renderer);
  renderer.setMaps(&bright);
  const auto frame = renderer.render(core::View(camera(), 32, 32, scene.bounds), 1, 10);
  const core::Pixel pixel{16, 16};
  std::vector<Vec3> seen;
  approximation.prepare(*frame, {&pixel, 1});
  approximation.at(*frame, {&pixel, 1}, seen);
  EXPECT_GT(seen.at(0).x, 0.3f);
  renderer.setMaps(&dark);
  approximation.prepare(*frame, {&pixel, 1});
  approximation.at(*frame, {&pixel, 1}, seen);
  EXPECT_EQ(seen.at(0), Vec3(0));
}

SACCADE_EACH_CONTEXT(Approximations);

}  // namespace
}  // namespace saccade
