// The display transform's table against its definition, and the composite against both.
#include "core/composite.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "core/image_io.h"
#include "core/srgb8.h"
#include "tests/hard_case.h"

namespace saccade::core {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::uint8_t byDefinition(float linear) {
  return static_cast<std::uint8_t>(std::floor(255.0f * encodeSrgb(linear) + 0.5f));
}

TEST(Srgb, FixedPointsAndInverse) {
  EXPECT_EQ(encodeSrgb(0), 0.0f);
  EXPECT_EQ(encodeSrgb(1), 1.0f);
  EXPECT_EQ(encodeSrgb(-3), 0.0f);
  EXPECT_EQ(encodeSrgb(kNan), 0.0f);
  EXPECT_EQ(encodeSrgb(kInfinity), 1.0f);
  EXPECT_EQ(encodeSrgb(-kInfinity), 0.0f);
  EXPECT_FLOAT_EQ(encodeSrgb(0.002f), 0.02584f);
  EXPECT_NEAR(encodeSrgb(0.5f), 0.7353569830524495, 1e-7);
  EXPECT_NEAR(decodeSrgb(0.5f), 0.21404114048223255, 1e-7);
  for (int i = 0; i <= 10000; ++i) {
    const float x = static_cast<float>(i) / 10000;
    EXPECT_NEAR(decodeSrgb(encodeSrgb(x)), x, 3e-7f);
  }
  for (int code = 0; code < 256; ++code) {
    EXPECT_EQ(byDefinition(decodeSrgb(static_cast<float>(code) / 255)), code);
  }
}

TEST(Srgb8, EqualsRoundingTheEncodedValue) {
  const Srgb8& table = Srgb8::table();
  // Every 997th float of (0, 2), subnormals included, and the floats next to every step.
  for (std::uint32_t bits = 0; bits < std::bit_cast<std::uint32_t>(2.0f); bits += 997) {
    const auto x = std::bit_cast<float>(bits);
    ASSERT_EQ(table(x), byDefinition(x)) << x;
  }
  for (int code = 1; code < 256; ++code) {
    const float step = decodeSrgb((static_cast<float>(code) - 0.5f) / 255);
    for (int ulps = -40; ulps <= 40; ++ulps) {
      const auto x = std::bit_cast<float>(std::bit_cast<std::uint32_t>(step) + static_cast<unsigned>(ulps));
      ASSERT_EQ(table(x), byDefinition(x)) << x;
    }
  }
  for (float x : {kNan, -kNan, -1.0f, -0.0f, kInfinity, -kInfinity, 1e30f, 1.0f}) {
    EXPECT_EQ(table(x), byDefinition(x)) << x;
  }
}

TEST(Srgb8, Hard22ToneMappingOfWhatIsNoColour) {
  // NaN, what is negative and black give 0; infinity and what is beyond 1 give 255; at any exposure.
  tests::HardCase off("display code of NaN, -1, infinity and black", "codes");
  const std::pair<float, int> truths[] = {
      {kNan, 0},       {-kNan, 0},  {-1, 0},          {-0.0f, 0},   {0, 0},
      {-kInfinity, 0}, {-1e30f, 0}, {kInfinity, 255}, {1e30f, 255}, {std::numeric_limits<float>::max(), 255}};
  for (const float ev : {-20.0f, 0.0f, 20.0f}) {
    for (const auto& [value, code] : truths) {
      // A picture wide enough for the path that encodes eight at once, and its rest.
      for (const int width : {1, 19}) {
        const ImageRgba8 image = toDisplay(ImageRgb(width, 1, Vec3(value)), ev);
        for (const Rgba8& p : image.pixels()) {
          for (const int got : {p.r, p.g, p.b})
            EXPECT_TRUE(off.near(got, code, 0)) << value << " at " << ev << " EV";
          EXPECT_EQ(p.a, 255);
        }
      }
    }
  }
}

TEST(Srgb8, EightAtOnceEqualOneByOne) {
  const Srgb8& table = Srgb8::table();
  const float cases[8] = {kNan, -1, 0, 1, kInfinity, 0.0031308f, 0.5f, -kInfinity};
  alignas(32) std::uint32_t codes[8];
  _mm256_store_si256(reinterpret_cast<__m256i*>(codes), table.encode8(_mm256_loadu_ps(cases)));
  for (int i = 0; i < 8; ++i) EXPECT_EQ(codes[i], table(cases[i])) << cases[i];
}

std::vector<Vec4> randomPixels(std::size_t count, float lo, float hi, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(lo, hi);
  std::vector<Vec4> pixels(count);
  for (Vec4& p : pixels) p = Vec4(value(random), value(random), value(random), 1 + random() % 1000);
  return pixels;
}

TEST(Composite, DisplayEqualsLinearThroughTheDisplayTransform) {
  for (auto [width, height] : {std::pair{1, 1}, {3, 5}, {64, 33}}) {
    auto base = randomPixels(static_cast<std::size_t>(width) * height, 0, 2, 1);
    const auto correction = randomPixels(base.size(), -0.5f, 1, 2);
    base[0].x = kNan;
    for (float ev : {-3.0f, 0.0f, 0.7f, 20.0f}) {
      for (bool corrected : {false, true}) {
        const auto added = corrected ? std::span<const Vec4>(correction) : std::span<const Vec4>();
        const ImageRgba8 expected = toDisplay(compositeLinear(width, height, base, added), ev);
        ImageRgba8 display(2, 2);
        compositeDisplay(width, height, base, added, ev, display);
        EXPECT_EQ(display.width(), width);
        EXPECT_EQ(display.pixels(), expected.pixels()) << ev;
      }
    }
  }
}

TEST(Composite, LinearIsOneAdditionAChannel) {
  const auto base = randomPixels(12, 0, 2, 3), correction = randomPixels(12, -1, 1, 4);
  const ImageRgb sum = compositeLinear(4, 3, base, correction);
  const ImageRgb bare = compositeLinear(4, 3, base, {});
  for (std::size_t i = 0; i < base.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(sum.pixels()[i][c], base[i][c] + correction[i][c]);
      EXPECT_EQ(bare.pixels()[i][c], base[i][c]);
    }
  }
}

}  // namespace
}  // namespace saccade::core
