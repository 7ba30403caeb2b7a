#include "attention/orientation.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include "attention/separable.h"

namespace saccade::attention {
namespace {

using core::ImageGray;

constexpr double kPeriod = 7;  // samples
constexpr double kSigma = kPeriod / 3;
constexpr int kRadius = 4;
// The Gaussian halves a grating's amplitude in either phase's product, and from -1 to 1 there are 2.
constexpr float kGain = 4;

template <class Wave>
std::vector<float> times(const std::vector<float>& gauss, Wave&& wave) {
  std::vector<float> taps;
  for (int i = -kRadius; i <= kRadius; ++i)
    taps.push_back(gauss[i + kRadius] * static_cast<float>(wave(2 * std::numbers::pi / kPeriod * i)));
  return taps;
}

float sumOf(const std::vector<float>& taps) { return std::accumulate(taps.begin(), taps.end(), 0.0f); }

void toEnergy(const ImageGray& even, const ImageGray& odd, ImageGray& out) {
  for (std::size_t i = 0; i < out.pixels().size(); ++i) {
    const float e = even.pixels()[i], o = odd.pixels()[i];
    out.pixels()[i] = kGain * std::sqrt(e * e + o * o);
  }
}

}  // namespace

OrientationPyramid::OrientationPyramid() {
  taps_.gauss = gaussianTaps(kSigma, kRadius);
  taps_.sine = times(taps_.gauss, [](double phase) { return std::sin(phase); });
  const float mean = sumOf(times(taps_.gauss, [](double phase) { return std::cos(phase); }));
  taps_.flatCosine = times(taps_.gauss, [mean](double phase) { return std::cos(phase) - mean; });
  taps_.diagonalCosine =
      times(taps_.gauss, [](double phase) { return std::cos(phase / std::numbers::sqrt2); });
  taps_.diagonalSine = times(taps_.gauss, [](double phase) { return std::sin(phase / std::numbers::sqrt2); });
  taps_.diagonalMean = sumOf(taps_.diagonalCosine) * sumOf(taps_.diagonalCosine);  // the sines' is 0
}

void OrientationPyramid::resize(const std::vector<LevelGeometry>& levels, int firstLevel) {
  firstLevel_ = firstLevel;
  planes_.assign(levels.size(), {});
  scratch_.assign(levels.size(), {});
  for (std::size_t l = firstLevel; l < levels.size(); ++l) {
    const ImageGray blank(levels[l].width, levels[l].height);
    planes_[l].fill(blank);
    scratch_[l] = {blank, blank, blank, blank, blank, blank, blank, blank, blank, blank};
  }
}

void OrientationPyramid::build(const OpponentPyramid& pyramid) {
  for (std::size_t l = firstLevel_; l < planes_.size(); ++l) {
    const ImageGray& intensity = pyramid.plane(static_cast<int>(l), kIntensity);
    Scratch& s = scratch_[l];
    filterAlongX(intensity, taps_.gauss, s.gauss, padded_);
    filterAlongX(intensity, taps_.flatCosine, s.flatCosine, padded_);
    filterAlongX(intensity, taps_.sine, s.sine, padded_);
    filterAlongX(intensity, taps_.diagonalCosine, s.diagonalCosine, padded_);
    filterAlongX(intensity, taps_.diagonalSine, s.diagonalSine, padded_);
    addUpright(s, planes_[l]);
    addDiagonals(s, planes_[l]);
  }
}

void OrientationPyramid::addUpright(Scratch& s, Planes& out) {
  filterAlongY(s.flatCosine, taps_.gauss, s.even);
  filterAlongY(s.sine, taps_.gauss, s.odd);
  toEnergy(s.even, s.odd, out[k0Degrees]);
  filterAlongY(s.gauss, taps_.flatCosine, s.even);
  filterAlongY(s.gauss, taps_.sine, s.odd);
  toEnergy(s.even, s.odd, out[k90Degrees]);
}

// cos(x + y) = cos x cos y - sin x sin y, sin(x + y) = sin x cos y + cos x sin y, and with -y the other
// diagonal's. y points down: x + y grows along 135 degrees.
void OrientationPyramid::addDiagonals(Scratch& s, Planes& out) {
  filterAlongY(s.diagonalCosine, taps_.diagonalCosine, s.cosines);
  filterAlongY(s.diagonalSine, taps_.diagonalSine, s.sines);
  filterAlongY(s.gauss, taps_.gauss, s.mean);
  filterAlongY(s.diagonalSine, taps_.diagonalCosine, s.even);
  filterAlongY(s.diagonalCosine, taps_.diagonalSine, s.odd);
  for (std::size_t i = 0; i < s.mean.pixels().size(); ++i) {
    const float flat = s.cosines.pixels()[i] - taps_.diagonalMean * s.mean.pixels()[i];
    const float sines = s.sines.pixels()[i], sc = s.even.pixels()[i], cs = s.odd.pixels()[i];
    s.cosines.pixels()[i] = flat + sines;
    s.sines.pixels()[i] = flat - sines;
    s.even.pixels()[i] = sc - cs;
    s.odd.pixels()[i] = sc + cs;
  }
  toEnergy(s.cosines, s.even, out[k45Degrees]);
  toEnergy(s.sines, s.odd, out[k135Degrees]);
}

}  // namespace saccade::attention
