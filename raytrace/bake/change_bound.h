// How much the light of each chart can differ between two states of a scene.
//
// Direct light is taken at a few points of each texel, particles are traced as at quality preview, in both
// states from the same random numbers: what the change does not reach is the same to the last bit, and its
// difference 0. Differences of colour count as those of brightness do: by channel, whatever their sign,
// weighed like luminance. Where the change reaches, direct light counts texel by texel. Of particles' flux
// the differences of texels are summed over the smallest parts of a chart (halves of halves) in which that
// sum is sure to an eighth of what is allowed; two standard errors are added. Charts too small for that get
// the whole uncertainty, and so are rather baked again than kept.
#pragma once

#include <stop_token>
#include <vector>

#include "core/scene/plan.h"
#include "core/scene/scene.h"
#include "raytrace/bake/texel_map.h"

namespace saccade::raytrace {

/// What a quick look finds in a charted scene.
class QuickLight {
 public:
  /// `size`: of the atlas. The same for any number of threads. Throws core::Error when stopped.
  QuickLight(const core::Scene& charted, const core::Plan& plan, int size, int threads,
             const std::stop_token& stop);

  int layers() const { return static_cast<int>(layers_.size()); }
  /// Direct irradiance, W/m^2; 0 for texels that are covered.
  const core::Vec3& direct(std::size_t texel, int layer) const { return of(layer).direct[texel]; }
  /// Flux that came by other surfaces, W.
  const core::Vec3& flux(std::size_t texel, int layer) const { return of(layer).flux[texel]; }
  /// Some of the texel's surface is not covered.
  bool open(std::size_t texel, int layer) const { return of(layer).open[texel] != 0; }

 private:
  struct Layer {
    std::vector<core::Vec3> direct, flux;
    std::vector<char> open;
  };
  const Layer& of(int layer) const { return layers_[static_cast<std::size_t>(layer)]; }

  std::vector<Layer> layers_;
};

/// Of irradiance, W/m^2, weighed like luminance, by chart of `texels`, which are those of the present scene.
/// Texels that are covered now do not count. `before` may lack texels of charts that are new.
std::vector<double> boundOfChange(const TexelMap& texels, const QuickLight& now, const QuickLight& before,
                                  double allowed);

}  // namespace saccade::raytrace
