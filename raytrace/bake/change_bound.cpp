#include "raytrace/bake/change_bound.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "raytrace/bake/direct.h"
#include "raytrace/bake/open_area.h"
#include "raytrace/bake/particles.h"
#include "raytrace/world.h"

namespace saccade::raytrace {
namespace {

constexpr std::uint64_t kParticles = 1 << 18;
constexpr int kSamples = 4;            // points of a texel
constexpr float kDirectError = 0.04f;  // standard error that a texel is refined down to
constexpr double kSure = 0.125;        // standard error, of what is allowed, in which a part's sum counts
constexpr double kErrors = 2;          // standard errors that are added

glm::dvec3 weightOf(const FluxGrid::Cell& cell) {
  return glm::dvec3(cell.rgb[0], cell.rgb[1], cell.rgb[2]) / static_cast<double>(FluxGrid::kUnitsPerWeight);
}

/// A change of colour alone has some too.
double sizeOf(const glm::dvec3& change) { return core::luminance(Vec3(glm::abs(change))); }

/// Differences of flux in one layer.
class FluxChange {
 public:
  FluxChange(const TexelMap& texels, const QuickLight& now, const QuickLight& before, int layer,
             double allowed)
      : texels_(texels), now_(now), before_(before), layer_(layer), allowed_(allowed) {}

  double most(std::int32_t chart, const ChartRect& rect) const { return most(chart, rect, sum(chart, rect)); }

 private:
  struct Sum {
    glm::dvec3 flux{0};
    double squares = 0, area = 0;
    double error() const { return std::sqrt(squares) / area; }
  };

  Sum sum(std::int32_t chart, const ChartRect& rect) const {
    Sum s;
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x) {
        const std::size_t t = static_cast<std::size_t>(y) * texels_.size() + x;
        if (texels_.chartOf(t) != chart || !now_.open(t, layer_)) continue;
        const Vec3 was = layer_ < before_.layers() ? before_.flux(t, layer_) : Vec3(0);
        const glm::dvec3 d = glm::dvec3(now_.flux(t, layer_)) - glm::dvec3(was);
        s.flux += d;
        s.squares += sizeOf(d) * sizeOf(d);
        s.area += texels_.area(t);
      }
    }
    return s;
  }

  bool sure(const Sum& s) const { return s.squares == 0 || s.error() <= kSure * allowed_; }

  double most(std::int32_t chart, const ChartRect& rect, const Sum& whole) const {
    if (whole.squares == 0) return 0;
    const int width = rect.x1 - rect.x0, height = rect.y1 - rect.y0;
    if (width > 1 || height > 1) {
      ChartRect a = rect, b = rect;
      if (width >= height)
        a.x1 = b.x0 = rect.x0 + width / 2;
      else
        a.y1 = b.y0 = rect.y0 + height / 2;
      const Sum first = sum(chart, a), second = sum(chart, b);
      if (sure(first) && sure(second)) return std::max(most(chart, a, first), most(chart, b, second));
    }
    return sizeOf(whole.flux) / whole.area + kErrors * whole.error();
  }

  const TexelMap& texels_;
  const QuickLight &now_, &before_;
  int layer_;
  double allowed_;
};

}  // namespace

QuickLight::QuickLight(const core::Scene& charted, const core::Plan& plan, int size, int threads,
                       const std::stop_token& stop) {
  const World world(charted, plan);
  const TexelMap texels(charted, size);
  const core::Progress progress{{}, stop};
  const int layerCount = texels.anyDoubleSided() ? 2 : 1;
  const BlockRange all = allBlocks(texels.texelCount());
  OpenArea areas(texels, layerCount);
  DirectOptions options;
  options.samples = kSamples;
  options.relativeError = kDirectError;
  options.threads = threads;
  for (int layer = 0; layer < layerCount; ++layer) {
    areas.probe(world, texels, layer, all, threads, progress);
    std::vector<DirectEstimate> found(texels.texelCount());
    directIrradiance(world, texels, areas, layer, all, options, progress, found);
    Layer& out = layers_.emplace_back();
    for (const DirectEstimate& e : found) out.direct.push_back(e.irradiance);
    for (const float area : areas.areas(layer)) out.open.push_back(area > 0);
  }
  ParticleState particles(world, texels.texelCount(), layerCount);
  ParticleOptions tracing;
  tracing.whole = kParticles;
  tracing.threads = threads;
  traceParticles(world, texels, tracing, kParticles, progress, particles);
  const double watts = wattsPerWeight(world, kParticles);
  for (int layer = 0; layer < layerCount; ++layer) {
    for (std::size_t t = 0; t < texels.texelCount(); ++t) {
      glm::dvec3 weight = weightOf(particles.flux.cell(t, ParticleState::indirectPlane(layer)));
      if (particles.caustics) weight += weightOf(particles.flux.cell(t, particles.causticPlane(layer)));
      layers_[static_cast<std::size_t>(layer)].flux.emplace_back(weight * watts);
    }
  }
  if (stop.stop_requested()) throw core::Error("stopped on request");
}

std::vector<double> boundOfChange(const TexelMap& texels, const QuickLight& now, const QuickLight& before,
                                  double allowed) {
  std::vector<double> direct(texels.charts().size(), 0);
  for (int layer = 0; layer < now.layers(); ++layer) {
    for (std::size_t t = 0; t < texels.texelCount(); ++t) {
      if (texels.chartOf(t) < 0 || !now.open(t, layer)) continue;
      const Vec3 was = layer < before.layers() ? before.direct(t, layer) : Vec3(0);
      double& most = direct[static_cast<std::size_t>(texels.chartOf(t))];
      most = std::max(most, sizeOf(now.direct(t, layer) - was));
    }
  }
  std::vector<double> bound(direct.size(), 0);
  for (int layer = 0; layer < now.layers(); ++layer) {
    const FluxChange flux(texels, now, before, layer, allowed);
    for (std::size_t c = 0; c < bound.size(); ++c)
      bound[c] = std::max(bound[c], direct[c] + flux.most(static_cast<std::int32_t>(c), texels.charts()[c]));
  }
  return bound;
}

}  // namespace saccade::raytrace
