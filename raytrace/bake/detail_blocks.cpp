#include "raytrace/bake/detail_blocks.h"

#include <algorithm>
#include <array>
#include <string>

#include "core/error.h"
#include "core/math/bilinear.h"
#include "raytrace/bake/map_half.h"

namespace saccade::raytrace {
namespace {

constexpr std::uint32_t kNoBlock = ~0u;

/// With their places in the earlier maps.
std::vector<DetailTexel> keptBlocks(const TexelMap& texels, const KeptCharts& kept) {
  const core::IlluminationMaps& before = *kept.previous;
  std::vector<DetailTexel> out;
  if (before.detail.height == 0) return out;
  const auto size = static_cast<std::size_t>(texels.size()), width = static_cast<std::size_t>(before.width);
  for (std::size_t t = 0; t < texels.texelCount(); ++t) {
    const std::int32_t chart = texels.chartOf(t);
    if (chart < 0 || !kept.keep[static_cast<std::size_t>(chart)]) continue;
    const std::uint32_t packed = before.detail.blocks[t / size * width + t % size];
    if (packed != 0) out.push_back({static_cast<std::uint32_t>(t), core::MapBlock::unpack(packed)});
  }
  return out;
}

}  // namespace

const Vec3& CellBlock::nearest(int x, int y) const {
  return at(std::clamp(x, 0, columns_ - 1), std::clamp(y, 0, rows_ - 1));
}

Vec3 CellBlock::between(const Plane2& place) const {
  const Plane2 p =
      glm::clamp(place * Plane2(columns_, rows_) - 0.5, Plane2(0), Plane2(columns_ - 1, rows_ - 1));
  return core::bilinear(p.x, p.y, [this](int x, int y) { return nearest(x, y); });
}

Vec3 CellBlock::beyond(int x, int y) const {
  const int cx = std::clamp(x, 0, columns_ - 1), cy = std::clamp(y, 0, rows_ - 1);
  const Vec3 near = at(cx, cy), further = nearest(2 * cx - x, 2 * cy - y);
  return glm::clamp(2.0f * near - further, 0.5f * near, 2.0f * near);
}

void CellBlock::fill(std::vector<char> filled) {
  const auto number = [this](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
  };
  for (bool grown = true; grown;) {
    grown = false;
    const std::vector<char> before = filled;
    for (int y = 0; y < rows_; ++y) {
      for (int x = 0; x < columns_; ++x) {
        if (before[number(x, y)]) continue;
        Vec3 sum(0);
        int count = 0;
        for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, rows_ - 1); ++ny) {
          for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, columns_ - 1); ++nx) {
            if (!before[number(nx, ny)]) continue;
            sum += at(nx, ny);
            ++count;
          }
        }
        if (count == 0) continue;
        at(x, y) = sum / static_cast<float>(count);
        filled[number(x, y)] = 1;
        grown = true;
      }
    }
  }
}

Vec3 betweenTexels(std::span<const Vec3> values, int size, const Plane2& position) {
  const Plane2 p = glm::clamp(position - 0.5, Plane2(0), Plane2(size - 1));
  return core::bilinear(p.x, p.y, [&](int column, int row) {
    return values[static_cast<std::size_t>(std::min(row, size - 1)) * static_cast<std::size_t>(size) +
                  static_cast<std::size_t>(std::min(column, size - 1))];
  });
}

std::size_t keptBlockTexels(const TexelMap& texels, const KeptCharts& kept) {
  std::size_t sum = 0;
  for (const DetailTexel& t : keptBlocks(texels, kept)) sum += t.block.texels();
  return sum;
}

DetailAtlas::DetailAtlas(const TexelMap& texels, std::vector<DetailTexel> own, const KeptCharts* kept)
    : texels_(texels),
      kept_(kept),
      places_(std::move(own)),
      ownCount_(places_.size()),
      numbers_(texels.texelCount(), kNoBlock) {
  for (std::size_t b = 0; b < ownCount_; ++b) numbers_[places_[b].texel] = static_cast<std::uint32_t>(b);
  if (kept) {
    for (const DetailTexel& t : keptBlocks(texels, *kept)) {
      places_.push_back(t);
      before_.push_back(t.block);
    }
  }
  if (places_.empty()) return;
  pack();
  out_.blocks.resize(texels.texelCount());
  for (const DetailTexel& t : places_) {
    blocks_.emplace_back(t.block);
    out_.blocks[t.texel] = t.block.packed();
  }
}

/// Rows of blocks of one size, the highest first.
void DetailAtlas::pack() {
  constexpr std::size_t kSides = core::MapBlock::kMostLog2 + 1;
  std::array<std::vector<core::MapBlock*>, kSides * kSides> bySize;
  for (DetailTexel& t : places_)
    bySize[static_cast<std::size_t>(t.block.log2Rows) * kSides +
           static_cast<std::size_t>(t.block.log2Columns)]
        .push_back(&t.block);
  int left = 0, top = 0, height = 0;
  for (std::size_t s = bySize.size(); s-- > 0;) {
    for (core::MapBlock* block : bySize[s]) {
      if (left + block->columns() + 2 > texels_.size() || block->rows() + 2 != height) {
        top += height;
        left = 0;
        height = block->rows() + 2;
      }
      block->x = left + 1;
      block->y = top + 1;
      left += block->columns() + 2;
    }
  }
  out_.height = top + height;
  if (out_.height > core::MapBlock::kLargestCoordinate)
    throw core::Error("illumination maps: edges of light take " + std::to_string(out_.height) +
                      " rows of finer texels; allow less with --maps-mb");
}

void DetailAtlas::addLayer(std::span<const Vec3> irradiance, int layer) {
  if (blocks_.empty()) return;
  const std::size_t plane =
      3 * static_cast<std::size_t>(texels_.size()) * static_cast<std::size_t>(out_.height);
  out_.texels.resize(plane * static_cast<std::size_t>(layer + 1));
  for (std::size_t b = 0; b < ownCount_; ++b) addBorder(b, irradiance);
  for (std::size_t b = ownCount_; b < blocks_.size(); ++b) readKept(b, layer);
  for (std::size_t b = 0; b < blocks_.size(); ++b) store(b, layer);
}

void DetailAtlas::readKept(std::size_t b, int layer) {
  const core::IlluminationMaps& before = *kept_->previous;
  if (layer >= before.layers) return;
  const core::MapBlock& from = before_[b - ownCount_];
  for (int y = -1; y <= from.rows(); ++y) {
    for (int x = -1; x <= from.columns(); ++x) {
      const int row = layer * before.detail.height + from.y + y;
      const std::uint16_t* half =
          &before.detail.texels[3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(before.width) +
                                     static_cast<std::size_t>(from.x + x))];
      blocks_[b].at(x, y) = {core::fromHalf(half[0]), core::fromHalf(half[1]), core::fromHalf(half[2])};
    }
  }
}

/// At a place beside the texel, in texels from its corner; none where its chart has no surface.
std::optional<Vec3> DetailAtlas::lightBeside(std::size_t texel, const Plane2& place,
                                             std::span<const Vec3> irradiance) const {
  const Plane2 position = texels_.cornerOf(texel) + place;
  const double size = texels_.size();
  if (!(position.x >= 0 && position.x < size && position.y >= 0 && position.y < size)) return std::nullopt;
  const Plane2 corner = glm::floor(position);
  const auto beside = static_cast<std::size_t>(corner.y * size + corner.x);
  if (texels_.chartOf(beside) != texels_.chartOf(texel)) return std::nullopt;
  if (numbers_[beside] != kNoBlock) return blocks_[numbers_[beside]].between(position - corner);
  return betweenTexels(irradiance, texels_.size(), position);
}

void DetailAtlas::addBorder(std::size_t b, std::span<const Vec3> irradiance) {
  CellBlock& block = blocks_[b];
  const int columns = block.columns(), rows = block.rows();
  for (int y = -1; y <= rows; ++y) {
    for (int x = -1; x <= columns; x += y == -1 || y == rows ? 1 : columns + 1) {
      const Plane2 place = (Plane2(x, y) + 0.5) / Plane2(columns, rows);
      const std::optional<Vec3> light = lightBeside(places_[b].texel, place, irradiance);
      block.at(x, y) = light ? *light : block.beyond(x, y);
    }
  }
}

void DetailAtlas::store(std::size_t b, int layer) {
  const CellBlock& block = blocks_[b];
  const core::MapBlock& where = places_[b].block;
  for (int y = -1; y <= block.rows(); ++y) {
    const int row = layer * out_.height + where.y + y;
    std::uint16_t* out =
        &out_.texels[3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(texels_.size()) +
                          static_cast<std::size_t>(where.x - 1))];
    for (int x = -1; x <= block.columns(); ++x) {
      for (int c = 0; c < 3; ++c) *out++ = mapHalf(block.at(x, y)[c]);
    }
  }
}

}  // namespace saccade::raytrace
