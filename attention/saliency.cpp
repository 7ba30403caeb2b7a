#include "attention/saliency.h"

#include <algorithm>
#include <cmath>
#include <string>

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
float leastContrast(Channel channel) {
  return (channel == kIntensity ? kIntensityRange : kHueRange) / kDisplaySteps;
}
// Conspicuity maps are sums of normalised maps; below this nothing was promoted.
constexpr float kLeastConspicuity = 1e-6f;

void clear(ImageGray& image) { std::fill(image.pixels().begin(), image.pixels().end(), 0.0f); }

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
  pyramid_.resize(levels_, kCentres.front() - missing <= 0);
  features_.clear();
  for (int l = 0; l <= mapLevel_; ++l) {
    const bool used = l >= kCentres.front() - missing;
    features_.emplace_back(used ? levels_[l].width : 0, used ? levels_[l].height : 0);
  }
  conspicuity_.fill(ImageGray(levels_[mapLevel_].width, levels_[mapLevel_].height));
  toImage_.assign(1, Resampler(levels_[mapLevel_], levels_[0]));
  result_ = ImageGray(width, height);
}

// |centre - surround| on the centre's level, brought to the map's level, normalised and added.
void SaliencyModel::addFeature(Pair& pair, Channel channel) {
  const ImageGray& centre = pyramid_.plane(pair.centre, channel);
  const ImageGray& surround = pyramid_.plane(pair.surround, channel);
  ImageGray& difference = features_[pair.centre];
  for (int y = 0; y < centre.height(); ++y) {
    float* out = &difference.at(0, y);
    const float* c = &centre.at(0, y);
    pair.toCentre.row(surround, y, out);
    for (int x = 0; x < centre.width(); ++x) out[x] = std::abs(c[x] - out[x]);
  }
  for (int l = pair.centre; l < mapLevel_; ++l) halve(features_[l], features_[l + 1], padded_);
  ImageGray& feature = features_[mapLevel_];
  normalise_(feature, leastContrast(channel));
  std::vector<float>& sum = conspicuity_[channel == kIntensity ? 0 : 1].pixels();
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += feature.pixels()[i];
}

// S = (N(I) + N(C)) / 2 up to a scale, which is set so that the most salient place is 1.
void SaliencyModel::combine() {
  for (ImageGray& map : conspicuity_) normalise_(map, kLeastConspicuity);
  std::vector<float>& sum = conspicuity_[0].pixels();
  const std::vector<float>& colour = conspicuity_[1].pixels();
  float most = 0;
  for (std::size_t i = 0; i < sum.size(); ++i) most = std::max(most, sum[i] += colour[i]);
  if (most <= 0) return;
  for (float& v : sum) v /= most;
}

const ImageGray& SaliencyModel::compute(const core::ImageRgba8& displayed) {
  prepare(displayed.width(), displayed.height());
  pyramid_.build(displayed);
  for (ImageGray& map : conspicuity_) clear(map);
  for (Pair& pair : pairs_) {
    for (Channel channel : {kIntensity, kRedGreen, kBlueYellow}) addFeature(pair, channel);
  }
  combine();
  for (int y = 0; y < result_.height(); ++y) toImage_[0].row(conspicuity_[0], y, &result_.at(0, y));
  return result_;
}

core::ImageGray saliencyOf(const core::ImageRgba8& displayed, const SaliencyOptions& options) {
  return SaliencyModel(options).compute(displayed);
}

}  // namespace saccade::attention
