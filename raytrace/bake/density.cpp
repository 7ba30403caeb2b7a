#include "raytrace/bake/density.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "raytrace/bake/density_window.h"
#include "raytrace/bake/vertex_rings.h"

namespace saccade::raytrace {
namespace {

constexpr std::uint8_t kNoRadius = 255;  // no surface there
/// Sums over any rectangle of one plane in constant time. Flux sums are integers modulo 2^64: exact.
class SummedArea {
 public:
  SummedArea(int size, std::span<const float> areas, const FluxGrid& flux, int plane)
      : stride_(static_cast<std::size_t>(size) + 1), sums_(stride_ * stride_) {
    for (std::size_t y = 1; y < stride_; ++y) {
      Entry row;
      for (std::size_t x = 1; x < stride_; ++x) {
        const std::size_t texel = (y - 1) * (stride_ - 1) + x - 1;
        if (areas[texel] > 0) {
          const FluxGrid::Cell& cell = flux.cell(texel, plane);
          for (int c = 0; c < 3; ++c) row.flux[c] += cell.rgb[c];
          row.flux[3] += cell.squared;
          row.area += areas[texel];
        }
        const Entry& above = sums_[(y - 1) * stride_ + x];
        Entry& here = sums_[y * stride_ + x];
        for (int c = 0; c < 4; ++c) here.flux[c] = row.flux[c] + above.flux[c];
        here.area = row.area + above.area;
      }
    }
  }

  /// The window of half side `radius` around (x, y), cut to the chart.
  WindowSum window(const ChartRect& chart, int x, int y, int radius) const {
    return sum({std::max(chart.x0, x - radius), std::max(chart.y0, y - radius),
                std::min(chart.x1, x + radius + 1), std::min(chart.y1, y + radius + 1)});
  }

  WindowSum sum(const ChartRect& rect) const {
    const Entry &a = at(rect.x0, rect.y0), &b = at(rect.x1, rect.y0), &c = at(rect.x0, rect.y1),
                &d = at(rect.x1, rect.y1);
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
  const WindowSum pool = sums.window(chart, x, y, options.pooledRadius);
  WindowRule rule(options);
  std::size_t best = 0;
  for (std::size_t i = 0; i < kRadii.size() && kRadii[i] <= options.maxRadius; ++i) {
    WindowSum sum = sums.window(chart, x, y, kRadii[i]);
    if (kRadii[i] < options.pooledRadius)
      sum.squared = std::max(sum.squared, pool.squared * sum.area / pool.area);
    if (!rule.takes(sum)) break;
    best = i;
    if (rule.suffices(sum) || kRadii[i] >= longest) break;
  }
  return best;
}

/// Median of the widths chosen in the 3 x 3 texels around (x, y) that lie in the chart.
std::size_t medianRadius(const std::vector<std::uint8_t>& chosen, int size, const ChartRect& chart, int x,
                         int y) {
  std::array<std::uint8_t, 9> near{};
  std::size_t count = 0;
  for (int ny = std::max(chart.y0, y - 1); ny < std::min(chart.y1, y + 2); ++ny) {
    for (int nx = std::max(chart.x0, x - 1); nx < std::min(chart.x1, x + 2); ++nx) {
      const std::uint8_t r = chosen[static_cast<std::size_t>(ny) * static_cast<std::size_t>(size) + nx];
      if (r != kNoRadius) near[count++] = r;
    }
  }
  std::nth_element(near.begin(), near.begin() + count / 2, near.begin() + count);
  return near[count / 2];
}

DensityEstimate estimate(const SummedArea& sums, const ChartRect& chart, int x, int y, std::size_t radius,
                         double watts) {
  constexpr int kParts = 7;  // along a side
  const int r = kRadii[radius];
  const WindowSum whole = sums.window(chart, x, y, r);
  glm::dvec3 density = whole.weight / whole.area;
  if (r > 0 && whole.effectiveCount() > kFew) {
    const int side = 2 * r + 1, parts = std::min(side, kParts);
    LocalPlane plane;
    for (int i = 0; i < parts; ++i) {
      const int y0 = y - r + side * i / parts, y1 = y - r + side * (i + 1) / parts;
      for (int k = 0; k < parts; ++k) {
        const int x0 = x - r + side * k / parts, x1 = x - r + side * (k + 1) / parts;
        const ChartRect part{std::max(x0, chart.x0), std::max(y0, chart.y0), std::min(x1, chart.x1),
                             std::min(y1, chart.y1)};
        if (part.x0 >= part.x1 || part.y0 >= part.y1) continue;
        const glm::dvec2 middle(0.5 * (part.x0 + part.x1 - 1) - x, 0.5 * (part.y0 + part.y1 - 1) - y);
        plane.add(sums.sum(part), middle / (r + 0.5));
      }
    }
    density = plane.center(density);
  }
  return estimateOf(whole, density, watts);
}

}  // namespace

FluxGrid fluxOf(std::span<const float> areas, std::span<const DirectEstimate> direct, double& watts) {
  double total = 0, squares = 0;
  for (std::size_t i = 0; i < direct.size(); ++i) {
    total += core::luminance(direct[i].irradiance) * areas[i];
    squares += double{direct[i].variance} * areas[i] * areas[i];
  }
  // No sum may overflow: with a mean weight of at most 1 they stay below the number of texels, those of
  // squares below 2^32.
  watts = std::max(total / static_cast<double>(direct.size()), std::sqrt(squares) * 0x1p-16);
  if (!(watts > 0)) watts = 1;
  FluxGrid flux(direct.size(), 1);
  for (std::size_t i = 0; i < direct.size(); ++i) {
    const double perWatt = areas[i] / watts;
    FluxGrid::Cell& cell = flux.cell(i, 0);
    for (int c = 0; c < 3; ++c) {
      cell.rgb[c] = static_cast<std::uint64_t>(direct[i].irradiance[c] * perWatt * FluxGrid::kUnitsPerWeight);
    }
    cell.squared =
        static_cast<std::uint64_t>(direct[i].variance * perWatt * perWatt * FluxGrid::kUnitsPerWeight);
  }
  return flux;
}

void estimateDensity(const TexelMap& texels, std::span<const float> areas, const FluxGrid& flux, int plane,
                     double watts, const DensityOptions& options, const core::Progress& progress,
                     ProgressShare share, std::span<DensityEstimate> out) {
  const SummedArea sums(texels.size(), areas, flux, plane);
  const double middle = 0.5 * (share.from + share.to);
  // The chosen widths are themselves noisy: a texel takes the median of its neighbourhood's.
  std::vector<std::uint8_t> chosen(texels.texelCount(), kNoRadius);
  const auto forEachTexel = [&](std::size_t row, auto&& visit) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < texels.size(); ++x) {
      const std::size_t texel = row * static_cast<std::size_t>(texels.size()) + static_cast<std::size_t>(x);
      if (texels.chartOf(texel) < 0 || !(areas[texel] > 0)) continue;
      const ChartRect& chart = texels.charts()[static_cast<std::size_t>(texels.chartOf(texel))];
      if (!chart.byVertex) visit(texel, chart, x, y);
    }
  };
  const auto rows = static_cast<std::size_t>(texels.size());
  parallelFor(options.threads, rows, progress, {share.from, middle}, [&](std::size_t row) {
    forEachTexel(row, [&](std::size_t texel, const ChartRect& chart, int x, int y) {
      chosen[texel] = static_cast<std::uint8_t>(chooseRadius(sums, chart, x, y, options));
    });
  });
  parallelFor(options.threads, rows, progress, {middle, share.to}, [&](std::size_t row) {
    forEachTexel(row, [&](std::size_t texel, const ChartRect& chart, int x, int y) {
      out[texel] = estimate(sums, chart, x, y, medianRadius(chosen, texels.size(), chart, x, y), watts);
    });
  });
  estimateByVertex(texels, areas, flux, plane, watts, options, progress, out);
}

}  // namespace saccade::raytrace
