// A lit room beside a dark one on one floor, one ceiling and two walls, parted by a wall much thinner or
// thicker than a texel: how much light the dark side shows, by the distance from the wall (density.h).
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/raytrace/bake_scenes.h"

namespace saccade::raytrace {
namespace {

using core::Vec3;
using Builder = SceneBuilder;

constexpr int kAtlas = 84;             // texels of 5 cm
constexpr float kNearlyBlack = 1e-4f;  // what is lit directly stays the only light

struct Rooms {
  float thickness = 0.01f;
  float albedo = kNearlyBlack;
  bool mirror = false;  ///< throws light on floor and wall in the lit room
  float wallX = 1;
};

core::Scene sceneOf(const Rooms& r) {
  const core::Material matte = Builder::matte(r.albedo);
  Builder b;
  b.box(matte, Vec3(0), Vec3(2.01f, 1, 1), true);
  b.quad(matte, Vec3(r.wallX, 0, 0), Vec3(0, 0, 1), Vec3(0, 1, 0));
  b.quad(matte, Vec3(r.wallX + r.thickness, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1));
  b.quad(Builder::matte(0, Vec3(10)), Vec3(0.3f, 0.99f, 0.3f), Vec3(0.4f, 0, 0), Vec3(0, 0, 0.4f));
  if (r.mirror) {
    core::Material metal = Builder::matte(0.9f);
    metal.metallic = 1;
    metal.roughness = 0.1f;
    b.quad(metal, Vec3(0.2f, 0.1f, 0.2f), Vec3(0, 0.6f, 0), Vec3(0, 0, 0.6f));
  }
  return std::move(b.scene);
}

/// The rooms with their maps.
class Leak {
 public:
  Leak(const Rooms& rooms, const char* quality)
      : wallX_(rooms.wallX),
        wallEnd_(rooms.wallX + rooms.thickness),
        baked_(sceneOf(rooms), kAtlas, optionsOf(quality)) {}

  /// The most irradiance on floor, ceiling and side walls at least so far behind the wall, over that of the
  /// floor before it.
  double beyond(float texels) const {
    const double lit = baked_.irradiance(0, Vec3(wallX_ - 0.1f, 0, 0.5f)).y;
    EXPECT_GT(lit, 1);
    double most = 0;
    for (float x = wallEnd_ + texels * baked_.texelMetres(); x < 2; x += 0.01f) {
      for (float s = 0.02f; s < 1; s += 0.02f) {
        for (const double e : {baked_.irradiance(0, Vec3(x, 0, s)).y, baked_.irradiance(1, Vec3(x, 1, s)).y,
                               baked_.irradiance(2, Vec3(x, s, 0)).y, baked_.irradiance(3, Vec3(x, s, 1)).y})
          most = std::max(most, e);
      }
    }
    return most / lit;
  }

 private:
  static BakeOptions optionsOf(const char* quality) {
    BakeOptions o;
    o.quality = quality;
    o.threads = 2;
    return o;
  }
  float wallX_, wallEnd_;
  Baked baked_;
};

constexpr double kNothing = 1e-4;

TEST(LightLeak, DirectLightEndsThreeTexelsBehindAThinWallWhereverItStands) {
  for (const float x : {1.0f, 1.013f, 1.027f, 1.04f}) {
    const Leak leak({.wallX = x}, "medium");
    EXPECT_LT(leak.beyond(0), 0.6) << "look-ups between texels, " << x;
    EXPECT_LT(leak.beyond(1.5f), 0.01) << x;
    EXPECT_LT(leak.beyond(3), kNothing)
        << x << ", two texels: " << leak.beyond(2) << ", " << leak.beyond(2.5f);
  }
}

TEST(LightLeak, DirectLightDoesNotPassAWallThickerThanATexel) {
  EXPECT_LT(Leak({.thickness = 0.12f}, "medium").beyond(0), kNothing);
}

TEST(LightLeak, CausticsEndThreeTexelsBehindAThinWall) {
  const Leak leak({.mirror = true}, "medium");
  EXPECT_LT(leak.beyond(1.5f), 0.002);
  EXPECT_LT(leak.beyond(3), kNothing);
}

TEST(LightLeak, IndirectLightBehindAThinWallStaysBelowHalfAPercent) {
  for (const char* quality : {"preview", "medium", "high"}) {
    const Leak leak({.albedo = 0.7f}, quality);
    EXPECT_LT(leak.beyond(1.5f), 0.02) << quality;
    EXPECT_LT(leak.beyond(3), 0.005) << quality;
  }
}

TEST(LightLeak, IndirectLightBehindAThickWallStaysBelowOnePercent) {
  EXPECT_LT(Leak({.thickness = 0.12f, .albedo = 0.7f}, "medium").beyond(0), 0.01);
}

}  // namespace
}  // namespace saccade::raytrace
