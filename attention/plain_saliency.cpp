#include "attention/plain_saliency.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "attention/pyramid.h"
#include "attention/saliency.h"
#include "core/error.h"

namespace saccade::attention {
namespace {

constexpr int kTop = 8, kMapLevel = 4, kLeastSide = 256;
constexpr double kRounding = 1e-5, kLeastFactor = 1e-4, kLeastConspicuity = 1e-6;

/// Intensity, R - G, B - Y as OpponentPyramid has them.
std::vector<cv::Mat> opponentChannels(const core::ImageRgba8& displayed) {
  const cv::Mat rgba(displayed.height(), displayed.width(), CV_8UC4,
                     const_cast<core::Rgba8*>(displayed.pixels().data()));
  cv::Mat floats;
  rgba.convertTo(floats, CV_32F);
  std::vector<cv::Mat> c;
  cv::split(floats, c);
  const cv::Mat &r = c[0], &g = c[1], &b = c[2];
  const cv::Mat sum = r + g + b;
  double brightest = 0;
  cv::minMaxLoc(sum, nullptr, &brightest);
  const cv::Mat red = cv::max(2 * r - g - b, 0), green = cv::max(2 * g - r - b, 0);
  const cv::Mat blue = cv::max(2 * b - r - g, 0), yellow = 2 * cv::max(cv::min(r, g) - b, 0);
  cv::Mat perIntensity = 1.5 * kHueUnit / cv::max(sum, 1);
  perIntensity.setTo(0, 10 * sum <= brightest);
  return {sum, (red - green).mul(perIntensity), (blue - yellow).mul(perIntensity)};
}

void normalise(cv::Mat& map, double leastContrast) {
  double least = 0, most = 0;
  cv::minMaxLoc(map, &least, &most);
  map = (map - least) / std::max(most - least, leastContrast);
  cv::Mat highest;
  cv::dilate(map, highest, cv::Mat());  // 3 x 3
  const cv::Mat peaks = (map == highest) & (map > kRounding);
  const int count = cv::countNonZero(peaks);
  cv::minMaxLoc(map, nullptr, &most);
  const double others = count > 1 ? (cv::mean(map, peaks)[0] * count - most) / (count - 1) : 0;
  map *= std::max((most - others) * (most - others), kLeastFactor);
}

void addFeatures(const cv::Mat& channel, double leastContrast, cv::Mat& conspicuity) {
  std::vector<cv::Mat> levels;
  cv::buildPyramid(channel, levels, kTop);
  for (const int c : {2, 3, 4}) {
    for (const int distance : {3, 4}) {
      cv::Mat surround, difference, feature;
      cv::resize(levels[c + distance], surround, levels[c].size());
      cv::absdiff(levels[c], surround, difference);
      cv::resize(difference, feature, levels[kMapLevel].size(), 0, 0, cv::INTER_AREA);
      normalise(feature, leastContrast);
      conspicuity = conspicuity.empty() ? feature : conspicuity + feature;
    }
  }
}

}  // namespace

core::ImageGray plainSaliency(const core::ImageRgba8& displayed) {
  if (std::min(displayed.width(), displayed.height()) < kLeastSide)
    throw core::Error("the plain saliency map takes images of at least 256 x 256 pixels");
  cv::setNumThreads(1);
  const std::vector<cv::Mat> channels = opponentChannels(displayed);
  cv::Mat intensity, colour;
  addFeatures(channels[0], kIntensityRange / 255, intensity);
  for (const int c : {1, 2}) addFeatures(channels[c], kHueRange / 255, colour);
  for (cv::Mat* map : {&intensity, &colour}) normalise(*map, kLeastConspicuity);
  cv::Mat sum = intensity + colour;
  const double sigma = SaliencyModel::kSmoothing * std::max(sum.cols, sum.rows);
  cv::GaussianBlur(sum, sum, {}, sigma, sigma, cv::BORDER_REFLECT);
  double most = 0;
  cv::minMaxLoc(sum, nullptr, &most);
  core::ImageGray result(displayed.width(), displayed.height());
  if (most <= 0) return result;
  cv::Mat full(result.height(), result.width(), CV_32F, result.pixels().data());
  cv::resize(sum / most, full, full.size());
  return result;
}

}  // namespace saccade::attention
