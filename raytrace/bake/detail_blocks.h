// Blocks of finer texels (core::MapDetail) on their way into a bake's maps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/map_detail.h"
#include "raytrace/bake/detail_plan.h"
#include "raytrace/bake/kept.h"
#include "raytrace/bake/texel_map.h"

namespace saccade::raytrace {

/// Cells and a border of one around them, W/m^2.
class CellBlock {
 public:
  explicit CellBlock(const core::MapBlock& block)
      : columns_(block.columns()),
        rows_(block.rows()),
        values_(static_cast<std::size_t>(columns_ + 2) * static_cast<std::size_t>(rows_ + 2)) {}

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// x in [-1, columns], y in [-1, rows].
  Vec3& at(int x, int y) { return values_[index(x, y)]; }
  const Vec3& at(int x, int y) const { return values_[index(x, y)]; }
  /// Bilinear between cells, level beyond the outer ones; `place` in [0, 1]^2.
  Vec3 between(const Plane2& place) const;
  /// What a border cell would hold if light went on evenly.
  Vec3 beyond(int x, int y) const;
  /// Gives cells that are not `filled` (by cell, row by row) the mean of their neighbours, ring by ring.
  void fill(std::vector<char> filled);

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(columns_ + 2) +
           static_cast<std::size_t>(x + 1);
  }
  const Vec3& nearest(int x, int y) const;

  int columns_, rows_;
  std::vector<Vec3> values_;
};

/// Bilinear between the texels of a square atlas at a position in texels.
Vec3 betweenTexels(std::span<const Vec3> values, int size, const Plane2& position);

/// Of the blocks that charts keep, borders included.
std::size_t keptBlockTexels(const TexelMap& texels, const KeptCharts& kept);

/// All blocks of a bake, layer after layer: fill block(), then addLayer().
class DetailAtlas {
 public:
  /// `own`: texels whose blocks are filled here. `kept` (null: none): the charts that keep the blocks of
  /// earlier maps. What they refer to must outlive it. Throws core::Error when the blocks would be higher
  /// than 2^13 rows.
  DetailAtlas(const TexelMap& texels, std::vector<DetailTexel> own, const KeptCharts* kept);

  CellBlock& block(std::size_t own) { return blocks_[own]; }
  /// Adds borders, by the blocks and the texels (`irradiance`) around, and stores the layer.
  void addLayer(std::span<const Vec3> irradiance, int layer);
  core::MapDetail take() { return std::move(out_); }

 private:
  std::optional<Vec3> lightBeside(std::size_t texel, const Plane2& place,
                                  std::span<const Vec3> irradiance) const;
  void pack();
  void readKept(std::size_t b, int layer);
  void addBorder(std::size_t b, std::span<const Vec3> irradiance);
  void store(std::size_t b, int layer);

  const TexelMap& texels_;
  const KeptCharts* kept_;
  std::vector<DetailTexel> places_;  ///< own, then kept
  std::size_t ownCount_;
  std::vector<core::MapBlock> before_;  ///< of kept ones, in the earlier maps
  std::vector<std::uint32_t> numbers_;  ///< by texel: of its own block
  std::vector<CellBlock> blocks_;
  core::MapDetail out_;
};

}  // namespace saccade::raytrace
