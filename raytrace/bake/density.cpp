#include "raytrace/bake/density.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace saccade::raytrace {
namespace {

/// Window half sides in texels, the growing sequence that is tried.
constexpr std::array<int, 15> kRadii = {0, 1, 2, 3, 4, 6, 8, 11, 16, 22, 32, 45, 64, 90, 128};
/// Sums within fewer effective particles than this have no usable error of their own.
constexpr double kFew = 6;

/// What a window holds. Weights are in mean particles.
struct WindowSum {
  glm::dvec3 weight{0};
  double squared = 0;  ///< of luminance weights
  double area = 0;     ///< m^2

  WindowSum& addScaled(const WindowSum& o, double scale) {
    weight += o.weight * scale;
    area += o.area * scale;
    return *this;
  }
  double luminance() const { return 0.2126 * weight.x + 0.7152 * weight.y + 0.0722 * weight.z; }
  double effectiveCount() const { return squared > 0 ? luminance() * luminance() / squared : 0; }
};

/// Sums over any rectangle of one layer in constant time. Flux sums are integers modulo 2^64: exact.
class SummedArea {
 public:
  SummedArea(const TexelMap& texels, const FluxGrid& flux, int layer)
      : stride_(static_cast<std::size_t>(texels.size()) + 1), sums_(stride_ * stride_) {
    for (std::size_t y = 1; y < stride_; ++y) {
      Entry row;
      for (std::size_t x = 1; x < stride_; ++x) {
        const std::size_t texel = (y - 1) * (stride_ - 1) + x - 1;
        const FluxGrid::Cell& cell = flux.cell(texel, layer);
        for (int c = 0; c < 3; ++c) row.flux[c] += cell.rgb[c];
        row.flux[3] += cell.squared;
        row.area += texels.area(texel);
        const Entry& above = sums_[(y - 1) * stride_ + x];
        Entry& here = sums_[y * stride_ + x];
        for (int c = 0; c < 4; ++c) here.flux[c] = row.flux[c] + above.flux[c];
        here.area = row.area + above.area;
      }
    }
  }

  /// The window of half side `radius` around (x, y), cut to the chart.
  WindowSum window(const ChartRect& chart, int x, int y, int radius) const {
    const Entry& a = at(std::max(chart.x0, x - radius), std::max(chart.y0, y - radius));
    const Entry& b = at(std::min(chart.x1, x + radius + 1), std::max(chart.y0, y - radius));
    const Entry& c = at(std::max(chart.x0, x - radius), std::min(chart.y1, y + radius + 1));
    const Entry& d = at(std::min(chart.x1, x + radius + 1), std::min(chart.y1, y + radius + 1));
    const auto weight = [&](int i) {
      return static_cast<double>(d.flux[i] - b.flux[i] - c.flux[i] + a.flux[i]) / FluxGrid::kUnitsPerWeight;
    };
    return {{weight(0), weight(1), weight(2)}, weight(3), d.area - b.area - c.area + a.area};
  }

 private:
  struct Entry {
    std::uint64_t flux[4] = {0, 0, 0, 0};  ///< RGB, squared
    double area = 0;
  };
  const Entry& at(int x, int y) const { return sums_[static_cast<std::size_t>(y) * stride_ + x]; }

  std::size_t stride_;
  std::vector<Entry> sums_;
};

/// Index into kRadii of the widest window that agrees with all smaller ones.
std::size_t chooseRadius(const SummedArea& sums, const ChartRect& chart, int x, int y,
                         const DensityOptions& options) {
  const int longest = std::max(chart.x1 - chart.x0, chart.y1 - chart.y0);
  double low = 0, high = core::kInfinity;
  std::size_t best = 0;
  for (std::size_t i = 0; i < kRadii.size() && kRadii[i] <= options.maxRadius; ++i) {
    const WindowSum sum = sums.window(chart, x, y, kRadii[i]);
    const double mean = sum.luminance() / sum.area;
    // One particle of weight 1 more than came: few or no particles do not pass for certainty.
    const double error = options.confidence * std::sqrt(sum.squared + 1) / sum.area;
    const double count = sum.effectiveCount();
    if (mean - error > high || mean + error < low) break;
    low = std::max(low, mean - error);
    high = std::min(high, mean + error);
    best = i;
    if (count >= options.enough || kRadii[i] >= longest) break;
  }
  return best;
}

/// A stack of three windows, wide to narrow: near enough to a bell to leave no edges of its own.
DensityEstimate estimate(const SummedArea& sums, const ChartRect& chart, int x, int y, std::size_t radius,
                         double watts) {
  const WindowSum wide = sums.window(chart, x, y, kRadii[radius]);
  WindowSum stack;
  stack.addScaled(wide, 1);
  if (radius > 0 && wide.effectiveCount() > kFew) {
    stack.addScaled(sums.window(chart, x, y, kRadii[radius] * 2 / 3), 1);
    stack.addScaled(sums.window(chart, x, y, kRadii[radius] / 3), 1);
  }
  DensityEstimate out;
  out.irradiance = Vec3(stack.weight * (watts / stack.area));
  if (wide.luminance() > 0)
    out.relativeError = static_cast<float>(std::sqrt(wide.squared) / wide.luminance());
  return out;
}

}  // namespace

void estimateDensity(const TexelMap& texels, const FluxGrid& flux, int layer, double watts,
                     const DensityOptions& options, const core::Progress& progress, ProgressShare share,
                     std::span<DensityEstimate> out) {
  const SummedArea sums(texels, flux, layer);
  parallelFor(options.threads, static_cast<std::size_t>(texels.size()), progress, share,
              [&](std::size_t row) {
                for (int x = 0; x < texels.size(); ++x) {
                  const std::size_t texel =
                      row * static_cast<std::size_t>(texels.size()) + static_cast<std::size_t>(x);
                  if (texels.chartOf(texel) < 0 || !(texels.area(texel) > 0)) continue;
                  const ChartRect& chart = texels.charts()[static_cast<std::size_t>(texels.chartOf(texel))];
                  if (layer == 1 && !chart.doubleSided) continue;
                  const int y = static_cast<int>(row);
                  out[texel] = estimate(sums, chart, x, y, chooseRadius(sums, chart, x, y, options), watts);
                }
              });
}

}  // namespace saccade::raytrace
