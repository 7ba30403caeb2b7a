// Illumination maps as rays read them: tiles of one cache line, decoded by F16C.
#include <immintrin.h>

#include "raytrace/world.h"

namespace saccade::raytrace {

void World::setMaps(const core::IlluminationMaps* maps) {
  mapTexels_.clear();
  if (!maps) return;
  const auto tiles = [](int size, unsigned tile) { return static_cast<int>((size + tile - 1) / tile); };
  mapWidth_ = maps->width;
  mapHeight_ = maps->height;
  mapLayers_ = maps->layers;
  mapTilesAcross_ = tiles(mapWidth_, kMapTileX);
  mapTilesDown_ = tiles(mapHeight_, kMapTileY);
  mapTexels_.resize(static_cast<std::size_t>(mapTilesAcross_) * mapTilesDown_ * mapLayers_ * kMapTileX *
                    kMapTileY);
  const std::uint16_t* in = maps->texels.data();
  for (int layer = 0; layer < mapLayers_; ++layer) {
    for (int y = 0; y < mapHeight_; ++y) {
      for (int x = 0; x < mapWidth_; ++x, in += 3) {
        mapTexels_[mapColumn(x) + mapRow(y, layer)] = static_cast<std::uint64_t>(in[0]) |
                                                      static_cast<std::uint64_t>(in[1]) << 16 |
                                                      static_cast<std::uint64_t>(in[2]) << 32;
      }
    }
  }
}

/// A texel's place in the tiled order is the sum of its column's and its row's.
std::uint32_t World::mapColumn(unsigned x) { return x / kMapTileX * (kMapTileX * kMapTileY) + x % kMapTileX; }
std::uint32_t World::mapRow(unsigned y, int layer) const {
  const unsigned tileRow = static_cast<unsigned>(layer * mapTilesDown_) + y / kMapTileY;
  return tileRow * static_cast<unsigned>(mapTilesAcross_) * (kMapTileX * kMapTileY) +
         y % kMapTileY * kMapTileX;
}

MapFootprint World::mapFootprint(const Vec2& uv, int layer) const {
  MapFootprint f;
  if (layer >= mapLayers_ || mapTexels_.empty()) return f;
  // Written so that NaN gives 0.
  const auto inside = [](float v, int size) {
    const float last = static_cast<float>(size - 1);
    const float x = v * static_cast<float>(size) - 0.5f;
    return x > 0 ? (x < last ? x : last) : 0.0f;
  };
  const float x = inside(uv.x, mapWidth_), y = inside(uv.y, mapHeight_);
  const auto left = static_cast<unsigned>(x), top = static_cast<unsigned>(y);
  const std::uint32_t x0 = mapColumn(left);
  const std::uint32_t x1 = left + 1 < static_cast<unsigned>(mapWidth_) ? mapColumn(left + 1) : x0;
  const std::uint32_t y0 = mapRow(top, layer);
  const std::uint32_t y1 = top + 1 < static_cast<unsigned>(mapHeight_) ? mapRow(top + 1, layer) : y0;
  f.at[0] = x0 + y0;
  f.at[1] = x1 + y0;
  f.at[2] = x0 + y1;
  f.at[3] = x1 + y1;
  f.right = x - static_cast<float>(left);
  f.down = y - static_cast<float>(top);
  f.dark = false;
  return f;
}

Vec3 World::irradiance(const MapFootprint& f) const {
  if (f.dark) return Vec3(0);
  const auto texel = [&](std::uint32_t at) {
    return _mm_cvtph_ps(_mm_cvtsi64_si128(static_cast<long long>(mapTexels_[at])));
  };
  const auto between = [](__m128 a, __m128 b, __m128 share) {
    return _mm_add_ps(a, _mm_mul_ps(share, _mm_sub_ps(b, a)));
  };
  const __m128 right = _mm_set1_ps(f.right);
  const __m128 upper = between(texel(f.at[0]), texel(f.at[1]), right);
  const __m128 lower = between(texel(f.at[2]), texel(f.at[3]), right);
  alignas(16) float out[4];
  _mm_store_ps(out, between(upper, lower, _mm_set1_ps(f.down)));
  return {out[0], out[1], out[2]};
}

}  // namespace saccade::raytrace
