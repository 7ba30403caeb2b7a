#include "attention/saliency.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "attention/separable.h"
#include "core/error.h"

namespace saccade::attention {
namespace {

using core::ImageGray;

constexpr int kTopLevel = 8;
constexpr int kMapLevel = 4;
constexpr std::array<int, 3> kCentres{2, 3, 4};
constexpr std::array<int, 2> kDistances{3, 4};  // surround - centre

// What spans less than one step of an 8-bit display is not seen.
constexpr float kDisplaySteps = 255;
float leastContrastOf(Channel channel) {
  return (channel == kIntensity ? kIntensityRange : kHueRange) / kDisplaySteps;
}
// Conspicuity maps are sums of normalised maps; below this nothing was promoted.
constexpr float kLeastConspicuity = 1e-6f;

void clear(ImageGray& image) { std::fill(image.pixels().begin(), image.pixels().end(), 0.0f); }

void add(const ImageGray& map, ImageGray& sum) {
  for (std::size_t i = 0; i < map.pixels().size(); ++i) sum.pixels()[i] += map.pixels()[i];
}

}  // namespace

SaliencyModel::SaliencyModel(const SaliencyOptions& options)
    : options_(options), normalise_(options.normalise) {}

void SaliencyModel::prepare(int width, int height) {
  if (width < 1 || height < 1 || width > kLargestSide || height > kLargestSide) {
    throw core::Error("saliency: image of " + std::to_string(width) + " x " + std::to_string(height) +
                      " pixels; sides from 1 to " + std::to_string(kLargestSide) + " are possible");
  }
  if (width == result_.width() && height == result_.height()) return;
  levels_ = pyramidGeometry(width, height);
  const int missing = kTopLevel - (static_cast<int>(levels_.size()) - 1);
  mapLevel_ = std::clamp(kMapLevel - missing, 0, static_cast<int>(levels_.size()) - 1);
  pairs_.clear();
  for (int centre : kCentres) {
    for (int distance : kDistances) {
      const int c = centre - missing;
      if (c >= 0) pairs_.push_back({c, c + distance, Resampler(levels_[c + distance], levels_[c])});
    }
  }
  const int firstCentre = std::max(kCentres.front() - missing, 0);
  pyramid_.resize(levels_, firstCentre == 0);
  if (options_.orientation) orientations_.resize(levels_, firstCentre);
  prepareMaps(firstCentre);
  toImage_.assign(1, Resampler(levels_[mapLevel_], levels_[0]));
  result_ = ImageGray(width, height);
}

void SaliencyModel::prepareMaps(int firstCentre) {
  features_.clear();
  for (int l = 0; l <= mapLevel_; ++l) {
    const bool used = l >= firstCentre;
    features_.emplace_back(used ? levels_[l].width : 0, used ? levels_[l].height : 0);
  }
  const ImageGray map(levels_[mapLevel_].width, levels_[mapLevel_].height);
  conspicuity_.assign(options_.orientation ? 3 : 2, map);
  ofOneAngle_ = smoothed_ = map;
  const double sigma = kSmoothing * std::max(map.width(), map.height());
  smoothing_ = gaussianTaps(sigma, static_cast<int>(std::ceil(3 * sigma)));
}

// |centre - surround| on the centre's level, brought to the map's level, normalised and added.
void SaliencyModel::addFeature(Pair& pair, const ImageGray& centre, const ImageGray& surround,
                               float leastContrast, ImageGray& sum) {
  ImageGray& difference = features_[pair.centre];
  for (int y = 0; y < centre.height(); ++y) {
    float* out = &difference.at(0, y);
    const float* c = &centre.at(0, y);
    pair.toCentre.row(surround, y, out);
    for (int x = 0; x < centre.width(); ++x) out[x] = std::abs(c[x] - out[x]);
  }
  for (int l = pair.centre; l < mapLevel_; ++l) halve(features_[l], features_[l + 1], padded_);
  ImageGray& feature = features_[mapLevel_];
  normalise_(feature, leastContrast);
  add(feature, sum);
}

void SaliencyModel::addColours() {
  for (Pair& pair : pairs_) {
    for (const Channel channel : {kIntensity, kRedGreen, kBlueYellow}) {
      addFeature(pair, pyramid_.plane(pair.centre, channel), pyramid_.plane(pair.surround, channel),
                 leastContrastOf(channel), conspicuity_[channel == kIntensity ? 0 : 1]);
    }
  }
}

void SaliencyModel::addOrientations() {
  orientations_.build(pyramid_);
  for (const Orientation angle : {k0Degrees, k45Degrees, k90Degrees, k135Degrees}) {
    clear(ofOneAngle_);
    for (Pair& pair : pairs_) {
      addFeature(pair, orientations_.plane(pair.centre, angle), orientations_.plane(pair.surround, angle),
                 leastContrastOf(kIntensity), ofOneAngle_);
    }
    normalise_(ofOneAngle_, kLeastConspicuity);
    add(ofOneAngle_, conspicuity_[2]);
  }
}

// S = mean of N(I), N(C), perhaps N(O), up to a scale, which is set so that the most salient place is 1.
void SaliencyModel::combine() {
  for (ImageGray& map : conspicuity_) normalise_(map, kLeastConspicuity);
  for (std::size_t i = 1; i < conspicuity_.size(); ++i) add(conspicuity_[i], conspicuity_[0]);
  filterAlongX(conspicuity_[0], smoothing_, smoothed_, padded_);
  filterAlongY(smoothed_, smoothing_, conspicuity_[0]);
  std::vector<float>& sum = conspicuity_[0].pixels();
  const float most = *std::max_element(sum.begin(), sum.end());
  if (most <= 0) return;
  for (float& v : sum) v /= most;
}

const ImageGray& SaliencyModel::compute(const core::ImageRgba8& displayed) {
  prepare(displayed.width(), displayed.height());
  pyramid_.build(displayed);
  for (ImageGray& map : conspicuity_) clear(map);
  addColours();
  if (options_.orientation) addOrientations();
  combine();
  for (int y = 0; y < result_.height(); ++y) toImage_[0].row(conspicuity_[0], y, &result_.at(0, y));
  return result_;
}

core::ImageGray saliencyOf(const core::ImageRgba8& displayed, const SaliencyOptions& options) {
  return SaliencyModel(options).compute(displayed);
}

}  // namespace saccade::attention
