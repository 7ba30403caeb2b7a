// One frame of a scene in each off-screen context, for the tests of the base layer.
#pragma once

#include <memory>
#include <random>
#include <vector>

#include "render/base/base_renderer.h"
#include "tests/unit/render/scene_fixture.h"

namespace saccade::tests {

inline constexpr int kNMin = 10;

class BaseLayer : public EachContext {
 protected:
  std::shared_ptr<core::FrameSnapshot> draw(const core::Scene& scene,
                                            const core::IlluminationMaps* maps = nullptr, int width = 32,
                                            int height = 32, const core::Camera& camera = {}) {
    render::BaseRenderer renderer(*context_, scene);
    renderer.setMaps(maps);
    auto frame = renderer.render(core::View(camera, width, height, scene.bounds), 1, kNMin);
    stats_ = renderer.lastDraw();
    return frame;
  }
  core::Vec4 center(const core::Scene& scene, const core::IlluminationMaps* maps = nullptr) {
    const auto frame = draw(scene, maps);
    return frame->baseAndId[frame->index(16, 16)];
  }
  render::DrawStats stats_;
};

/// Boxes all around the origin; a hierarchy of one level above the leaves.
inline core::Scene surroundings() {
  core::Scene scene;
  scene.materials.push_back(lambert(core::Vec3(0.5f)));
  scene.materials.push_back(lambert(core::Vec3(1, 0, 0)));
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-6, 6), size(0.2f, 1.5f);
  for (int i = 0; i < 120; ++i) {
    const core::Vec3 lo(place(random), place(random), place(random));
    addObject(scene, makeBox(lo, lo + core::Vec3(size(random), size(random), size(random)), i % 2,
                             static_cast<std::uint32_t>(i + 1)));
  }
  return scene;
}

}  // namespace saccade::tests
