// Frames and samples for the tests of render/splat, made without OpenGL.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "core/corrective/messages.h"

namespace saccade::render::testing {

/// What a pixel's ray meets: view depth (metres along the line of sight) and id.
struct Surface {
  float viewDepth = 1;
  std::uint32_t id = 0;
};

inline core::Bounds unitScene() {
  core::Bounds bounds;
  bounds.add(core::Vec3(-10));
  bounds.add(core::Vec3(10));
  return bounds;
}

/// 64 x 64 pixels.
inline core::View viewFrom(const core::Vec3& eye, const core::Vec3& at = core::Vec3(0)) {
  core::Camera camera;
  camera.eye = eye;
  camera.at = at;
  camera.up = core::Vec3(0.01f, 0.3f, 1);
  return core::View(camera, 64, 64, unitScene());
}

/// A frame whose pixel (x, y) shows what `at(view, x, y)` says.
inline std::shared_ptr<core::FrameSnapshot> makeFrame(
    const core::View& view, const std::function<Surface(const core::View&, int, int)>& at) {
  auto frame = std::make_shared<core::FrameSnapshot>();
  frame->view = view;
  const double n = view.zNear(), f = view.zFar();
  for (int y = 0; y < view.height(); ++y) {
    for (int x = 0; x < view.width(); ++x) {
      const Surface s = at(view, x, y);
      frame->baseAndId.emplace_back(0.5f, 0.25f, 0.125f, static_cast<float>(s.id));
      frame->ids.push_back(static_cast<float>(s.id));
      frame->depth.push_back(static_cast<float>((1 / s.viewDepth - 1 / f) / (1 / n - 1 / f)));
      if (s.id != 0) ++frame->nonDiffusePixels;
    }
  }
  return frame;
}

/// A frame of given mask at depth 1.
inline std::shared_ptr<core::FrameSnapshot> maskFrame(int width, int height,
                                                      const std::function<std::uint32_t(int, int)>& id) {
  return makeFrame(core::View(core::Camera{}, width, height, unitScene()),
                   [&](const core::View&, int x, int y) {
                     return Surface{1, id(x, y)};
                   });
}

/// View depth at which a pixel's ray meets the plane <n, p> = d.
inline float planeDepth(const core::View& view, int x, int y, const core::Vec3& n, float d) {
  const core::Vec3 ray = view.direction({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
  return (d - glm::dot(n, view.camera().eye)) / glm::dot(n, ray);
}

/// The sample a tracer would make of a pixel; its correction is a function of the pixel alone.
inline core::Sample sampleAt(const core::FrameSnapshot& frame, int x, int y, int level,
                             const core::Vec3& normal = {0, 0, 1}) {
  core::Sample s;
  s.x = x, s.y = y;
  s.id = frame.idAt(x, y);
  s.level = static_cast<std::uint8_t>(level);
  s.thread = static_cast<std::uint8_t>((x + y) % 3);
  s.correction = {0.001f * static_cast<float>(x), -0.002f * static_cast<float>(y),
                  0.1f * static_cast<float>(level)};
  s.viewDepth = frame.view.viewDepth(frame.depth[frame.index(x, y)]);
  s.position = frame.view.unproject({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f},
                                    frame.depth[frame.index(x, y)]);
  s.normal = normal;
  s.cosView = glm::dot(normal, glm::normalize(frame.view.camera().eye - s.position));
  return s;
}

/// Every pixel of the mask whose lattice level is at most `finest`, each at its own level.
inline std::vector<core::Sample> latticeSamples(const core::FrameSnapshot& frame, int finest,
                                                const core::Vec3& normal = {0, 0, 1}) {
  std::vector<core::Sample> samples;
  for (int y = 0; y < frame.view.height(); ++y) {
    for (int x = 0; x < frame.view.width(); ++x) {
      const int level = core::Lattice::levelOf(x, y);
      if (frame.idAt(x, y) != 0 && level <= finest) samples.push_back(sampleAt(frame, x, y, level, normal));
    }
  }
  return samples;
}

}  // namespace saccade::render::testing
