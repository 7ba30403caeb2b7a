// The environment behind the base layer, against the tracers' look-up.
#include <random>

#include "core/scene/environment.h"
#include "render/base/base_renderer.h"
#include "scene_fixture.h"

namespace saccade::tests {
namespace {

using core::Vec2;
using core::Vec3;

class Background : public EachContext {};
SACCADE_EACH_CONTEXT(Background);

std::shared_ptr<const core::Environment> noise(int width, int height, float degrees) {
  core::Environment e;
  e.radiance = core::ImageRgb(width, height);
  e.rotation = glm::radians(degrees);
  std::mt19937 random(8);
  std::uniform_real_distribution<float> u(0, 1);
  for (Vec3& p : e.radiance.pixels()) p = Vec3(u(random), u(random), u(random));
  return std::make_shared<const core::Environment>(std::move(e));
}

TEST_P(Background, EqualsTheTracersLookUpInEveryDirection) {
  core::Scene scene = oneQuad(lambert(Vec3(0.5f)), 7);
  scene.environment = noise(256, 128, 33);
  render::BaseRenderer renderer(*context_, scene);
  constexpr int kWidth = 96, kHeight = 64;
  // Level, straight up, straight down, and across the seam behind (turned by the environment's rotation).
  for (const Vec3& at : {Vec3(0, 0, -1), Vec3(0.01f, 1, 0), Vec3(0, -1, 0.02f), Vec3(0.5f, 0.1f, 1)}) {
    core::Camera camera;
    camera.eye = {0, 0, 3};
    camera.at = camera.eye + at;
    camera.fovYDegrees = 100;
    const core::View view(camera, kWidth, kHeight, scene.bounds);
    const auto frame = renderer.render(view, 1, 10);
    int background = 0;
    float largest = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        if (frame->depth[frame->index(x, y)] != 0.0f) continue;
        ++background;
        EXPECT_EQ(frame->idAt(x, y), 0u);
        const Vec3 truth = core::environmentRadiance(
            *scene.environment, view.direction({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}));
        const Vec3 difference = glm::abs(Vec3(frame->baseAndId[frame->index(x, y)]) - truth);
        largest = std::max({largest, difference.x, difference.y, difference.z});
      }
    }
    EXPECT_GT(background, kWidth * kHeight / 2);
    // Of neighbouring texels that differ by up to 1. Graphics cards weigh them with 8 bits.
    const bool software = context_->renderer().find("llvmpipe") != std::string::npos;
    EXPECT_LT(largest, software ? 2e-4f : 1.0f / 128);
  }
}

TEST_P(Background, LeavesWhatIsDrawnAlone) {
  core::Scene scene = oneQuad(lambert(Vec3(0.5f)), 7);
  const core::View view({}, 32, 32, scene.bounds);
  const auto black = render::BaseRenderer(*context_, scene).render(view, 1, 10);
  scene.environment = noise(8, 4, 0);
  render::BaseRenderer renderer(*context_, scene);
  for (int repeat = 0; repeat < 2; ++repeat) {  // its GL state does not leak into the next frame
    const auto lit = renderer.render(view, 1, 10);
    EXPECT_EQ(lit->depth, black->depth);
    for (std::size_t i = 0; i < lit->depth.size(); ++i) {
      if (lit->depth[i] > 0) {
        EXPECT_EQ(lit->baseAndId[i], black->baseAndId[i]);
      } else {
        EXPECT_EQ(black->baseAndId[i], core::Vec4(0));
        EXPECT_GT(lit->baseAndId[i].x, 0);
      }
    }
  }
}

TEST_P(Background, AnEnvironmentWiderThanTheContextTakesIsAveraged) {
  core::Scene scene = oneQuad(lambert(Vec3(0.5f)));
  core::Environment e;
  e.radiance = core::ImageRgb(context_->maxSize() + 2, 1, Vec3(3));
  scene.environment = std::make_shared<const core::Environment>(std::move(e));
  const core::View view({}, 32, 32, scene.bounds);
  const auto frame = render::BaseRenderer(*context_, scene).render(view, 1, 10);
  EXPECT_NEAR(frame->baseAndId[0].x, 3, 1e-5);
}

}  // namespace
}  // namespace saccade::tests
