#include "core/metrics/separable.h"

#include <algorithm>
#include <cassert>

namespace saccade::core {
namespace {

/// out[i] = sum over k of weights[k] * in[i + k]; tap by tap, so that the inner loop runs in vector
/// registers.
void addTaps(const float* in, float* out, std::size_t count, float weight) {
  for (std::size_t i = 0; i < count; ++i) out[i] += weight * in[i];
}

}  // namespace

ImageGray filterSeparable(const ImageGray& image, std::span<const float> alongX,
                          std::span<const float> alongY) {
  assert(alongX.size() % 2 == 1 && alongY.size() % 2 == 1);
  const int width = image.width(), height = image.height();
  const auto columns = static_cast<std::size_t>(width);
  ImageGray rows(width, height), out(width, height);
  if (image.empty()) return out;
  const std::size_t radius = alongX.size() / 2;
  std::vector<float> padded(columns + 2 * radius);
  for (int y = 0; y < height; ++y) {
    const float* row = &image.at(0, y);
    std::fill_n(padded.begin(), radius, row[0]);
    std::copy_n(row, columns, padded.begin() + static_cast<std::ptrdiff_t>(radius));
    std::fill(padded.end() - static_cast<std::ptrdiff_t>(radius), padded.end(), row[columns - 1]);
    for (std::size_t k = 0; k < alongX.size(); ++k) addTaps(&padded[k], &rows.at(0, y), columns, alongX[k]);
  }
  const int reach = static_cast<int>(alongY.size() / 2);
  for (int y = 0; y < height; ++y) {
    for (int k = -reach; k <= reach; ++k) {
      addTaps(&rows.at(0, std::clamp(y + k, 0, height - 1)), &out.at(0, y), columns, alongY[k + reach]);
    }
  }
  return out;
}

}  // namespace saccade::core
