// Work on the GL thread in portions of a few milliseconds, so that a window can show frames between them.
#pragma once

#include <algorithm>
#include <chrono>
#include <deque>
#include <functional>
#include <utility>

namespace saccade::render {

/// GL thread only.
class Portions {
 public:
  /// After all that was added before.
  void add(std::function<void()> portion) { left_.push_back(std::move(portion)); }

  /// Does one, and goes on until the time is up. Returns whether all are done. What a portion throws leaves
  /// those that follow undone.
  bool goOn(std::chrono::steady_clock::time_point until) {
    while (!left_.empty()) {
      const std::function<void()> portion = std::move(left_.front());
      left_.pop_front();
      portion();
      if (std::chrono::steady_clock::now() >= until) break;
    }
    return left_.empty();
  }
  void finish() { goOn(std::chrono::steady_clock::time_point::max()); }

 private:
  std::deque<std::function<void()>> left_;
};

/// Calls add(firstRow, rows) for the parts of an image that are copied in about a millisecond.
template <class Add>
void rowsInPortions(int width, int height, Add&& add) {
  constexpr int kTexels = 1 << 18;
  const int most = std::max(1, kTexels / width);
  for (int row = 0; row < height; row += most) add(row, std::min(most, height - row));
}

}  // namespace saccade::render
