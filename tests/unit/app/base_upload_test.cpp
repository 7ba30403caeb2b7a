// What is uploaded in portions, with other frames between them, draws what is uploaded at once.
#include <chrono>
#include <cmath>

#include "tests/unit/app/fixtures.h"

namespace saccade::tests {
namespace {

/// Larger than a portion takes, in each direction.
constexpr int kWidth = 700, kHeight = 900;

core::ImageRgba8 pattern() {
  core::ImageRgba8 image(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x)
      image.at(x, y) = {static_cast<std::uint8_t>(x * 7 + y), static_cast<std::uint8_t>(y * 5),
                        static_cast<std::uint8_t>(x ^ y), 255};
  }
  return image;
}

std::shared_ptr<const core::Environment> sky() {
  core::Environment sky;
  sky.radiance = core::ImageRgb(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x)
      sky.radiance.at(x, y) = {std::sin(0.1f * static_cast<float>(x)) + 1, 0.01f * static_cast<float>(y), 1};
  }
  return std::make_shared<const core::Environment>(std::move(sky));
}

class BaseUpload : public ::testing::TestWithParam<const char*> {};

TEST_P(BaseUpload, PortionsDrawTheSameBesideAnotherScene) {
  const app::Workspace& workspace = workspaceOf(bundled(GetParam()));
  core::Scene scene = workspace.scene;
  for (core::Texture& texture : scene.textures) texture.image = pattern();
  scene.environment = sky();
  const auto context = render::makeHeadlessContext(render::ContextKind::osmesa);
  render::BaseRenderer whole(*context, scene);
  whole.setMaps(&workspace.maps);
  const core::View view(scene.cameras[0], 160, 120, scene.bounds);
  const auto expected = whole.render(view, 1, 10);

  const app::Workspace& other = workspaceOf(bundled("cornell.glb"));
  render::BaseRenderer walked(*context, other.scene);
  const core::View otherView(other.scene.cameras[0], 80, 60, other.scene.bounds);
  const auto shown = walked.render(otherView, 1, 10);
  render::BaseUpload upload(*context, scene, render::makeDrawList(scene), &workspace.maps);
  int portions = 1;
  for (; !upload.goOn(std::chrono::steady_clock::now()); ++portions) {
    const auto frame = walked.render(otherView, 1, 10);
    ASSERT_EQ(frame->baseAndId, shown->baseAndId) << "after portion " << portions;
  }
  EXPECT_GT(portions, 10);
  const std::unique_ptr<render::BaseRenderer> renderer = upload.take();
  const auto frame = renderer->render(view, 1, 10);
  EXPECT_EQ(frame->baseAndId, expected->baseAndId);
  EXPECT_EQ(frame->depth, expected->depth);
  // Another bake replaces the maps of one as those of the other.
  renderer->setMaps(nullptr);
  whole.setMaps(nullptr);
  EXPECT_EQ(renderer->render(view, 1, 10)->baseAndId, whole.render(view, 1, 10)->baseAndId);
}

INSTANTIATE_TEST_SUITE_P(Scenes, BaseUpload, ::testing::Values("gallery.glb", "table.glb", "ward.glb"));

}  // namespace
}  // namespace saccade::tests
