// What the frame knows beside its colours: for --aov and for the window's overlays.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/session/frame_loop.h"
#include "core/image.h"

namespace saccade::app {

enum class Aov { id, saliency, level, thread, age, validity, footprint, importance, rank };

/// Names as on the command line, in the order of the enum.
const std::vector<std::string>& aovNames();
/// "id, saliency, ...": for help texts.
std::string aovList();
/// Throws core::UsageError listing the names.
Aov aovByName(const std::string& name);

/// What Aov::validity tells of the sample that a pixel shows. A cached sample is tested once more by itself
/// (render::agedChange): the paper's test judges by the majority of an object's samples, so some are shown
/// that would fail alone; with --aging change there are none.
enum class Validity {
  none,    ///< no sample: the base layer, or what stands in for a correction
  exact,   ///< traced for this pixel and this camera
  coarse,  ///< traced for this camera at another pixel, whose splat reaches here
  valid,   ///< of an older camera, within --delta
  stale,   ///< of an older camera, beyond --delta
};

struct AovImage {
  /// Exact values a pixel: id 0.. ; saliency [0, 1]; level 0 (uncorrected) to 7; thread 1.. (0 = none); age
  /// in camera changes, 0 = fresh, -1 = no sample; Validity; side in pixels of the square that the sample was
  /// splatted with, 0 = no sample; importance as of the last analysis, 0 = diffuse;
  /// rank of the object in the queue, 1 = corrected next, 0 = all of it handed out, or diffuse.
  core::ImageGray values;
  /// footprint: the pixels whose right or lower neighbour shows another splat; empty for the others.
  std::vector<std::uint8_t> edges;
};

/// Of the last step. `stale` are looked for among all cached samples (some 10 ns each); the others take a
/// pass over the pixels.
AovImage aovImage(Aov aov, const FrameLoop& loop);

/// Colours of an overlay's values: pictures and legends have no other source.
class AovScale {
 public:
  /// `values` (those of the picture) set the end of a scale that has none of its own: importance, rank.
  AovScale(Aov aov, const core::ImageGray& values, int maxAge);

  /// Categories (id, level, thread, validity) or a ramp; what has no value is black.
  core::Rgba8 color(float value) const;

  /// From `low` to `high`, in this order; `low` may be the larger.
  struct Ramp {
    float low, high;
    std::string lowLabel, highLabel;
    bool logarithmic = false;
    /// Part of the colours (core::rampColor) that is used: what has a value does not look like black.
    float firstColor = kVisible, lastColor = 1;
    float leastValue = 0;  ///< what is below has no value
  };
  const std::optional<Ramp>& ramp() const { return ramp_; }
  Aov aov() const { return aov_; }

 private:
  static constexpr float kVisible = 0.15f;

  Aov aov_;
  std::optional<Ramp> ramp_;  ///< nothing: categories
};

/// The values in legend colours; edges are darker.
core::ImageRgba8 aovPicture(const AovImage& image, const AovScale& scale);

/// picture = strength * overlay + (1 - strength) * picture, as displayed. Sizes agree; strength in [0, 1].
void layOver(const core::ImageRgba8& overlay, float strength, core::ImageRgba8& picture);

/// What explains an overlay's colours.
struct AovLegend {
  const char* meaning = "";
  const char* black = "";  ///< what black is; empty where every pixel has a value
  std::optional<AovScale::Ramp> ramp;
  struct Swatch {
    float value;
    core::Rgba8 color;
    std::string label;
  };
  /// Growing: all levels and kinds of validity; threads and ids that occur, the latter with most pixels.
  std::vector<Swatch> swatches;
  std::size_t leftOut = 0;  ///< categories beyond kMostSwatches

  static constexpr std::size_t kMostSwatches = 12;
};

/// Objects are called by their names in the scene.
AovLegend aovLegend(const AovScale& scale, const core::ImageGray& values, const core::Scene& scene);

}  // namespace saccade::app
