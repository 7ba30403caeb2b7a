// Sizes, buffers and threads of the base layer.
#include "render/base/base_renderer.h"

#include <thread>

#include "core/error.h"
#include "tests/hard_case.h"
#include "tests/unit/render/base_layer_fixture.h"

namespace saccade::tests {
namespace {

using core::FrameSnapshot;
using core::Scene;
using core::Vec3;
using core::Vec4;
using core::View;

class BaseFrames : public BaseLayer {};
SACCADE_EACH_CONTEXT(BaseFrames);

TEST_P(BaseFrames, SizesChangeAtAnyTime) {
  const Scene scene = surroundings();
  render::BaseRenderer renderer(*context_, scene);
  const auto at = [&](int w, int h) { return renderer.render(View({}, w, h, scene.bounds), 1, kNMin); };
  const auto first = at(64, 48);
  EXPECT_EQ(at(1, 1)->baseAndId.size(), 1u);
  EXPECT_EQ(at(3, 5)->depth.size(), 15u);
  EXPECT_EQ(at(517, 3)->extents.size(), 121u);
  const auto again = at(64, 48);
  EXPECT_EQ(first->baseAndId, again->baseAndId);
  EXPECT_EQ(first->depth, again->depth);
}

TEST_P(BaseFrames, Hard21SizesFromOnePixelToTheLongestSide) {
  // A wall that covers the picture: every pixel has its id, colour and depth.
  HardCase wrong =
      HardCase::counting("pixels of images from 1 x 1 to 16384 x 3 that do not show the wall", "pixels");
  for (const auto& [w, h] : {std::pair{1, 1}, {3, 5}, {16384, 3}, {3, 16384}, {2048, 2048}}) {
    Scene scene;
    scene.materials.push_back(lambert(Vec3(1)));
    const Vec3 half(2.5f * static_cast<float>(w) / static_cast<float>(h), 2.5f, 0);
    addObject(scene, makeQuad(Vec3(0, 0, -2) - half, {2 * half.x, 0, 0}, {0, 2 * half.y, 0}, 0, 5));
    const Vec4 truth(Vec3(core::baseDiffuseFactor(scene, scene.materials[0])), 5);
    render::BaseRenderer renderer(*context_, scene);
    const auto frame = renderer.render(View({}, w, h, scene.bounds), 1, kNMin);
    int off = 0;
    for (std::size_t i = 0; i < frame->baseAndId.size(); ++i) {
      const float depth = frame->view.viewDepth(frame->depth[i]);
      off += glm::length(frame->baseAndId[i] - truth) > 1e-5f || std::fabs(depth - 2) > 0.01f;
    }
    EXPECT_TRUE(wrong.within(off, 0)) << w << " x " << h;
    EXPECT_EQ(frame->baseAndId.size(), static_cast<std::size_t>(w) * static_cast<std::size_t>(h));
  }
}

TEST_P(BaseFrames, SizeBeyondTheLimitIsRefusedAndNothingIsLost) {
  const Scene scene = oneQuad(lambert(Vec3(1)), 1);
  render::BaseRenderer renderer(*context_, scene);
  EXPECT_THROW(renderer.render(View({}, context_->maxSize() + 1, 2, scene.bounds), 1, kNMin), core::Error);
  EXPECT_EQ(renderer.render(View({}, 4, 4, scene.bounds), 1, kNMin)->idAt(2, 2), 1u);
}

TEST_P(BaseFrames, EmptySceneIsBackground) {
  const auto frame = draw(Scene{}, nullptr, 3, 2);
  EXPECT_EQ(frame->baseAndId, std::vector<Vec4>(6, Vec4(0)));
  EXPECT_EQ(frame->depth, std::vector<float>(6, 0.0f));
  EXPECT_EQ(frame->nonDiffusePixels, 0u);
}

TEST_P(BaseFrames, HeldFramesStayAndReleasedBuffersAreReused) {
  const Scene scene = oneQuad(lambert(Vec3(1)), 1);
  render::BaseRenderer renderer(*context_, scene);
  core::Camera away;
  away.at = {0, 0, 1};
  auto held = renderer.render(View({}, 8, 8, scene.bounds), 1, kNMin);
  const std::vector<Vec4> copy = held->baseAndId;
  const auto other = renderer.render(View(away, 8, 8, scene.bounds), 2, kNMin);
  EXPECT_EQ(held->baseAndId, copy);
  EXPECT_EQ(held->epoch, 1u);
  EXPECT_EQ(other->epoch, 2u);
  EXPECT_EQ(other->nonDiffusePixels, 0u);
  const Vec4* buffer = held->baseAndId.data();
  std::thread([frame = std::move(held)]() mutable { frame.reset(); }).join();
  EXPECT_EQ(renderer.render(View({}, 8, 8, scene.bounds), 3, kNMin)->baseAndId.data(), buffer);
}

TEST_P(BaseFrames, OtherThreadsAreRefused) {
  const Scene scene = oneQuad(lambert(Vec3(1)));
  render::BaseRenderer renderer(*context_, scene);
  const View view({}, 4, 4, scene.bounds);
  bool refused = false;
  std::thread([&] {
    try {
      renderer.render(view, 1, kNMin);
    } catch (const core::Error&) {
      refused = true;
    }
  }).join();
  EXPECT_TRUE(refused);
}

/// Bit-identical on the same renderer; a GPU behind EGL may place edges otherwise.
TEST(BaseLayers, OsmesaAndEglDrawTheSame) {
  Scene scene = surroundings();
  scene.textures.push_back(
      makeTexture(2, 2, {{255, 0, 0, 255}, {0, 255, 0, 255}, {9, 9, 9, 255}, {200, 99, 0, 255}}, true));
  scene.materials[0].baseColorTexture.texture = 0;
  const core::IlluminationMaps maps = constantMaps({Vec3(2)});
  std::shared_ptr<FrameSnapshot> frames[2];
  std::string renderers[2];
  for (const int i : {0, 1}) {
    const auto context =
        render::makeHeadlessContext(i ? render::ContextKind::egl : render::ContextKind::osmesa);
    renderers[i] = context->renderer();
    render::BaseRenderer renderer(*context, scene);
    renderer.setMaps(&maps);
    frames[i] = renderer.render(View({}, 96, 64, scene.bounds), 1, kNMin);
  }
  if (renderers[0] == renderers[1]) {
    EXPECT_EQ(frames[0]->baseAndId, frames[1]->baseAndId);
    EXPECT_EQ(frames[0]->depth, frames[1]->depth);
    return;
  }
  int differing = 0;
  for (std::size_t i = 0; i < frames[0]->baseAndId.size(); ++i) {
    differing += glm::length(frames[0]->baseAndId[i] - frames[1]->baseAndId[i]) > 0.01f;
  }
  EXPECT_LT(differing, 96 * 64 / 50);
}

}  // namespace
}  // namespace saccade::tests
