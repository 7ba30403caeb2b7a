// What a reference is made of: sums of path samples, in two halves that know nothing of one another.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/image.h"

namespace saccade::bench {

/// The samples of one pixel are stratified against one another, so their own variance says too much about the
/// error of their mean. Two halves under seeds of their own are independent whatever happens inside them: the
/// variance of half their difference is that of their mean. One owner.
struct ReferenceSums {
  int width = 0, height = 0;
  std::uint64_t samplesPerHalf = 0;  ///< a pixel
  double seconds = 0;                ///< of processor time over the threads, over all runs
  std::array<std::vector<glm::dvec3>, 2> halves;

  ReferenceSums() = default;
  ReferenceSums(int imageWidth, int imageHeight);

  /// `mean` of `samples` more samples of a half. The caller counts them once both halves have them.
  void add(int half, const core::ImageRgb& mean, int samples);

  std::uint64_t samplesPerPixel() const { return 2 * samplesPerHalf; }
  /// At least one sample a half.
  core::ImageRgb mean() const;
  core::ImageRgb half(int which) const;
  /// Estimate of the relative MSE of mean() against the truth: the mean over pixels and channels of
  /// ((a - b) / 2)^2 / (mean^2 + core::kRelativeEpsilon).
  double relmse() const;
};

/// Written under a temporary name and renamed, with a checksum. Throw core::Error; read also where the file
/// is torn, of another kind, or of another key or size.
void writeSums(const std::filesystem::path& file, std::uint64_t key, const ReferenceSums& sums);
ReferenceSums readSums(const std::filesystem::path& file, std::uint64_t key, int width, int height);

}  // namespace saccade::bench
