// How well a saliency map foretells where people look. Bylinskii, Judd, Oliva, Torralba and Durand, "What do
// different evaluation metrics tell us about saliency models?", PAMI 2019, sections 4.1 (AUC, shuffled AUC)
// and 4.2 (NSS). Any thread.
#pragma once

#include <optional>
#include <span>

#include "core/image.h"
#include "core/metrics/fixations.h"

namespace saccade::core {

/// Maps are scored at this size, whatever their picture's, so that scores of several pictures have a common
/// mean.
inline constexpr int kScoredWidth = 200, kScoredHeight = 150;
/// Fixations on other pictures that the shuffled AUC wants.
inline constexpr std::size_t kOtherFixations = 1000;

/// Each pixel the mean over the area of `map` that it covers; of a smaller map, what covers it.
ImageGray resizedByArea(const ImageGray& map, int width, int height);

/// The chance that one of `positives` is above one of `negatives`, equal ones counted half: the area under
/// the ROC curve. At least one value each; no NaN.
double areaUnderCurve(std::span<const float> positives, std::span<const float> negatives);

struct FixationScores {
  /// Judd's AUC: values at fixations against those of all pixels. 0.5 is chance.
  double auc = 0.5;
  /// Shuffled AUC: against values where people looked at other pictures, so that looking at the middle earns
  /// nothing. Nothing where no other picture has fixations.
  std::optional<double> shuffledAuc;
  /// Normalised scanpath saliency: mean over the fixations of the map's value in standard deviations above
  /// its mean. 0 is chance, and a constant map's.
  double nss = 0;
  int fixations = 0;  ///< inside the picture; the others do not count
};

/// Scores a map as large as its picture against fixations in the picture's pixels. Nothing where no fixation
/// lies inside.
std::optional<FixationScores> scoreFixations(const ImageGray& map, std::span<const Fixation> own,
                                             std::span<const Fixation> onOthers);

}  // namespace saccade::core
