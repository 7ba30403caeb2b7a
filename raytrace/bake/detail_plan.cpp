#include "raytrace/bake/detail_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/math/random.h"

namespace saccade::raytrace {
namespace {

/// Of a squared second difference from texel to texel: what look-ups miss, squared (see texel_density.cpp).
constexpr double kMissed = 0.16;
/// Texels that miss less than this share of the wished error are not probed.
constexpr double kWorthProbing = 0.5;
/// Squares of differences below so many times that of noise are taken for it.
constexpr double kSure = 3;
/// Cells of a probe along a side.
constexpr int kProbeSide = 4;
constexpr int kProbeSamples = 4;                     // of a cell and set
constexpr std::uint32_t kProbeStream = 0x65646765u;  // keeps the random numbers apart from others'
constexpr int kMostLog2 = 6;

struct MeanLight {
  double area = 0, irradiance = 0;  ///< m^2; W/m^2
};

MeanLight meanLight(const TexelMap& texels, std::span<const LayerLight> layers) {
  MeanLight mean;
  for (const LayerLight& layer : layers) {
    for (std::size_t t = 0; t < texels.texelCount(); ++t) {
      if (!(layer.open[t] > 0)) continue;
      if (layer.keptCharts && (*layer.keptCharts)[static_cast<std::size_t>(texels.chartOf(t))]) continue;
      mean.area += layer.open[t];
      mean.irradiance += layer.open[t] * core::luminance(layer.direct[t].irradiance);
    }
  }
  if (mean.area > 0) mean.irradiance /= mean.area;
  return mean;
}

/// Second differences of direct light from texel to texel.
class Neighbourhood {
 public:
  Neighbourhood(const TexelMap& texels, const LayerLight& light) : texels_(texels), light_(light) {}

  /// The square of the second difference, without noise; 0 at the chart's border.
  double along(std::size_t texel, std::ptrdiff_t step) const {
    const auto before = neighbour(texel, -step), behind = neighbour(texel, step);
    return before && behind ? squareOf(*before, texel, *behind) : 0;
  }

  /// Something covers part of a texel in the 3 x 3 around, or a square of a second difference there exceeds
  /// `limit`: a step shows beside it too.
  bool steps(std::size_t texel, double limit) const {
    const auto size = static_cast<std::ptrdiff_t>(texels_.size());
    for (const std::ptrdiff_t row : {-size, std::ptrdiff_t{0}, size}) {
      for (const std::ptrdiff_t column : {-1, 0, 1}) {
        const std::optional<std::size_t> near = neighbour(texel, row + column);
        if (near && (isCut(*near) || along(*near, 1) > limit || along(*near, size) > limit)) return true;
      }
    }
    return false;
  }

 private:
  /// The texel at `step`; none where it is of another chart.
  std::optional<std::size_t> neighbour(std::size_t texel, std::ptrdiff_t step) const {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(texel) + step;
    if (at < 0 || at >= static_cast<std::ptrdiff_t>(texels_.texelCount())) return std::nullopt;
    const auto near = static_cast<std::size_t>(at);
    if (texels_.chartOf(near) != texels_.chartOf(texel)) return std::nullopt;
    return near;
  }

  bool isCut(std::size_t texel) const {
    constexpr float kWhole = 0.99f;
    return light_.open[texel] < kWhole * texels_.area(texel);
  }

  double squareOf(std::size_t a, std::size_t b, std::size_t c) const {
    const auto light = [&](std::size_t t) { return double{core::luminance(light_.direct[t].irradiance)}; };
    const double difference = light(a) - 2 * light(b) + light(c);
    const double noise =
        double{light_.direct[a].variance} + 4.0 * light_.direct[b].variance + light_.direct[c].variance;
    return std::max(0.0, difference * difference - kSure * noise);
  }

  const TexelMap& texels_;
  const LayerLight& light_;
};

/// Cells of a texel, few samples each, by two independent sets.
class TexelProbe {
 public:
  TexelProbe(const std::array<DirectLight, 2>& sets, std::size_t texel, int layer) {
    for (std::size_t i = 0; i < kCells; ++i) {
      const TexelCell at{kProbeSide, kProbeSide, static_cast<int>(i) % kProbeSide,
                         static_cast<int>(i) / kProbeSide};
      for (std::size_t set = 0; set < sets.size(); ++set) {
        const CellLight cell = sets[set].at(texel, layer, at);
        light_[set][i] = cell.surface ? core::luminance(cell.light.irradiance) : std::nan("");
      }
    }
  }

  /// Mean square of second differences along columns (stride 1) or rows (kProbeSide).
  double steps(std::size_t stride) const {
    return mean(
        stride,
        [&](std::size_t at, std::size_t set) {
          return light_[set][at] - 2 * light_[set][at + stride] + light_[set][at + 2 * stride];
        },
        3);
  }

  /// Mean square of a constant's error across the texel where light rises evenly.
  double slope(std::size_t stride) const {
    constexpr double kTexel = static_cast<double>(kProbeSide) / (kProbeSide - 1);
    return kTexel * kTexel / 12 *
           mean(
               stride,
               [&](std::size_t at, std::size_t set) {
                 return light_[set][at + (kProbeSide - 1) * stride] - light_[set][at];
               },
               kProbeSide);
  }

 private:
  static constexpr std::size_t kCells = std::size_t{kProbeSide} * kProbeSide;

  /// Of products of both sets' differences between `cells` cells in line; never negative.
  template <class Difference>
  double mean(std::size_t stride, Difference&& difference, std::size_t cells) const {
    const std::size_t across = stride == 1 ? kProbeSide : 1;
    double sum = 0;
    int count = 0;
    for (std::size_t line = 0; line < kProbeSide; ++line) {
      for (std::size_t i = 0; i + cells <= kProbeSide; ++i) {
        const std::size_t at = line * across + i * stride;
        const double product = difference(at, 0) * difference(at, 1);
        if (std::isnan(product)) continue;
        sum += product;
        ++count;
      }
    }
    return count > 0 ? std::max(0.0, sum / count) : 0;
  }

  std::array<std::array<double, kCells>, 2> light_{};  ///< luminance by cell; NaN: no surface
};

/// Of one set of a probe.
DirectOptions probing(DirectOptions options, std::uint32_t set) {
  options.samples = kProbeSamples;
  options.refinement = 1;
  options.wholePoints = 1;
  options.alike = true;
  options.seed = core::hashKey(kProbeStream, set, 0, options.seed);
  return options;
}

class Prober {
 public:
  Prober(const World& world, const TexelMap& texels, const OpenArea& open, std::span<const LayerLight> layers,
         const DetailGoal& goal, const DirectOptions& options)
      : texels_(texels),
        layers_(layers),
        sets_{DirectLight(world, texels, open, probing(options, 0)),
              DirectLight(world, texels, open, probing(options, 1))} {
    const double error = kWorthProbing * goal.relativeError * meanLight(texels, layers).irradiance;
    limit_ = error * error / kMissed;
    for (const LayerLight& layer : layers) neighbours_.emplace_back(texels, layer);
  }

  EdgeProbe at(std::size_t texel) const {
    EdgeProbe out;
    for (std::size_t l = 0; l < layers_.size(); ++l) {
      const Neighbourhood& around = neighbours_[l];
      if (!isLit(texel, l)) continue;
      const ChartRect& chart = chartOf(texel);
      const bool narrowU = chart.x1 - chart.x0 == 1, narrowV = chart.y1 - chart.y0 == 1;
      const bool narrow = std::min(chart.x1 - chart.x0, chart.y1 - chart.y0) < 3;
      if (!narrow && !around.steps(texel, limit_)) continue;
      const float area = texels_.area(texel);
      out.besideU += static_cast<float>(area * kMissed * around.along(texel, 1));
      out.besideV += static_cast<float>(area * kMissed * around.along(texel, texels_.size()));
      const double open = layers_[l].open[texel];
      if (!(open > 0)) continue;
      const TexelProbe probe(sets_, texel, static_cast<int>(l));
      out.stepU += static_cast<float>(open * kMissed * kProbeSide * probe.steps(1));
      out.stepV += static_cast<float>(open * kMissed * kProbeSide * probe.steps(kProbeSide));
      if (narrowU) out.besideU += static_cast<float>(open * probe.slope(1));
      if (narrowV) out.besideV += static_cast<float>(open * probe.slope(kProbeSide));
    }
    return out;
  }

 private:
  const ChartRect& chartOf(std::size_t texel) const {
    return texels_.charts()[static_cast<std::size_t>(texels_.chartOf(texel))];
  }
  /// Backs of single-sided charts are not. Vertices have no cells.
  bool isLit(std::size_t texel, std::size_t layer) const {
    const ChartRect& chart = chartOf(texel);
    return texels_.area(texel) > 0 && (layer == 0 || chart.doubleSided) && !chart.byVertex;
  }

  const TexelMap& texels_;
  std::span<const LayerLight> layers_;
  std::array<DirectLight, 2> sets_;
  std::vector<Neighbourhood> neighbours_;
  double limit_;
};

/// Times 2^-n, exactly.
double halved(double value, int n) { return value * (1.0 / (1 << n)); }

std::size_t texelsOf(int log2Columns, int log2Rows) {
  if (log2Columns == 0 && log2Rows == 0) return 0;
  return core::MapBlock{0, 0, log2Columns, log2Rows}.texels();
}

double missedBy(const EdgeProbe& p, int log2Columns, int log2Rows) {
  return halved(p.stepU, log2Columns) + halved(p.stepV, log2Rows) + (log2Columns == 0 ? p.besideU : 0) +
         (log2Rows == 0 ? p.besideV : 0);
}

/// What blocks of all sizes cost at one price of a texel.
class PriceList {
 public:
  PriceList(double price, int most) : most_(most) {
    for (int columns = 0; columns <= most; ++columns) {
      for (int rows = 0; rows <= most; ++rows)
        cost_[columns][rows] = price * static_cast<double>(texelsOf(columns, rows));
    }
  }

  /// The sides at which error and cost are least together (Lagrange).
  core::MapBlock cheapest(const EdgeProbe& p) const {
    core::MapBlock best;
    double least = missedBy(p, 0, 0);
    // Larger blocks cost more, whatever they save: most texels are done after a few sizes.
    for (int columns = 0; columns <= most_ && (columns == 0 || cost_[columns][0] < least); ++columns) {
      for (int rows = columns == 0 ? 1 : 0; rows <= most_ && cost_[columns][rows] < least; ++rows) {
        const double sum = missedBy(p, columns, rows) + cost_[columns][rows];
        if (sum >= least) continue;
        least = sum;
        best.log2Columns = columns;
        best.log2Rows = rows;
      }
    }
    return best;
  }

 private:
  int most_;
  std::array<std::array<double, kMostLog2 + 1>, kMostLog2 + 1> cost_{};
};

class Planner {
 public:
  Planner(const TexelMap& texels, std::span<const LayerLight> layers, std::span<const EdgeProbe> probes,
          const DetailGoal& goal)
      : texels_(texels), goal_(goal), mean_(meanLight(texels, layers)) {
    while (most_ < kMostLog2 && (2 << most_) + 2 <= texels.size()) ++most_;
    for (std::size_t t = 0; t < probes.size(); ++t) {
      const EdgeProbe probe = pooled(probes, t);
      if (missedBy(probe, 0, 0) > 0) candidates_.push_back({static_cast<std::uint32_t>(t), probe});
    }
  }

  std::vector<DetailTexel> choose() const {
    std::vector<DetailTexel> out;
    if (candidates_.empty() || !(mean_.irradiance > 0)) return out;
    const PriceList prices(choosePrice(), most_);
    for (const Candidate& c : candidates_) {
      const core::MapBlock block = prices.cheapest(c.probe);
      if (texelsOf(block.log2Columns, block.log2Rows) > 0) out.push_back({c.texel, block});
    }
    return out;
  }

 private:
  struct Candidate {
    std::uint32_t texel;
    EdgeProbe probe;
  };
  /// Probes are noisy, edges run on: half a texel's own, half the mean of the 3 x 3 around.
  EdgeProbe pooled(std::span<const EdgeProbe> probes, std::size_t texel) const {
    const auto size = static_cast<std::ptrdiff_t>(texels_.size());
    EdgeProbe sum, out = probes[texel];
    float count = 0;
    if (texels_.chartOf(texel) < 0) return out;
    for (const std::ptrdiff_t row : {-size, std::ptrdiff_t{0}, size}) {
      for (const std::ptrdiff_t column : {-1, 0, 1}) {
        const auto near = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(texel) + row + column);
        if (near >= probes.size() || texels_.chartOf(near) != texels_.chartOf(texel)) continue;
        sum.stepU += probes[near].stepU;
        sum.stepV += probes[near].stepV;
        ++count;
      }
    }
    out.stepU = 0.5f * (out.stepU + sum.stepU / count);
    out.stepV = 0.5f * (out.stepV + sum.stepV / count);
    return out;
  }

  struct Outcome {
    double relativeError = 0;
    std::size_t texels = 0;
  };

  Outcome at(double price) const {
    Outcome out;
    double missed = 0;
    const PriceList prices(price, most_);
    for (const Candidate& c : candidates_) {
      const core::MapBlock block = prices.cheapest(c.probe);
      missed += missedBy(c.probe, block.log2Columns, block.log2Rows);
      out.texels += texelsOf(block.log2Columns, block.log2Rows);
    }
    out.relativeError = std::sqrt(missed / mean_.area) / mean_.irradiance;
    return out;
  }

  /// The highest price of a texel at which the wished error is reached; a higher one where that takes too
  /// many.
  double choosePrice() const {
    constexpr int kBisections = 24;
    double low = -60, high = 2;  // logarithms, of the largest error
    double largest = 0;
    for (const Candidate& c : candidates_) largest = std::max(largest, missedBy(c.probe, 0, 0));
    const auto priceOf = [&](double logarithm) { return largest * std::exp2(logarithm); };
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (low + high);
      const Outcome outcome = at(priceOf(middle));
      const bool tooLow = outcome.texels > goal_.mostTexels || outcome.relativeError <= goal_.relativeError;
      (tooLow ? low : high) = middle;
    }
    return priceOf(high);
  }

  const TexelMap& texels_;
  DetailGoal goal_;
  MeanLight mean_;
  int most_ = 0;
  std::vector<Candidate> candidates_;
};

}  // namespace

std::size_t probeEdges(const World& world, const TexelMap& texels, const OpenArea& open,
                       std::span<const LayerLight> layers, const DetailGoal& goal,
                       const DirectOptions& options, BlockRange blocks, const core::Progress& progress,
                       std::span<EdgeProbe> out) {
  const Prober prober(world, texels, open, layers, goal, options);
  return parallelTexels(options.threads, blocks, texels.texelCount(), progress, [&](std::size_t texel) {
    const std::int32_t chart = texels.chartOf(texel);
    if (chart < 0 || (options.keptCharts && (*options.keptCharts)[static_cast<std::size_t>(chart)])) return;
    out[texel] = prober.at(texel);
  });
}

std::vector<DetailTexel> planDetail(const TexelMap& texels, std::span<const LayerLight> layers,
                                    std::span<const EdgeProbe> probes, const DetailGoal& goal) {
  return Planner(texels, layers, probes, goal).choose();
}

}  // namespace saccade::raytrace
