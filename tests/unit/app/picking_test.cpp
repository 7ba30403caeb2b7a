// Picking against the id mask and against rays, and outlines against the mask.
#include "app/session/picking.h"

#include "app/viewer/click.h"
#include "raytrace/world.h"
#include "tests/unit/app/fixtures.h"

namespace saccade::app {
namespace {

class Picking : public testing::Test {
 protected:
  static constexpr int kWidth = 96, kHeight = 72;

  void SetUp() override {
    Headless gl(tests::runOn("osmesa"), workspace_);
    frame_ =
        gl.renderer->render({workspace_.scene.cameras[0], kWidth, kHeight, workspace_.scene.bounds}, 1, 10);
  }

  const Workspace& workspace_ = tests::workspaceOf(tests::bundled("cornell.glb"));
  core::FramePtr frame_;
};

TEST_F(Picking, NamesWhatTheMaskAndRaysSayAtEveryPixel) {
  int nonDiffuse = 0, diffuse = 0, agree = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto picked = pick(*frame_, *workspace_.world, x, y);
      const std::uint32_t id = frame_->idAt(x, y);
      ASSERT_EQ(picked.has_value(), frame_->depth[frame_->index(x, y)] > 0);
      if (!picked) continue;
      const core::Object& object = workspace_.scene.objects[picked->object];
      EXPECT_EQ(picked->name, object.name);
      EXPECT_EQ(picked->id, object.id);
      (id > 0 ? nonDiffuse : diffuse) += 1;
      if (id > 0) {
        EXPECT_EQ(picked->id, id) << "the mask decides";
      }
      // The point is where a ray through the pixel meets something.
      const core::Vec3 eye = frame_->view.camera().eye;
      const core::Vec3 direction =
          frame_->view.direction({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
      raytrace::Hit hit;
      raytrace::RayCounters counters;
      ASSERT_TRUE(workspace_.world->intersectVisible({eye, direction, 0, core::kInfinity}, hit, counters));
      const float distance = hit.t * glm::length(direction);
      if (hit.object == picked->object && std::abs(picked->distance - distance) < 1e-3f * distance) ++agree;
    }
  }
  EXPECT_GT(nonDiffuse, 200);
  EXPECT_GT(diffuse, 200);
  EXPECT_GE(agree,
            (nonDiffuse + diffuse) * 98 / 100);  // the rest: edges, where rasteriser and rays may differ
}

TEST_F(Picking, AnOutlineFollowsTheMaskAndLeavesTheRestAlone) {
  std::uint32_t id = 0;
  for (int i = 0; id == 0; ++i) id = frame_->idAt(i % kWidth, i / kWidth);
  PickedObject picked;
  picked.id = id;
  const core::Rgba8 untouched{1, 2, 3, 255};
  core::ImageRgba8 picture(kWidth, kHeight, untouched);
  outline(picked, workspace_.scene, *frame_, picture);
  const auto on = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < kWidth && y < kHeight && frame_->idAt(x, y) == id;
  };
  int marked = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const int neighbours = on(x - 1, y) + on(x + 1, y) + on(x, y - 1) + on(x, y + 1);
      const bool border = on(x, y) ? neighbours < 4 : neighbours > 0;
      ASSERT_EQ(picture.at(x, y) != untouched, border) << x << " " << y;
      if (border) {
        EXPECT_EQ(picture.at(x, y) == kOutlineColor, !on(x, y));
      }
      marked += border;
    }
  }
  EXPECT_GT(marked, 20);
}

TEST_F(Picking, ADiffuseObjectsBoxHoldsItsPixels) {
  core::Bounds drawn;
  std::optional<PickedObject> picked;
  for (int y = 0; y < kHeight && !picked; ++y) {
    for (int x = 0; x < kWidth && !picked; ++x) {
      const auto at = pick(*frame_, *workspace_.world, x, y);
      if (at && at->id == 0) picked = at;
    }
  }
  ASSERT_TRUE(picked);
  core::ImageRgba8 picture(kWidth, kHeight, {1, 2, 3, 255});
  outline(*picked, workspace_.scene, *frame_, picture);
  int marked = 0;
  for (const core::Rgba8& p : picture.pixels()) marked += p == kOutlineColor;
  EXPECT_GT(marked, 0);
  EXPECT_LT(marked, kWidth * kHeight / 4) << "edges, not faces";
}

TEST(Lobes, SayWhatAMaterialSendsBack) {
  using List = std::vector<std::string>;
  core::Material m;
  m.metallic = 0;
  m.specular = 0;
  EXPECT_EQ(lobesOf(m), List{"diffuse"});
  m.metallic = 1;
  m.roughness = 0.25f;
  EXPECT_EQ(lobesOf(m), List{"metal, roughness 0.25"});
  m.metallic = 0;
  m.specular = 1;
  m.transmission = 1;
  m.ior = 1.45f;
  EXPECT_EQ(lobesOf(m), (List{"glass, index 1.45", "gloss, roughness 0.25"}));
  m.unlit = true;
  EXPECT_EQ(lobesOf(m), List{"unlit"});
}

TEST(Click, IsAPressAndAReleaseWithHardlyAWayBetween) {
  ClickDetector button;
  EXPECT_FALSE(button.release());
  button.press();
  button.move({1, 1});
  EXPECT_TRUE(button.release());
  button.press();
  button.move({3, 0});
  button.move({-3, 0});  // back where it began is a drag all the same
  EXPECT_FALSE(button.release());
  button.move({0, 0});
  EXPECT_FALSE(button.release());
}

}  // namespace
}  // namespace saccade::app
