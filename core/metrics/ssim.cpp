#include "core/metrics/ssim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "core/metrics/separable.h"

namespace saccade::core {
namespace {

constexpr int kRadius = 5;
constexpr double kSigma = 1.5;
constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;

ImageGray lumaOf(const ImageRgba8& image) {
  ImageGray luma(image.width(), image.height());
  std::transform(image.pixels().begin(), image.pixels().end(), luma.pixels().begin(),
                 [](const Rgba8& p) { return luminance(Vec3(p.r, p.g, p.b)) / 255.0f; });
  return luma;
}

ImageGray product(const ImageGray& a, const ImageGray& b) {
  ImageGray out(a.width(), a.height());
  std::transform(a.pixels().begin(), a.pixels().end(), b.pixels().begin(), out.pixels().begin(),
                 std::multiplies<>());
  return out;
}

ImageGray window(const ImageGray& image) {
  std::array<float, 2 * kRadius + 1> weights{};
  double sum = 0;
  for (int i = -kRadius; i <= kRadius; ++i) sum += std::exp(-i * i / (2 * kSigma * kSigma));
  for (int i = -kRadius; i <= kRadius; ++i) {
    weights[i + kRadius] = static_cast<float>(std::exp(-i * i / (2 * kSigma * kSigma)) / sum);
  }
  return filterSeparable(image, weights, weights);
}

}  // namespace

double ssim(const ImageRgba8& reference, const ImageRgba8& test) {
  const ImageGray a = lumaOf(reference), b = lumaOf(test);
  const ImageGray meanA = window(a), meanB = window(b);
  const ImageGray meanAA = window(product(a, a)), meanBB = window(product(b, b)),
                  meanAB = window(product(a, b));
  const bool fits = a.width() > 2 * kRadius && a.height() > 2 * kRadius;
  const int margin = fits ? kRadius : 0;
  double sum = 0;
  for (int y = margin; y < a.height() - margin; ++y) {
    for (int x = margin; x < a.width() - margin; ++x) {
      const double ma = meanA.at(x, y), mb = meanB.at(x, y);
      const double varA = meanAA.at(x, y) - ma * ma, varB = meanBB.at(x, y) - mb * mb;
      const double covariance = meanAB.at(x, y) - ma * mb;
      sum += (2 * ma * mb + kC1) * (2 * covariance + kC2) / ((ma * ma + mb * mb + kC1) * (varA + varB + kC2));
    }
  }
  return sum / (static_cast<double>(a.width() - 2 * margin) * (a.height() - 2 * margin));
}

}  // namespace saccade::core
