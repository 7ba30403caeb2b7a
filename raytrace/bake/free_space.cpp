#include "raytrace/bake/free_space.h"

#include <algorithm>
#include <utility>

namespace saccade::raytrace {

void FreeSpace::countAll() {
  for (int y = 0; y < size_; ++y) countRow(y);
}

void FreeSpace::countRow(int y) {
  for (int x = size_ - 1; x >= 0; --x) {
    const std::int32_t step = taken_[at(x, y)] ? -1 : 1;
    const std::int32_t next = x + 1 < size_ ? run_[at(x + 1, y)] : 0;
    run_[at(x, y)] = (next > 0) == (step > 0) ? next + step : step;
  }
}

void FreeSpace::take(int x0, int y0, int x1, int y1) {
  for (int y = std::max(y0, 0); y < std::min(y1, size_); ++y) {
    for (int x = std::max(x0, 0); x < std::min(x1, size_); ++x) taken_[at(x, y)] = 1;
    countRow(y);
  }
}

bool FreeSpace::place(int width, int height, int& x, int& y) {
  for (y = 0; y + height <= size_; ++y) {
    for (x = 0; x + width <= size_;) {
      int row = y;
      while (row < y + height && run_[at(x, row)] >= width) ++row;
      if (row == y + height) {
        take(x, y, x + width, y + height);
        return true;
      }
      x += std::abs(run_[at(x, row)]);
    }
  }
  return false;
}

void FreeSpace::grow(int size) {
  const std::vector<char> before = std::exchange(taken_, {});
  const int old = std::exchange(size_, size);
  taken_.assign(cells(), 0);
  run_.assign(cells(), 0);
  for (int y = 0; y < old; ++y) {
    std::copy_n(before.begin() + static_cast<std::ptrdiff_t>(y) * old, old,
                taken_.begin() + static_cast<std::ptrdiff_t>(at(0, y)));
  }
  countAll();
}

}  // namespace saccade::raytrace
