#include "core/metrics/comparison.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/image_io.h"
#include "core/metrics/flip.h"
#include "core/metrics/ssim.h"

namespace saccade::core {
namespace {

template <class T>
void checkSizes(const Image<T>& reference, const Image<T>& test) {
  const auto size = [](const Image<T>& i) {
    return std::to_string(i.width()) + " x " + std::to_string(i.height());
  };
  if (reference.width() != test.width() || reference.height() != test.height()) {
    throw Error("images differ in size: reference " + size(reference) + ", test " + size(test));
  }
  if (reference.empty()) throw Error("images without pixels cannot be compared");
}

void checkFinite(const ImageRgb& image, const char* which) {
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const Vec3& p = image.at(x, y);
      if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
      throw Error(std::string(which) + " image: pixel (" + std::to_string(x) + ", " + std::to_string(y) +
                  ") is not finite");
    }
  }
}

/// Sums in double precision: 10^8 float terms would lose the small ones.
void fillErrors(Comparison& c, const ImageRgb& reference, const ImageRgb& test) {
  double squares = 0, relative = 0;
  for (std::size_t i = 0; i < reference.pixels().size(); ++i) {
    for (int channel = 0; channel < 3; ++channel) {
      const double truth = reference.pixels()[i][channel];
      const double difference = test.pixels()[i][channel] - truth;
      squares += difference * difference;
      relative += difference * difference / (truth * truth + kRelativeEpsilon);
      c.maxAbs = std::max(c.maxAbs, std::abs(difference));
    }
  }
  const double count = 3 * static_cast<double>(reference.pixels().size());
  c.rmse = std::sqrt(squares / count);
  c.relmse = relative / count;
  c.psnr = -20 * std::log10(c.rmse);
}

void fillPerceived(Comparison& c, const ImageRgba8& reference, const ImageRgba8& test) {
  c.ssim = ssim(reference, test);
  c.flipMap = flip(reference, test);
  c.flip = meanOf(c.flipMap);
  c.flipMedian = weightedPercentile(c.flipMap, 0.5);
  c.flipP95 = weightedPercentile(c.flipMap, 0.95);
}

ImageRgb asFractions(const ImageRgba8& image) {
  ImageRgb values(image.width(), image.height());
  std::transform(image.pixels().begin(), image.pixels().end(), values.pixels().begin(),
                 [](const Rgba8& p) { return Vec3(p.r, p.g, p.b) / 255.0f; });
  return values;
}

/// The part of a comparison that needs no eye.
Comparison linearErrors(const ImageRgb& reference, const ImageRgb& test) {
  checkSizes(reference, test);
  checkFinite(reference, "reference");
  checkFinite(test, "test");
  Comparison c;
  fillErrors(c, reference, test);
  return c;
}

}  // namespace

double relativeMse(const ImageRgb& reference, const ImageRgb& test) {
  return linearErrors(reference, test).relmse;
}

Comparison compareLinear(const ImageRgb& reference, const ImageRgb& test) {
  Comparison c = linearErrors(reference, test);
  fillPerceived(c, toDisplay(reference, 0), toDisplay(test, 0));
  return c;
}

Comparison compareDisplay(const ImageRgba8& reference, const ImageRgba8& test) {
  checkSizes(reference, test);
  Comparison c;
  fillErrors(c, asFractions(reference), asFractions(test));
  fillPerceived(c, reference, test);
  return c;
}

}  // namespace saccade::core
