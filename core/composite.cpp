#include "core/composite.h"

#include <cassert>
#include <cmath>

#include "core/srgb8.h"

namespace saccade::core {
namespace {

static_assert(sizeof(Vec4) == 16 && sizeof(Rgba8) == 4);

/// Two pixels, RGBA each, as 8-bit codes in the low eight bytes; alpha is 255.
__m128i displayPair(const Srgb8& encode, __m256 linear) {
  const __m256i codes = encode.encode8(linear);
  const __m128i words = _mm_packus_epi32(_mm256_castsi256_si128(codes), _mm256_extracti128_si256(codes, 1));
  const __m128i opaque = _mm_set1_epi32(static_cast<int>(0xff000000u));
  return _mm_or_si128(_mm_packus_epi16(words, words), opaque);
}

template <bool kCorrected>
void displayPixels(std::span<const Vec4> base, std::span<const Vec4> correction, float scale, Rgba8* out) {
  const Srgb8& encode = Srgb8::table();
  std::size_t i = 0;
  for (; i + 2 <= base.size(); i += 2) {
    __m256 sum = _mm256_loadu_ps(&base[i].x);
    if constexpr (kCorrected) sum = _mm256_add_ps(sum, _mm256_loadu_ps(&correction[i].x));
    const __m128i pair = displayPair(encode, _mm256_mul_ps(sum, _mm256_set1_ps(scale)));
    _mm_storel_epi64(reinterpret_cast<__m128i*>(out + i), pair);
  }
  for (; i < base.size(); ++i) {
    Vec4 sum = base[i];
    if constexpr (kCorrected) sum += correction[i];
    out[i] = {encode(sum.x * scale), encode(sum.y * scale), encode(sum.z * scale), 255};
  }
}

}  // namespace

ImageRgb compositeLinear(int width, int height, std::span<const Vec4> baseAndId,
                         std::span<const Vec4> correction) {
  ImageRgb image(width, height);
  assert(baseAndId.size() == image.pixels().size());
  assert(correction.empty() || correction.size() == baseAndId.size());
  for (std::size_t i = 0; i < baseAndId.size(); ++i) {
    const Vec3 base(baseAndId[i]);
    image.pixels()[i] = correction.empty() ? base : base + Vec3(correction[i]);
  }
  return image;
}

void compositeDisplay(int width, int height, std::span<const Vec4> baseAndId,
                      std::span<const Vec4> correction, float exposureEv, ImageRgba8& out) {
  if (out.width() != width || out.height() != height) out = ImageRgba8(width, height);
  assert(baseAndId.size() == out.pixels().size());
  assert(correction.empty() || correction.size() == baseAndId.size());
  const float scale = std::exp2(exposureEv);
  if (correction.empty()) {
    displayPixels<false>(baseAndId, correction, scale, out.pixels().data());
  } else {
    displayPixels<true>(baseAndId, correction, scale, out.pixels().data());
  }
}

void compositeDisplayAt(std::span<const Pixel> pixels, std::span<const Vec4> baseAndId,
                        std::span<const Vec3> corrections, float exposureEv, ImageRgba8& out) {
  assert(pixels.size() == corrections.size() && baseAndId.size() == out.pixels().size());
  const Srgb8& encode = Srgb8::table();
  const float scale = std::exp2(exposureEv);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto [x, y] = pixels[i];
    const std::size_t at = static_cast<std::size_t>(y) * out.width() + x;
    const Vec3 sum = (Vec3(baseAndId[at]) + corrections[i]) * scale;
    out.pixels()[at] = {encode(sum.x), encode(sum.y), encode(sum.z), 255};
  }
}

}  // namespace saccade::core
