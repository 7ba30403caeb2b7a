// Frames made of an ID mask alone, for the tests of messages and queues.
#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "core/corrective/messages.h"

namespace saccade::tests {

/// `ids` row by row; every object must be in [0, idCount].
inline std::shared_ptr<core::FrameSnapshot> frameOf(int width, int height,
                                                    const std::vector<std::uint32_t>& ids,
                                                    std::uint32_t idCount, int nMin = 10,
                                                    std::uint64_t epoch = 1) {
  core::Bounds bounds;
  bounds.add(core::Vec3(-1, -1, -3));
  bounds.add(core::Vec3(1, 1, -1));
  auto frame = std::make_shared<core::FrameSnapshot>();
  frame->epoch = epoch;
  frame->view = core::View(core::Camera{}, width, height, bounds);
  for (std::uint32_t id : ids) frame->baseAndId.emplace_back(0, 0, 0, static_cast<float>(id));
  frame->depth.assign(ids.size(), 0.5f);
  core::measureExtents(*frame, idCount, nMin);
  return frame;
}

/// Overlapping discs of all ids over a speckle of single pixels.
inline std::vector<std::uint32_t> randomMask(int width, int height, std::uint32_t idCount,
                                             std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  std::vector<std::uint32_t> ids(static_cast<std::size_t>(width) * height, 0);
  for (std::uint32_t disc = 0; disc < idCount; ++disc) {
    const int cx = below(width), cy = below(height), radius = 1 + below(1 + (width + height) / 8);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        if ((x - cx) * (x - cx) + (y - cy) * (y - cy) < radius * radius) {
          ids[static_cast<std::size_t>(y) * width + x] = 1 + disc;
        }
      }
    }
  }
  for (auto& id : ids) {
    if (below(50) == 0) id = random() % (idCount + 1);
  }
  return ids;
}

}  // namespace saccade::tests
