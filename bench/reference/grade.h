// The errors of pictures against a reference, as values of records.
#pragma once

#include <vector>

#include "bench/harness/record.h"
#include "core/image.h"
#include "core/metrics/comparison.h"

namespace saccade::bench {

struct Grade {
  core::Comparison errors;
  double flipSalient = 0;  ///< FLIP weighted by the reference's saliency (attention/spectral_residual.h)
};

/// One reference, looked at once. Any thread.
class Grader {
 public:
  explicit Grader(core::ImageRgb reference);

  const core::ImageRgb& reference() const { return reference_; }
  const core::ImageGray& saliency() const { return saliency_; }
  /// Throws core::Error for another size or a value that is not finite.
  Grade grade(const core::ImageRgb& linear) const;
  /// For errors that were measured otherwise.
  double flipSalient(const core::Comparison& errors) const;

 private:
  core::ImageRgb reference_;
  core::ImageGray saliency_;
};

/// Adds relmse, rmse, psnr, ssim, flip, flip_median, flip_p95, flip_salient and max_abs of at least one
/// repeat.
void addErrors(Record& record, const std::vector<Grade>& repeats);

}  // namespace saccade::bench
