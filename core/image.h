// Images in memory. Row 0 is the top row; pixel centres are at +0.5.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/math/types.h"

namespace saccade::core {

/// Width x height pixels of T, row-major, row 0 at the top.
template <class T>
class Image {
 public:
  Image() = default;
  Image(int width, int height, const T& fill = T{})
      : width_(width), height_(height), pixels_(static_cast<std::size_t>(width) * height, fill) {
    assert(width >= 0 && height >= 0);
  }
  int width() const { return width_; }
  int height() const { return height_; }
  bool empty() const { return pixels_.empty(); }
  T& at(int x, int y) { return pixels_[index(x, y)]; }
  const T& at(int x, int y) const { return pixels_[index(x, y)]; }
  std::vector<T>& pixels() { return pixels_; }
  const std::vector<T>& pixels() const { return pixels_; }

 private:
  std::size_t index(int x, int y) const {
    assert(x >= 0 && x < width_ && y >= 0 && y < height_);
    return static_cast<std::size_t>(y) * width_ + x;
  }
  int width_ = 0;
  int height_ = 0;
  std::vector<T> pixels_;
};

using ImageRgb = Image<Vec3>;    ///< linear radiance
using ImageGray = Image<float>;  ///< one value a pixel

struct Rgba8 {
  std::uint8_t r = 0, g = 0, b = 0, a = 255;
  bool operator==(const Rgba8&) const = default;
};
using ImageRgba8 = Image<Rgba8>;

}  // namespace saccade::core
