// Free places for rectangles in an atlas of which parts are taken.
#pragma once

#include <cstdint>
#include <vector>

namespace saccade::raytrace {

/// One thread.
class FreeSpace {
 public:
  explicit FreeSpace(int size) : size_(size), taken_(cells(), 0), run_(cells()) { countAll(); }

  int size() const { return size_; }
  /// Texels [x0, x1) x [y0, y1), cut to the atlas.
  void take(int x0, int y0, int x1, int y1);
  /// The first place from the top left that is free, and takes it; false when there is none.
  bool place(int width, int height, int& x, int& y);
  /// What is taken stays; the new texels at the right and below are free.
  void grow(int size);

 private:
  std::size_t cells() const { return static_cast<std::size_t>(size_) * static_cast<std::size_t>(size_); }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_) + static_cast<std::size_t>(x);
  }
  void countAll();
  void countRow(int y);

  int size_;
  std::vector<char> taken_;
  std::vector<std::int32_t> run_;  ///< from here to the right: so many are free, or (negative) taken
};

}  // namespace saccade::raytrace
