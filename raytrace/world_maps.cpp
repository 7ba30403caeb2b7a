// Illumination maps as rays read them: tiles of one cache line, decoded by F16C.
#include <immintrin.h>

#include "raytrace/world.h"

namespace saccade::raytrace {

void World::setMaps(const core::IlluminationMaps* maps) {
  mapTexels_.clear();
  if (!maps) return;
  mapWidth_ = maps->width;
  mapHeight_ = maps->height;
  mapLayers_ = maps->layers;
  mapTilesAcross_ = (mapWidth_ + kMapTileX - 1) / kMapTileX;
  mapTilesDown_ = (mapHeight_ + kMapTileY - 1) / kMapTileY;
  mapTexels_.resize(static_cast<std::size_t>(mapTilesAcross_) * mapTilesDown_ * mapLayers_ * kMapTileX *
                    kMapTileY);
  const std::uint16_t* in = maps->texels.data();
  for (int layer = 0; layer < mapLayers_; ++layer) {
    for (int y = 0; y < mapHeight_; ++y) {
      for (int x = 0; x < mapWidth_; ++x, in += 3) {
        mapTexels_[mapIndex(x, y, layer)] = static_cast<std::uint64_t>(in[0]) |
                                            static_cast<std::uint64_t>(in[1]) << 16 |
                                            static_cast<std::uint64_t>(in[2]) << 32;
      }
    }
  }
}

std::size_t World::mapIndex(int x, int y, int layer) const {
  const std::size_t row = static_cast<std::size_t>(layer) * mapTilesDown_ + y / kMapTileY;
  return ((row * mapTilesAcross_ + x / kMapTileX) * kMapTileY + y % kMapTileY) * kMapTileX + x % kMapTileX;
}

Vec3 World::irradiance(const Vec2& uv, int layer) const {
  if (layer >= mapLayers_ || mapTexels_.empty()) return Vec3(0);
  // Written so that NaN gives 0.
  const auto inside = [](float v, int size) {
    const float last = static_cast<float>(size - 1);
    const float x = v * static_cast<float>(size) - 0.5f;
    return x > 0 ? (x < last ? x : last) : 0.0f;
  };
  const float x = inside(uv.x, mapWidth_), y = inside(uv.y, mapHeight_);
  const auto x0 = static_cast<unsigned>(x), y0 = static_cast<unsigned>(y);
  const unsigned x1 = x0 + 1 < static_cast<unsigned>(mapWidth_) ? x0 + 1 : x0;
  const unsigned y1 = y0 + 1 < static_cast<unsigned>(mapHeight_) ? y0 + 1 : y0;
  const auto texel = [&](unsigned column, unsigned row) {
    const std::uint64_t bits = mapTexels_[mapIndex(static_cast<int>(column), static_cast<int>(row), layer)];
    return _mm_cvtph_ps(_mm_cvtsi64_si128(static_cast<long long>(bits)));
  };
  const __m128 fx = _mm_set1_ps(x - static_cast<float>(x0)), fy = _mm_set1_ps(y - static_cast<float>(y0));
  const auto mix = [](__m128 a, __m128 b, __m128 f) {
    return _mm_add_ps(a, _mm_mul_ps(f, _mm_sub_ps(b, a)));
  };
  const __m128 sum = mix(mix(texel(x0, y0), texel(x1, y0), fx), mix(texel(x0, y1), texel(x1, y1), fx), fy);
  alignas(16) float out[4];
  _mm_store_ps(out, sum);
  return {out[0], out[1], out[2]};
}

}  // namespace saccade::raytrace
