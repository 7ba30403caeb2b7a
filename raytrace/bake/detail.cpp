#include "raytrace/bake/detail.h"

#include <algorithm>
#include <cmath>

#include "raytrace/bake/detail_blocks.h"
#include "raytrace/parallel_rows.h"

namespace saccade::raytrace {
namespace {

/// In place of a cell's light: the cell holds no surface; something lies over all that it holds.
constexpr float kNoSurface = -1, kCovered = -2;
/// Cells are small: unshadowed light hardly differs within, and their noise counts little.
constexpr int kWholePoints = 4, kRefinement = 2;
constexpr int kNearRays = 16;
/// What is nearer than so many texel sides does not hide the same of all cells.
constexpr float kNearTexels = 2;

std::size_t cellCount(const core::MapBlock& block) {
  return static_cast<std::size_t>(block.columns()) * static_cast<std::size_t>(block.rows());
}

/// What surfaces that the texel cannot tell from one another do to indirect light within it.
class NearShare {
 public:
  explicit NearShare(std::span<const TracedCell> cells) {
    int count = 0;
    for (const TracedCell& cell : cells) {
      if (cell.direct.x < 0) continue;
      irradiance_ += cell.near.irradiance;
      open_ += cell.near.open;
      ++count;
    }
    if (count == 0) return;
    irradiance_ /= static_cast<float>(count);
    open_ /= static_cast<float>(count);
  }
  /// Of a cell; `indirect`: as the atlas has it there.
  Vec3 indirect(const NearLight& cell, const Vec3& indirect) const {
    if (!(open_ > 0)) return cell.irradiance;
    const Vec3 far = glm::max(indirect - irradiance_, Vec3(0)) / open_;
    return far * cell.open + cell.irradiance;
  }

 private:
  Vec3 irradiance_{0};
  float open_ = 0;
};

/// A block of one layer: its cells as traced, and what the atlas holds beside direct light.
void readCells(const TexelMap& texels, std::size_t texel, std::span<const TracedCell> cells,
               std::span<const Vec3> indirect, CellBlock& block) {
  const NearShare near(cells);
  std::vector<char> surface;
  for (int y = 0; y < block.rows(); ++y) {
    for (int x = 0; x < block.columns(); ++x) {
      const TracedCell& cell = cells[surface.size()];
      surface.push_back(cell.direct.x != kNoSurface);
      block.at(x, y) = Vec3(0);
      if (cell.direct.x < 0) continue;
      const Plane2 place = (Plane2(x, y) + 0.5) / Plane2(block.columns(), block.rows());
      const Vec3 around = betweenTexels(indirect, texels.size(), texels.cornerOf(texel) + place);
      block.at(x, y) = cell.direct + near.indirect(cell.near, around);
    }
  }
  block.fill(std::move(surface));
}

/// No more texels than rows of blocks of all sizes hold, in an atlas of this width.
DetailGoal packable(DetailGoal goal, int size) {
  constexpr double kFilled = 0.4;  // where the widest blocks leave almost half of each row
  const double most = kFilled * size * core::MapBlock::kLargestCoordinate;
  goal.mostTexels = static_cast<std::size_t>(std::min(static_cast<double>(goal.mostTexels), most));
  return goal;
}

}  // namespace

DetailLight::DetailLight(const World& world, const TexelMap& texels, const OpenArea& open, int layers,
                         const DetailGoal& goal)
    : world_(world),
      texels_(texels),
      open_(open),
      layers_(layers),
      goal_(packable(goal, texels.size())),
      probes_(goal_.mostTexels > 0 ? texels.texelCount() : 0),
      cells_(goal_.mostTexels * static_cast<std::size_t>(layers)) {}

std::size_t DetailLight::probe(std::span<const LayerLight> layers, const DirectOptions& options,
                               BlockRange blocks, const core::Progress& progress) {
  return probeEdges(world_, texels_, open_, layers, goal_, options, blocks, progress, probes_);
}

void DetailLight::plan(std::span<const LayerLight> layers, const KeptCharts* kept) {
  if (plan_) return;
  DetailGoal goal = goal_;
  if (kept) goal.mostTexels -= std::min(goal.mostTexels, keptBlockTexels(texels_, *kept));
  plan_ = planDetail(texels_, layers, probes_, goal);
  std::size_t next = 0;
  for (const DetailTexel& t : *plan_) {
    first_.push_back(next);
    next += cellCount(t.block) * static_cast<std::size_t>(layers_);
  }
}

std::uint64_t DetailLight::trace(std::uint64_t first, std::uint64_t last, const TexelLight& source,
                                 const DirectOptions& options, const core::Progress& progress) {
  DirectOptions ofCells = options;
  ofCells.wholePoints = kWholePoints;
  ofCells.refinement = kRefinement;
  const DirectLight light(world_, texels_, open_, ofCells);
  GatherOptions gather;
  gather.rays = kNearRays;
  gather.seed = options.seed;
  const auto traceCell = [&](std::size_t texel, const TexelCell& at, int layer) {
    const CellLight direct = light.at(texel, layer, at);
    if (!direct.open) return TracedCell{Vec3(direct.surface ? kCovered : kNoSurface), {}};
    const float reach = kNearTexels * std::sqrt(texels_.area(texel));
    return TracedCell{direct.light.irradiance,
                      nearLight(world_, texels_, texel, at, layer, reach, source, gather)};
  };
  const auto traceBlock = [&](std::size_t b) {
    const auto& [texel, block] = (*plan_)[b];
    TracedCell* out = &cells_[first_[b]];
    for (int layer = 0; layer < layers_; ++layer) {
      const bool lit = open_.areas(layer)[texel] > 0;
      for (int y = 0; y < block.rows(); ++y) {
        for (int x = 0; x < block.columns(); ++x)
          *out++ = lit ? traceCell(texel, {block.columns(), block.rows(), x, y}, layer)
                       : TracedCell{Vec3(kNoSurface), {}};
      }
    }
  };
  const BlockOrder order(kPieces);
  const std::size_t count = plan_->size();
  const int done =
      rowsUntilStopped(static_cast<int>(last - first), options.threads, progress, [&](int i, int) {
        const std::size_t piece = order.at(first + static_cast<std::size_t>(i));
        for (std::size_t b = count * piece / kPieces; b < count * (piece + 1) / kPieces; ++b) traceBlock(b);
      });
  return first + static_cast<std::uint64_t>(done);
}

core::MapDetail DetailLight::finish(std::span<const std::vector<Vec3>> indirect,
                                    std::span<const std::vector<Vec3>> irradiance, const KeptCharts* kept,
                                    const ImportedLight* imported) const {
  std::vector<DetailTexel> shown;
  std::vector<std::size_t> first;  // of their cells
  for (std::size_t b = 0; b < plan_->size(); ++b) {
    const DetailTexel& t = (*plan_)[b];
    if (imported && imported->imageOfObject[texels_.fragments(t.texel).front().object] >= 0) continue;
    shown.push_back(t);
    first.push_back(first_[b]);
  }
  DetailAtlas atlas(texels_, shown, kept);
  for (int l = 0; l < layers_; ++l) {
    const auto at = static_cast<std::size_t>(l);
    for (std::size_t b = 0; b < shown.size(); ++b) {
      const std::size_t count = cellCount(shown[b].block);
      readCells(texels_, shown[b].texel, {&cells_[first[b] + at * count], count}, indirect[at],
                atlas.block(b));
    }
    atlas.addLayer(irradiance[at], l);
  }
  return atlas.take();
}

}  // namespace saccade::raytrace
