#include "attention/separable.h"

#include <algorithm>
#include <cmath>

namespace saccade::attention {
namespace {

using core::ImageGray;

/// Index of the sample that a mirror at each border shows at i.
int mirrored(int i, int count) {
  const int period = 2 * count;
  const int j = (i % period + period) % period;
  return j < count ? j : period - 1 - j;
}

void addScaled(const float* in, float scale, int count, float* out) {
  for (int x = 0; x < count; ++x) out[x] += scale * in[x];
}

}  // namespace

void filterAlongX(const ImageGray& in, std::span<const float> taps, ImageGray& out,
                  std::vector<float>& padded) {
  assert(in.width() == out.width() && in.height() == out.height() && taps.size() % 2 == 1);
  const int radius = static_cast<int>(taps.size()) / 2, width = in.width();
  padded.resize(std::max(padded.size(), static_cast<std::size_t>(width) + 2 * radius));
  for (int y = 0; y < in.height(); ++y) {
    const float* row = &in.at(0, y);
    std::copy(row, row + width, padded.begin() + radius);
    for (int i = 1; i <= radius; ++i) {
      padded[radius - i] = row[mirrored(-i, width)];
      padded[radius + width - 1 + i] = row[mirrored(width - 1 + i, width)];
    }
    float* sum = &out.at(0, y);
    std::fill(sum, sum + width, 0.0f);
    for (std::size_t t = 0; t < taps.size(); ++t) addScaled(padded.data() + t, taps[t], width, sum);
  }
}

void filterAlongY(const ImageGray& in, std::span<const float> taps, ImageGray& out) {
  assert(in.width() == out.width() && in.height() == out.height() && taps.size() % 2 == 1);
  const int radius = static_cast<int>(taps.size()) / 2;
  for (int y = 0; y < in.height(); ++y) {
    float* sum = &out.at(0, y);
    std::fill(sum, sum + in.width(), 0.0f);
    for (std::size_t t = 0; t < taps.size(); ++t) {
      const int row = mirrored(y + static_cast<int>(t) - radius, in.height());
      addScaled(&in.at(0, row), taps[t], in.width(), sum);
    }
  }
}

std::vector<float> gaussianTaps(double sigma, int radius) {
  assert(sigma > 0 && radius >= 0);
  std::vector<double> taps(2 * static_cast<std::size_t>(radius) + 1);
  double sum = 0;
  for (int i = -radius; i <= radius; ++i) sum += taps[i + radius] = std::exp(-0.5 * i * i / (sigma * sigma));
  std::vector<float> result;
  result.reserve(taps.size());
  for (const double tap : taps) result.push_back(static_cast<float>(tap / sum));
  return result;
}

}  // namespace saccade::attention
