#include "raytrace/texture_store.h"

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/image_io.h"
#include "core/scene/texture_transform.h"

namespace saccade::raytrace {
namespace {

constexpr unsigned kTile = 4;
constexpr unsigned kTexelsPerTile = kTile * kTile;

/// Byte to linear, for sRGB and for plain data.
struct DecodeTables {
  std::array<float, 256> srgb, plain;
  DecodeTables() {
    for (int i = 0; i < 256; ++i) {
      plain[i] = static_cast<float>(i) / 255.0f;
      srgb[i] = core::decodeSrgb(plain[i]);
    }
  }
};
const DecodeTables& decodeTables() {
  static const DecodeTables tables;
  return tables;
}

/// A texture coordinate brought into [0, 1] as the wrap mode says. Beyond +-1e6, where a float no longer
/// resolves texels, and for NaN: 0.
float wrapCoordinate(float u, core::Wrap wrap) {
  if (!(std::fabs(u) < 1e6f)) return 0;
  switch (wrap) {
    case core::Wrap::repeat:
      return u - std::floor(u);
    case core::Wrap::mirror: {
      const float twice = u - 2 * std::floor(0.5f * u);
      return twice > 1 ? 2 - twice : twice;
    }
    case core::Wrap::clamp:
      return std::clamp(u, 0.0f, 1.0f);
  }
  return 0;
}

/// Texel index of a position in [-1, size].
int wrapTexel(int i, int size, core::Wrap wrap) {
  if (static_cast<unsigned>(i) < static_cast<unsigned>(size)) return i;
  const bool below = i < 0;
  return (wrap == core::Wrap::repeat) == below ? size - 1 : 0;
}

/// A texel's place in the tiled order is the sum of its column's and its row's, both >= 0.
std::uint32_t tiledColumn(int x) {
  const auto column = static_cast<unsigned>(x);
  return column / kTile * kTexelsPerTile + column % kTile;
}
std::uint32_t tiledRow(int y, int tilesAcross) {
  const auto row = static_cast<unsigned>(y);
  return row / kTile * static_cast<unsigned>(tilesAcross) * kTexelsPerTile + row % kTile * kTile;
}

int tiles(int size) { return (size + static_cast<int>(kTile) - 1) / static_cast<int>(kTile); }

}  // namespace

TextureStore::TextureStore(const core::Scene& scene) {
  std::size_t total = 0;
  for (const core::Texture& t : scene.textures) {
    total += static_cast<std::size_t>(tiles(t.image.width())) * tiles(t.image.height()) * kTexelsPerTile;
  }
  texels_.resize(total);
  std::uint32_t* next = texels_.data();
  for (const core::Texture& t : scene.textures) {
    TextureView v;
    if (!t.image.empty()) {
      v.texels = next;
      v.decode = (t.srgb ? decodeTables().srgb : decodeTables().plain).data();
      v.width = t.image.width();
      v.height = t.image.height();
      v.tilesAcross = tiles(v.width);
      v.wrapS = t.wrapS;
      v.wrapT = t.wrapT;
      v.nearest = t.nearest;
      for (int y = 0; y < v.height; ++y) {
        for (int x = 0; x < v.width; ++x) {
          const core::Rgba8& p = t.image.at(x, y);
          next[tiledColumn(x) + tiledRow(y, v.tilesAcross)] = p.r | static_cast<std::uint32_t>(p.g) << 8 |
                                                              static_cast<std::uint32_t>(p.b) << 16 |
                                                              static_cast<std::uint32_t>(p.a) << 24;
        }
      }
      next += static_cast<std::size_t>(v.tilesAcross) * tiles(v.height) * kTexelsPerTile;
    }
    views_.push_back(v);
  }
}

TextureView TextureStore::view(const core::TextureSlot& slot) const {
  if (!slot) return {};
  TextureView v = views_[slot.texture];
  v.uvSet = static_cast<std::uint8_t>(slot.uvSet);
  v.transformed = slot.transformed();
  if (v.transformed) v.uvMatrix = core::uvMatrix(slot);
  return v;
}

TexelFootprint TextureView::footprint(const Vec2& meshUv) const {
  const Vec2 uv = place(meshUv);
  const float x = wrapCoordinate(uv.x, wrapS) * static_cast<float>(width);
  const float y = wrapCoordinate(uv.y, wrapT) * static_cast<float>(height);
  TexelFootprint f;
  if (nearest) {
    const std::uint32_t one =
        tiledColumn(wrapTexel(static_cast<int>(std::floor(x)), width, wrapS)) +
        tiledRow(wrapTexel(static_cast<int>(std::floor(y)), height, wrapT), tilesAcross);
    std::fill_n(f.at, 4, one);
    return f;
  }
  const float left = std::floor(x - 0.5f), top = std::floor(y - 0.5f);
  f.right = x - 0.5f - left;
  f.down = y - 0.5f - top;
  const int column = static_cast<int>(left), row = static_cast<int>(top);
  const std::uint32_t x0 = tiledColumn(wrapTexel(column, width, wrapS));
  const std::uint32_t x1 = tiledColumn(wrapTexel(column + 1, width, wrapS));
  const std::uint32_t y0 = tiledRow(wrapTexel(row, height, wrapT), tilesAcross);
  const std::uint32_t y1 = tiledRow(wrapTexel(row + 1, height, wrapT), tilesAcross);
  f.at[0] = x0 + y0;
  f.at[1] = x1 + y0;
  f.at[2] = x0 + y1;
  f.at[3] = x1 + y1;
  return f;
}

core::Vec4 TextureView::mix(const TexelFootprint& f) const {
  const auto fetch = [&](std::uint32_t at) {
    const std::uint32_t t = texels[at];
    return _mm_setr_ps(decode[t & 255], decode[t >> 8 & 255], decode[t >> 16 & 255],
                       static_cast<float>(t >> 24) * (1 / 255.0f));
  };
  const auto between = [](__m128 a, __m128 b, __m128 share) {
    return _mm_add_ps(a, _mm_mul_ps(share, _mm_sub_ps(b, a)));
  };
  const __m128 right = _mm_set1_ps(f.right);
  const __m128 upper = between(fetch(f.at[0]), fetch(f.at[1]), right);
  const __m128 lower = between(fetch(f.at[2]), fetch(f.at[3]), right);
  alignas(16) float out[4];
  _mm_store_ps(out, between(upper, lower, _mm_set1_ps(f.down)));
  return {out[0], out[1], out[2], out[3]};
}

}  // namespace saccade::raytrace
