// Frames made by rays, and a room, for the tests of the corrective tracer.
#pragma once

#include <cstdint>
#include <memory>

#include "core/corrective/messages.h"
#include "core/maps.h"
#include "raytrace/surface.h"
#include "raytrace/world.h"
#include "tests/unit/raytrace/test_scene.h"

namespace saccade::tests {

using namespace raytrace;

/// Window depth of a world point.
inline float windowDepth(const core::View& view, const Vec3& p) {
  const core::Vec4 clip = view.viewProjection() * core::Vec4(p, 1);
  return clip.z / clip.w;
}

/// What the base layer would have read back, made by rays through the pixel centres; base radiance is left 0.
inline std::shared_ptr<core::FrameSnapshot> frameOf(const World& world, const core::Camera& camera, int width,
                                                    int height) {
  auto frame = std::make_shared<core::FrameSnapshot>();
  frame->epoch = 7;
  frame->view = core::View(camera, width, height, world.scene().bounds);
  frame->baseAndId.assign(static_cast<std::size_t>(width) * height, core::Vec4(0));
  frame->depth.assign(static_cast<std::size_t>(width) * height, 0);
  RayCounters counters;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Vec2 pixel(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      const Ray ray{camera.eye, frame->view.direction(pixel), 0, core::kInfinity};
      Hit hit;
      if (!world.intersectVisible(ray, hit, counters)) continue;
      const std::size_t i = frame->index(x, y);
      frame->depth[i] = windowDepth(frame->view, camera.eye + hit.t * ray.direction);
      frame->baseAndId[i].w = static_cast<float>(world.scene().objects[world.record(hit.triangle).object].id);
    }
  }
  core::measureExtents(*frame, world.scene().idCount(), 10);
  return frame;
}

inline core::IlluminationMaps constantMaps(std::uint16_t half) {
  core::IlluminationMaps maps;
  maps.width = maps.height = 2;
  maps.layers = 1;
  maps.texels.assign(2 * 2 * 3, half);
  return maps;
}

inline core::Camera cameraAt(const Vec3& eye, const Vec3& at) {
  core::Camera c;
  c.eye = eye;
  c.at = at;
  return c;
}

/// A lamp, and a ball each of clear glass, rough metal, frosted glass and smooth plastic, in a box.
inline SceneMaker room() {
  SceneMaker m;
  m.box(m.material(tests::diffuseMaterial({0.6f, 0.5f, 0.4f})), 0, Vec3(-3), Vec3(3), true);
  m.quad(m.material(tests::diffuseMaterial(Vec3(0), Vec3(10))), 0, {-1, 2.9f, -1}, {2, 0, 0}, {0, 0, 2});
  m.sphere(m.material(tests::glassMaterial(1.5f, 0)), 1, {-1, 0, 0}, 0.8f, 16);
  m.sphere(m.material(tests::metalMaterial(Vec3(0.8f), 0.3f)), 2, {1, 0, 0}, 0.8f, 16);
  m.sphere(m.material(tests::glassMaterial(1.3f, 0.4f)), 3, {0, 1.2f, 0}, 0.6f, 16);
  core::Material plastic = tests::diffuseMaterial({0.2f, 0.4f, 0.8f});
  plastic.ior = 1.5f;
  plastic.roughness = 0;
  m.sphere(m.material(plastic), 4, {0, -1.2f, 0}, 0.6f, 16);
  return m;
}

inline constexpr std::uint16_t kHalfOne = 0x3c00, kHalfPi = 0x4248;  // 1 and 3.140625

}  // namespace saccade::tests
