// The normalisation operator N(.) of Itti's model: promotes maps with few strong peaks, suppresses maps with
// many alike. Both of the authors' forms.
#pragma once

#include <memory>

#include "core/image.h"

namespace saccade::attention {

enum class Normalisation {
  /// Itti, Koch and Niebur 1998: the map, stretched to [0, 1], times (M - m)^2, M its maximum, m the mean of
  /// its
  /// other local maxima. The default: one pass, no parameters in pixels, and the paper that Haber 2001 refers
  /// to.
  max,
  /// Itti and Koch 1999/2001, "Feature combination strategies": iterated convolution with a difference of
  /// Gaussians.
  /// Sparser maps; slower.
  dog,
};

/// One owner, one thread at a time.
class Normaliser {
 public:
  explicit Normaliser(Normalisation kind);
  ~Normaliser();
  Normaliser(Normaliser&&) noexcept;
  Normaliser& operator=(Normaliser&&) noexcept;

  /// In place; values >= 0 in and out, [0, 1] out of `max`. `leastContrast` > 0: a map that spans less is
  /// stretched by this instead, so that what no display shows (rounding, one step of 8 bits) is not promoted.
  /// A constant map becomes 0.
  void operator()(core::ImageGray& map, float leastContrast);

 private:
  struct Peaks;
  struct Kernels;
  void promoteByPeaks(core::ImageGray& map);

  Normalisation kind_;
  std::unique_ptr<Peaks> peaks_;      ///< for max
  std::unique_ptr<Kernels> kernels_;  ///< for dog, kept for the last map size
};

}  // namespace saccade::attention
