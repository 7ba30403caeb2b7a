#include "attention/importance.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/math/random.h"

namespace saccade::attention {
namespace {

using core::FrameSnapshot;
using core::ObjectExtent;

// Everything visible is corrected in the end, so no priority is 0.
constexpr float kLeastPriority = 1e-3f;

double pixelCount(const FrameSnapshot& frame) {
  return static_cast<double>(frame.view.width()) * frame.view.height();
}

float taskOf(const FrameSnapshot& frame, const ObjectExtent& extent) {
  const double halfWidth = 0.5 * frame.view.width(), halfHeight = 0.5 * frame.view.height();
  const double dx = 0.5 * (extent.box.x0 + extent.box.x1) - halfWidth;
  const double dy = 0.5 * (extent.box.y0 + extent.box.y1) - halfHeight;
  const double proximity = 1 - std::hypot(dx, dy) / std::hypot(halfWidth, halfHeight);
  return static_cast<float>(0.5 * (proximity + std::sqrt(extent.pixels / pixelCount(frame))));
}

// (0, 1], all 2^24 values of it exact floats.
float randomPriority(std::uint32_t id, std::uint32_t seed) {
  constexpr std::uint32_t kSalt = 0x6f726465;  // keeps this apart from the tracers' use of the same hash
  return static_cast<float>((core::hashKey(id, seed, kSalt, 0) >> 8) + 1) * 0x1p-24f;
}

float scanlinePriority(const FrameSnapshot& frame, const ObjectExtent& extent) {
  const double place = static_cast<double>(extent.box.y0) * frame.view.width() + extent.box.x0;
  return static_cast<float>(1 - place / pixelCount(frame));
}

float attentionPriority(float saliency, float task, float weight) {
  return std::clamp((1 - weight) * saliency + weight * task, kLeastPriority, 1.0f);
}

}  // namespace

std::vector<float> objectSaliency(const FrameSnapshot& frame, const core::ImageGray& saliency) {
  if (saliency.width() != frame.view.width() || saliency.height() != frame.view.height()) {
    throw core::Error("attention: picture and ID mask differ in size (" + std::to_string(saliency.width()) +
                      " x " + std::to_string(saliency.height()) + ", " + std::to_string(frame.view.width()) +
                      " x " + std::to_string(frame.view.height()) + ")");
  }
  std::vector<double> sums(frame.extents.size(), 0.0);
  for (std::size_t i = 0; i < frame.ids.size(); ++i) {
    const auto id = static_cast<std::uint32_t>(frame.ids[i]);
    if (id == 0) continue;
    if (id >= sums.size()) {
      throw core::Error("attention: the ID mask names object " + std::to_string(id) +
                        ", the frame has extents up to " + std::to_string(sums.size()) +
                        "; measure the extents of every frame");
    }
    sums[id] += saliency.pixels()[i];
  }
  std::vector<float> means(sums.size(), 0.0f);
  for (std::size_t id = 1; id < sums.size(); ++id) {
    if (frame.extents[id].pixels > 0) means[id] = static_cast<float>(sums[id] / frame.extents[id].pixels);
  }
  return means;
}

std::vector<float> taskImportance(const FrameSnapshot& frame) {
  std::vector<float> task(frame.extents.size(), 0.0f);
  for (std::size_t id = 1; id < task.size(); ++id) {
    if (frame.extents[id].pixels > 0) task[id] = taskOf(frame, frame.extents[id]);
  }
  return task;
}

Importance importanceOf(const FrameSnapshot& frame, const core::ImageGray& saliency,
                        const AttentionOptions& options, std::vector<float> attended) {
  assert(attended.empty() || attended.size() == frame.extents.size());
  Importance out;
  out.attended = std::move(attended);
  if (needsSaliency(options.order)) out.saliency = objectSaliency(frame, saliency);
  out.task = taskImportance(frame);
  out.priority.assign(frame.extents.size(), 0.0f);
  for (std::uint32_t id = 1; id < out.priority.size(); ++id) {
    const ObjectExtent& extent = frame.extents[id];
    if (extent.pixels == 0) continue;
    switch (options.order) {
      case Order::attention:
      case Order::importance:
        out.priority[id] = attentionPriority(out.saliency[id], out.task[id], options.attention);
        break;
      case Order::gain:
        out.priority[id] = 1;
        break;
      case Order::task:
        out.priority[id] = out.task[id];
        break;
      case Order::random:
        out.priority[id] = randomPriority(id, options.seed);
        break;
      case Order::scanline:
        out.priority[id] = scanlinePriority(frame, extent);
        break;
      case Order::largest:
        out.priority[id] = static_cast<float>(extent.pixels / pixelCount(frame));
        break;
    }
    if (!out.attended.empty()) out.priority[id] += out.attended[id];
  }
  return out;
}

}  // namespace saccade::attention
