#include "bench/cache/bare_warp.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace saccade::bench {

void BareWarp::add(const core::Sample& s) {
  x_.push_back(s.position.x), y_.push_back(s.position.y), z_.push_back(s.position.z);
  id_.push_back(static_cast<float>(s.id));
  correction_.push_back(s.correction);
}

std::size_t BareWarp::warp(const core::FrameSnapshot& frame) {
  constexpr std::size_t kTogether = 256;
  constexpr float kTolerance = 0.01f;  // of the view depth
  const core::View& view = frame.view;
  image_.assign(frame.ids.size(), core::Vec4(0));
  const auto width = static_cast<float>(view.width()), height = static_cast<float>(view.height());
  const float inverseNear = 1 / view.zNear(), inverseFar = 1 / view.zFar();
  std::array<float, kTogether> px, py, depth;
  std::size_t written = 0;
  for (std::size_t from = 0; from < x_.size(); from += kTogether) {
    const std::size_t n = std::min(kTogether, x_.size() - from);
    view.project(&x_[from], &y_[from], &z_[from], n, px.data(), py.data(), depth.data());
    for (std::size_t i = 0; i < n; ++i) {
      if (!(depth[i] >= view.zNear() && px[i] >= 0 && py[i] >= 0 && px[i] < width && py[i] < height))
        continue;
      const std::size_t pixel = frame.index(static_cast<int>(px[i]), static_cast<int>(py[i]));
      const float w = frame.depth[pixel] * inverseNear + (1 - frame.depth[pixel]) * inverseFar;
      if (frame.ids[pixel] != id_[from + i] || std::abs(depth[i] * w - 1) > kTolerance) continue;
      image_[pixel] = core::Vec4(correction_[from + i], 1);
      ++written;
    }
  }
  return written;
}

}  // namespace saccade::bench
