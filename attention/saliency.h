// Bottom-up attention: Itti, Koch and Niebur 1998 as Haber et al. 2001, section 3, simplify it (no
// orientation). Nine pyramid levels (0..8), centres c in {2, 3, 4}, surrounds c + {3, 4}: 6 intensity and 12
// colour maps, each normalised, summed to two conspicuity maps at level 4, these normalised and summed with
// equal weights.
//
// With the option `orientation` a third conspicuity map of 24 more feature maps (attention/orientation.h):
// the six of an angle are summed and normalised before the angles are (Itti et al., equation 7).
//
// Departures, with their reasons:
// - The map is smoothed by a Gaussian of kSmoothing of the image's longer side, the value that Harel, Koch
// and Perona
//   2006 publish with their program: eyes land about what draws them, not on it, and half a degree off is as
//   good. Its border is a mirror; zeros beyond it would favour the middle, as photographers do, and score by
//   that.
// - Opponency as printed, |(R(c) - G(c)) - (G(s) - R(s))|, gives a constant red image a response, since
// centre and
//   surround add up. The sign is fixed: |(R - G)(c) - (R - G)(s)|, and B - Y alike. A constant image gives
//   exactly 0.
// - A feature map is brought to level 4 before it is normalised, as the authors' own program does: peaks are
// counted
//   at one resolution, and 18 normalisations of a 32 x 32 map cost little.
// - Images too small for nine levels (below 256 pixels) use those that exist, counted from the coarsest: with
// levels
//   0..7 centres are {1, 2, 3}, and so on; a centre below level 0 is left out. 16 x 16 has 6 maps, 1 x 1 none
//   (all 0).
#pragma once

#include <array>
#include <vector>

#include "attention/normalise.h"
#include "attention/orientation.h"
#include "attention/pyramid.h"
#include "attention/resample.h"
#include "core/image.h"

namespace saccade::attention {

struct SaliencyOptions {
  Normalisation normalise = Normalisation::max;  ///< --normalise
  bool orientation = false;                      ///< --orientation; off as in Haber 2001
};

/// Not thread safe: one owner. No allocation after the first image of a size.
class SaliencyModel {
 public:
  explicit SaliencyModel(const SaliencyOptions& options = {});

  /// Saliency per pixel of `displayed` (8-bit sRGB as a person sees it, alpha ignored; any size up to 8192 x
  /// 8192, at least 1 x 1, else core::Error). In [0, 1]: the most salient place of an image is 1, up to
  /// interpolation; all 0 where nothing stands out. Valid until the next call.
  const core::ImageGray& compute(const core::ImageRgba8& displayed);

  static constexpr int kLargestSide = 8192;
  static constexpr double kSmoothing = 0.02;  ///< standard deviation over the image's longer side

 private:
  /// One centre-surround pair of levels.
  struct Pair {
    int centre = 0, surround = 0;
    Resampler toCentre;
  };
  void prepare(int width, int height);
  void prepareMaps(int firstCentre);
  /// N(|centre - surround|) of two planes of the pair's levels, added to `sum` at mapLevel_.
  void addFeature(Pair& pair, const core::ImageGray& centre, const core::ImageGray& surround,
                  float leastContrast, core::ImageGray& sum);
  void addColours();
  void addOrientations();
  void combine();

  SaliencyOptions options_;
  Normaliser normalise_;
  std::vector<LevelGeometry> levels_;
  int mapLevel_ = 0;
  OpponentPyramid pyramid_;
  OrientationPyramid orientations_;  ///< of no level while the option is off
  std::vector<Pair> pairs_;
  std::vector<core::ImageGray> features_;     ///< by level 0..mapLevel_: scratch for one feature map
  std::vector<core::ImageGray> conspicuity_;  ///< intensity, colour, perhaps orientation; at mapLevel_
  core::ImageGray ofOneAngle_, smoothed_;     ///< scratch at mapLevel_
  std::vector<float> smoothing_;              ///< taps
  std::vector<Resampler> toImage_;            ///< one, or none before the first image
  std::vector<float> padded_;
  core::ImageGray result_;
};

/// The saliency map of one image, for `saccade attention`. Any thread.
core::ImageGray saliencyOf(const core::ImageRgba8& displayed, const SaliencyOptions& options);

}  // namespace saccade::attention
