// Pictures and frames for the tests of the attention room.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/corrective/messages.h"
#include "core/image.h"

namespace saccade::tests {

inline core::Rgba8 rgb(int r, int g, int b) {
  return {static_cast<std::uint8_t>(r), static_cast<std::uint8_t>(g), static_cast<std::uint8_t>(b), 255};
}

/// Centre and radius in pixels.
struct Disc {
  double x, y, radius;
};

inline void paint(core::ImageRgba8& image, const Disc& disc, core::Rgba8 colour) {
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (std::hypot(x + 0.5 - disc.x, y + 0.5 - disc.y) <= disc.radius) image.at(x, y) = colour;
    }
  }
}

struct Place {
  int x = 0, y = 0;
  float value = -1;
};

inline Place brightestPlace(const core::ImageGray& map) {
  Place best;
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      if (map.at(x, y) > best.value) best = {x, y, map.at(x, y)};
    }
  }
  return best;
}

/// Discs of random place, size and colour over a random ground; the same for the same seed.
inline core::ImageRgba8 randomDiscs(int width, int height, int count, std::uint32_t seed) {
  const auto next = [&seed](int below) {
    seed = seed * 1664525u + 1013904223u;
    return static_cast<int>((seed >> 16) % static_cast<std::uint32_t>(below));
  };
  core::ImageRgba8 image(width, height, rgb(next(256), next(256), next(256)));
  for (int i = 0; i < count; ++i) {
    const Disc disc{static_cast<double>(next(width)), static_cast<double>(next(height)),
                    2.0 + next(1 + std::min(width, height) / 8)};
    paint(image, disc, rgb(next(256), next(256), next(256)));
  }
  return image;
}

/// Box of an object that fills it.
struct ObjectBox {
  std::uint32_t id;
  core::PixelBox box;
};

inline std::shared_ptr<core::FrameSnapshot> makeFrame(int width, int height,
                                                      const std::vector<ObjectBox>& objects,
                                                      std::uint32_t idCount, std::uint64_t epoch = 1) {
  auto frame = std::make_shared<core::FrameSnapshot>();
  core::Bounds bounds;
  bounds.add(core::Vec3(-1));
  bounds.add(core::Vec3(1));
  core::Camera camera;
  camera.eye = {0, 0, 3};
  camera.at = {0, 0, 0};
  frame->epoch = epoch;
  frame->view = core::View(camera, width, height, bounds);
  frame->baseAndId.assign(static_cast<std::size_t>(width) * height, core::Vec4(0));
  frame->depth.assign(frame->baseAndId.size(), 0.5f);
  for (const auto& [id, box] : objects) {
    for (int y = box.y0; y < box.y1; ++y) {
      for (int x = box.x0; x < box.x1; ++x) frame->baseAndId[frame->index(x, y)].w = static_cast<float>(id);
    }
  }
  core::measureExtents(*frame, idCount, 10);
  return frame;
}

}  // namespace saccade::tests
