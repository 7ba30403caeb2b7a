// Illumination maps as rays read them: tiles of one cache line, decoded by F16C.
#include <immintrin.h>

#include <algorithm>

#include "raytrace/world.h"

namespace saccade::raytrace {
namespace {

constexpr int kBlockShift = 48;  // above a texel's RGB
constexpr float kBelowOne = 0x1.fffffep-1f;

unsigned tiles(int size, unsigned tile) { return (static_cast<unsigned>(size) + tile - 1) / tile; }

/// Between columns x0, x1 and rows y0, y1 of the tiled order.
MapFootprint footprintOf(std::uint32_t x0, std::uint32_t x1, std::uint32_t y0, std::uint32_t y1, float right,
                         float down) {
  return {{x0 + y0, x1 + y0, x0 + y1, x1 + y1}, right, down, false};
}

}  // namespace

void World::setMaps(const core::IlluminationMaps* maps) {
  mapTexels_.clear();
  mapBlocks_.clear();
  if (!maps) return;
  mapWidth_ = maps->width;
  mapHeight_ = maps->height;
  mapLayers_ = maps->layers;
  mapTilesAcross_ = tiles(mapWidth_, kMapTileX);
  const unsigned atlasTiles = tiles(mapHeight_, kMapTileY);
  mapTilesDown_ = atlasTiles + tiles(maps->detail.height, kMapTileY);
  mapDetailRow_ = atlasTiles * kMapTileY;
  mapTexels_.resize(mapRow(0, mapLayers_));
  const auto rowsOf = [&](const std::vector<std::uint16_t>& texels, int rows, int layer) {
    return texels.data() + std::size_t{3} * mapWidth_ * rows * layer;
  };
  for (int layer = 0; layer < mapLayers_; ++layer) {
    copyMapRows(rowsOf(maps->texels, mapHeight_, layer), mapHeight_, 0, layer);
    copyMapRows(rowsOf(maps->detail.texels, maps->detail.height, layer), maps->detail.height, mapDetailRow_,
                layer);
  }
  if (!maps->detail.empty()) copyMapBlocks(*maps);
}

void World::copyMapRows(const std::uint16_t* from, int rows, unsigned firstRow, int layer) {
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < mapWidth_; ++x, from += 3) {
      mapTexels_[mapColumn(x) + mapRow(firstRow + y, layer)] = static_cast<std::uint64_t>(from[0]) |
                                                               static_cast<std::uint64_t>(from[1]) << 16 |
                                                               static_cast<std::uint64_t>(from[2]) << 32;
    }
  }
}

void World::copyMapBlocks(const core::IlluminationMaps& maps) {
  mapBlocks_.resize(mapRow(mapDetailRow_, 0));
  const std::uint32_t* block = maps.detail.blocks.data();
  for (int y = 0; y < mapHeight_; ++y) {
    for (int x = 0; x < mapWidth_; ++x, ++block) {
      if (*block == 0) continue;
      mapBlocks_[mapColumn(x) + mapRow(y, 0)] = *block;
      for (int layer = 0; layer < mapLayers_; ++layer)
        mapTexels_[mapColumn(x) + mapRow(y, layer)] |= std::uint64_t{1} << kBlockShift;
    }
  }
}

/// A texel's place in the tiled order is the sum of its column's and its row's.
std::uint32_t World::mapColumn(unsigned x) { return x / kMapTileX * (kMapTileX * kMapTileY) + x % kMapTileX; }
std::uint32_t World::mapRow(unsigned y, int layer) const {
  const unsigned tileRow = static_cast<unsigned>(layer) * mapTilesDown_ + y / kMapTileY;
  return tileRow * mapTilesAcross_ * (kMapTileX * kMapTileY) + y % kMapTileY * kMapTileX;
}

MapFootprint World::mapFootprint(const Vec2& uv, int layer) const {
  if (layer >= mapLayers_ || mapTexels_.empty()) return {};
  // From the middle of the first texel, clamped to the atlas. Written so that NaN gives its edge.
  const auto inside = [](float v, int size) {
    const float last = static_cast<float>(size) * kBelowOne - 0.5f;
    const float x = v * static_cast<float>(size) - 0.5f;
    return x > -0.5f ? (x < last ? x : last) : -0.5f;
  };
  const float x = inside(uv.x, mapWidth_), y = inside(uv.y, mapHeight_);
  const unsigned left = x > 0 ? static_cast<unsigned>(x) : 0, top = y > 0 ? static_cast<unsigned>(y) : 0;
  const std::uint32_t x0 = mapColumn(left);
  const std::uint32_t x1 = left + 1 < static_cast<unsigned>(mapWidth_) ? mapColumn(left + 1) : x0;
  const std::uint32_t y0 = mapRow(top, layer);
  const std::uint32_t y1 = top + 1 < static_cast<unsigned>(mapHeight_) ? mapRow(top + 1, layer) : y0;
  return footprintOf(x0, x1, y0, y1, x - static_cast<float>(left), y - static_cast<float>(top));
}

/// The cells around the same point in the block of the texel that it lies in.
MapFootprint World::blockFootprint(const MapFootprint& f, std::uint32_t texel) const {
  const std::uint32_t layerSize = mapRow(0, 1);
  const int layer = texel < layerSize ? 0 : 1;
  const auto block = core::MapBlock::unpack(mapBlocks_[texel - (layer == 0 ? 0 : layerSize)]);
  const auto within = [](float right) { return right < 0.5f ? right + 0.5f : right - 0.5f; };
  const float x = static_cast<float>(block.x) + within(f.right) * static_cast<float>(block.columns()) - 0.5f;
  const float y = static_cast<float>(block.y) + within(f.down) * static_cast<float>(block.rows()) - 0.5f;
  const auto left = static_cast<unsigned>(x), top = static_cast<unsigned>(y);
  const std::uint32_t x0 = mapColumn(left), x1 = mapColumn(left + 1);
  const std::uint32_t y0 = mapRow(mapDetailRow_ + top, layer), y1 = mapRow(mapDetailRow_ + top + 1, layer);
  return footprintOf(x0, x1, y0, y1, x - static_cast<float>(left), y - static_cast<float>(top));
}

Vec2 World::cornerUv(std::uint32_t object, std::uint32_t triangle, int corner) const {
  const Vec2& uv = records_[triangle].lightmapUv[corner];
  const Instance* place = instanceOf(object);
  return place ? place->lightmapUv(uv) : uv;
}

/// Of a texel's centre.
std::uint32_t World::mapTexelAt(const Vec2& uv, int layer) const {
  const auto inside = [](float v, int size) {
    const float x = v * static_cast<float>(size), last = static_cast<float>(size - 1);
    return static_cast<unsigned>(x > 0 ? (x < last ? x : last) : 0.0f);
  };
  return mapColumn(inside(uv.x, mapWidth_)) + mapRow(inside(uv.y, mapHeight_), layer);
}

MapFootprint World::mapFootprint(std::uint32_t object, std::uint32_t triangle, float u, float v,
                                 int layer) const {
  if (!vertexLit(object)) return mapFootprint(lightmapUv(object, triangle, u, v), layer);
  MapFootprint f;
  if (layer >= mapLayers_ || mapTexels_.empty()) return f;
  // The bilinear form with its lower two texels the same: (1 - v) ((1 - r) a + r b) + v c.
  for (int k = 0; k < 3; ++k) f.at[k] = mapTexelAt(cornerUv(object, triangle, k), layer);
  f.at[3] = f.at[2];
  f.right = v < 1 ? std::min(u / (1 - v), 1.0f) : 0.0f;
  f.down = v;
  f.dark = false;
  return f;
}

Vec2 World::lightmapUv(std::uint32_t object, std::uint32_t triangle, float u, float v) const {
  const float w = 1 - u - v;
  if (vertexLit(object)) return cornerUv(object, triangle, u > v ? (u > w ? 1 : 0) : (v > w ? 2 : 0));
  const auto& corner = records_[triangle].lightmapUv;
  const Vec2 uv = corner[0] * w + corner[1] * u + corner[2] * v;
  const Instance* place = instanceOf(object);
  return place ? place->lightmapUv(uv) : uv;
}

Vec3 World::irradiance(const MapFootprint& f) const {
  if (f.dark) return Vec3(0);
  if (!mapBlocks_.empty()) {
    const std::uint32_t texel = f.at[(f.right < 0.5f ? 0 : 1) + (f.down < 0.5f ? 0 : 2)];
    if (mapTexels_[texel] >> kBlockShift) return mixMap(blockFootprint(f, texel));
  }
  return mixMap(f);
}

Vec3 World::mixMap(const MapFootprint& f) const {
  const auto texel = [&](std::uint32_t at) {
    return _mm_cvtph_ps(_mm_cvtsi64_si128(static_cast<long long>(mapTexels_[at])));
  };
  const auto between = [](__m128 a, __m128 b, __m128 share) {
    return _mm_add_ps(a, _mm_mul_ps(share, _mm_sub_ps(b, a)));
  };
  const __m128 right = _mm_set1_ps(std::max(f.right, 0.0f));
  const __m128 upper = between(texel(f.at[0]), texel(f.at[1]), right);
  const __m128 lower = between(texel(f.at[2]), texel(f.at[3]), right);
  alignas(16) float out[4];
  _mm_store_ps(out, between(upper, lower, _mm_set1_ps(std::max(f.down, 0.0f))));
  return {out[0], out[1], out[2]};
}

}  // namespace saccade::raytrace
