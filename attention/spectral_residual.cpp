#include "attention/spectral_residual.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace saccade::attention {
namespace {

constexpr int kWorkingSide = 64;
constexpr int kMeanSide = 3;
constexpr float kAmplitudeFloor = 1;  // one code
constexpr double kSigma = 2.5;

cv::Mat greyOf(const core::ImageRgba8& image) {
  cv::Mat grey(image.height(), image.width(), CV_32F);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const core::Rgba8& p = image.at(x, y);
      grey.at<float>(y, x) = static_cast<float>(p.r + p.g + p.b) / 3;
    }
  }
  return grey;
}

cv::Mat atWorkingSize(const cv::Mat& grey) {
  const int longer = std::max(grey.cols, grey.rows);
  if (longer <= kWorkingSide) return grey;
  const auto side = [longer](int pixels) {
    return std::max(1, (pixels * kWorkingSide + longer / 2) / longer);
  };
  cv::Mat small;
  cv::resize(grey, small, {side(grey.cols), side(grey.rows)}, 0, 0, cv::INTER_AREA);
  return small;
}

/// Mean of the neighbouring frequencies' log amplitudes: h_n * L of the paper.
cv::Mat meanLogAmplitude(const cv::Mat& spectrum) {
  cv::Mat parts[2], amplitude, logarithm, bordered, mean;
  cv::split(spectrum, parts);
  cv::magnitude(parts[0], parts[1], amplitude);
  cv::log(amplitude + kAmplitudeFloor, logarithm);
  constexpr int kReach = kMeanSide / 2;
  cv::copyMakeBorder(logarithm, bordered, kReach, kReach, kReach, kReach, cv::BORDER_WRAP);
  cv::blur(bordered, mean, {kMeanSide, kMeanSide});
  return mean({kReach, kReach, logarithm.cols, logarithm.rows}).clone();
}

/// |F^-1[exp(R + iP)]|^2, smoothed (equation 9).
cv::Mat residualEnergy(const cv::Mat& grey) {
  cv::Mat spectrum, factor, energy;
  cv::dft(grey, spectrum, cv::DFT_COMPLEX_OUTPUT);
  cv::exp(-meanLogAmplitude(spectrum), factor);
  cv::Mat parts[2];
  cv::split(spectrum, parts);
  for (cv::Mat& part : parts) part = part.mul(factor);
  cv::merge(parts, 2, spectrum);
  cv::Mat residual;
  cv::dft(spectrum, residual, cv::DFT_INVERSE | cv::DFT_REAL_OUTPUT | cv::DFT_SCALE);
  cv::GaussianBlur(residual.mul(residual), energy, {}, kSigma, kSigma, cv::BORDER_CONSTANT);
  return energy;
}

}  // namespace

core::ImageGray spectralResidual(const core::ImageRgba8& displayed) {
  core::ImageGray result(displayed.width(), displayed.height());
  if (displayed.empty()) return result;
  cv::setNumThreads(1);  // OpenCV's pool would compete with the tracers for the cores
  const cv::Mat grey = greyOf(displayed);
  double least = 0, most = 0;
  cv::minMaxLoc(grey, &least, &most);
  if (least == most) return result;  // the transform would leave rounding errors, stretched to [0, 1]
  const cv::Mat energy = residualEnergy(atWorkingSize(grey));
  cv::minMaxLoc(energy, &least, &most);
  if (!(most > 0)) return result;
  cv::Mat full(result.height(), result.width(), CV_32F, result.pixels().data());
  cv::resize(energy * (1 / most), full, full.size(), 0, 0, cv::INTER_LINEAR);
  for (float& v : result.pixels()) v = std::clamp(v, 0.0f, 1.0f);
  return result;
}

}  // namespace saccade::attention
