// The orientation channel of Itti, Koch and Niebur 1998: local contrast of four orientations on the levels of
// the intensity pyramid.
//
// - Gabor filters as in the authors' SaliencyToolbox: period 7 samples, an isotropic Gaussian of a standard
//   deviation of 7/3 samples, 9 x 9 taps. Their two phases, even and odd, are combined to the energy
//   sqrt(even^2 + odd^2), so that a line and an edge are the same orientation wherever they lie. The even
//   phase is made free of a mean, or brightness would have an orientation.
// - With an isotropic envelope exp(i k x) is a product of functions of one coordinate for any direction of k,
//   and the diagonals share theirs: 5 filters along x and 9 along y do for 8 filters of 9 x 9.
#pragma once

#include <array>
#include <vector>

#include "attention/pyramid.h"
#include "core/image.h"

namespace saccade::attention {

/// Of the grating's normal, counter-clockwise from +x on the screen: 0 answers to vertical lines.
enum Orientation { k0Degrees, k45Degrees, k90Degrees, k135Degrees, kOrientations };

/// One owner, one thread at a time. Allocates only when the levels change.
class OrientationPyramid {
 public:
  OrientationPyramid();
  /// Keeps the levels from firstLevel on.
  void resize(const std::vector<LevelGeometry>& levels, int firstLevel);
  /// From the intensity of the same levels.
  void build(const OpponentPyramid& pyramid);
  /// In units of intensity: a grating of the filter's period and direction gives about the difference between
  /// its brightest and its darkest place, a constant image 0 up to rounding.
  const core::ImageGray& plane(int level, Orientation orientation) const {
    return planes_[level][orientation];
  }

 private:
  struct Taps {
    std::vector<float> gauss, flatCosine, sine;       ///< for 0 and 90 degrees; the cosine without its mean
    std::vector<float> diagonalCosine, diagonalSine;  ///< for 45 and 135
    float diagonalMean = 0;                           ///< of the even diagonal filter
  };
  using Planes = std::array<core::ImageGray, kOrientations>;
  /// What is kept while one level is filtered.
  struct Scratch {
    core::ImageGray gauss, flatCosine, sine, diagonalCosine, diagonalSine;  ///< along x
    core::ImageGray even, odd, cosines, sines, mean;                        ///< along both
  };
  void addUpright(Scratch& s, Planes& out);
  void addDiagonals(Scratch& s, Planes& out);

  Taps taps_;
  int firstLevel_ = 0;
  std::vector<Planes> planes_;    ///< by level; empty below firstLevel_
  std::vector<Scratch> scratch_;  ///< as planes_
  std::vector<float> padded_;
};

}  // namespace saccade::attention
