// The sampler's promises: elementary intervals, determinism, and values that are uniform and independent
// from pixel to pixel and from dimension to dimension.
#include "core/math/random.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <set>
#include <vector>

#include "tests/hard_case.h"

namespace saccade::core {
namespace {

using tests::HardCase;

/// Upper bound of chi-squared with n degrees of freedom, five standard deviations out.
double chiSquaredLimit(int n) { return n + 5 * std::sqrt(2.0 * n); }

Vec2 pairAt(std::uint32_t x, std::uint32_t y, std::uint64_t subSample, int dimension) {
  PixelSampler sampler(x, y, subSample, 1);
  for (int d = 0; d < dimension; ++d) sampler.next2D();
  return sampler.next2D();
}

TEST(HashKey, EveryInputBitFlipsHalfTheOutput) {
  std::array<double, 128> flips{};
  constexpr int kTrials = 400;
  for (std::uint32_t t = 0; t < kTrials; ++t) {
    const std::array<std::uint32_t, 4> key{t, t * 7 + 1, 3 * t, t / 5};
    const std::uint32_t before = hashKey(key[0], key[1], key[2], key[3]);
    for (int bit = 0; bit < 128; ++bit) {
      auto changed = key;
      changed[bit / 32] ^= 1u << (bit % 32);
      flips[bit] += std::popcount(before ^ hashKey(changed[0], changed[1], changed[2], changed[3]));
    }
  }
  // Binomial(32 * kTrials, 1/2) per input bit: five standard deviations.
  const double tolerance = 5 * std::sqrt(32.0 * kTrials) / 2;
  for (double f : flips) EXPECT_NEAR(f, 16.0 * kTrials, tolerance);
}

TEST(HashKey, ArgumentsAreNotInterchangeable) {
  std::set<std::uint32_t> seen{hashKey(1, 2, 3, 4), hashKey(2, 1, 3, 4), hashKey(3, 4, 1, 2),
                               hashKey(4, 3, 2, 1), hashKey(0, 0, 0, 0)};
  EXPECT_EQ(seen.size(), 5u);
  EXPECT_FALSE(seen.contains(0u));
}

TEST(PixelSampler, ShortcutsEqualTheirDefinitions) {
  // Second Sobol dimension by its direction numbers: v_0 = 1/2, v_{j+1} = v_j xor (v_j >> 1).
  for (std::uint32_t index : {0u, 1u, 2u, 3u, 77u, 0x80000000u, 0xdeadbeefu, 0xffffffffu}) {
    std::uint32_t direction = 0x80000000u, sum = 0;
    for (int bit = 0; bit < 32; ++bit) {
      if (index >> bit & 1) sum ^= direction;
      direction ^= direction >> 1;
    }
    EXPECT_EQ(detail::reverseBits(detail::sobolSecondReversed(index)), sum) << index;
    std::uint32_t reversed = 0;
    for (int bit = 0; bit < 32; ++bit) reversed |= (index >> bit & 1) << (31 - bit);
    EXPECT_EQ(detail::reverseBits(index), reversed) << index;
  }
}

TEST(PixelSampler, FourPairsAtOnceAreFourCalls) {
  for (std::uint64_t subSample : {0ull, 1ull, 5ull, 0xdeadbeefull, 0x100000003ull}) {
    for (int count = 1; count <= 4; ++count) {
      PixelSampler one(12, 34, subSample, 5), four = one;
      Vec2 pairs[4];
      four.next2D(pairs, count);
      for (int k = 0; k < count; ++k) EXPECT_EQ(pairs[k], one.next2D()) << subSample << " " << k;
      EXPECT_EQ(four.next1D(), one.next1D());  // only `count` are taken
    }
  }
}

TEST(PixelSampler, EveryElementaryIntervalOfEveryPairHoldsOnePoint) {
  for (int bits = 0; bits <= 10; ++bits) {
    const std::uint32_t count = 1u << bits;
    for (int dimension : {0, 1, 5, 23}) {
      for (std::uint64_t start : {std::uint64_t{0}, std::uint64_t{count} * 3, std::uint64_t{1} << 33}) {
        for (int xBits = 0; xBits <= bits; ++xBits) {
          std::vector<int> hits(count, 0);
          for (std::uint32_t i = 0; i < count; ++i) {
            const Vec2 p = pairAt(17, 4, start + i, dimension);
            const auto column = static_cast<std::uint32_t>(p.x * static_cast<float>(1u << xBits));
            const auto row = static_cast<std::uint32_t>(p.y * static_cast<float>(1u << (bits - xBits)));
            ++hits[column << (bits - xBits) | row];
          }
          for (int h : hits) ASSERT_EQ(h, 1) << "bits " << bits << " columns 2^" << xBits;
        }
      }
    }
  }
}

TEST(PixelSampler, OneDimensionIsStratifiedToo) {
  constexpr int kCount = 256;
  std::set<int> strata;
  for (int i = 0; i < kCount; ++i) {
    PixelSampler sampler(3, 9, i, 5);
    sampler.next2D();
    strata.insert(static_cast<int>(sampler.next1D() * kCount));
  }
  EXPECT_EQ(strata.size(), static_cast<std::size_t>(kCount));
}

TEST(PixelSampler, DependsOnItsKeyAloneAndOnAllOfIt) {
  const auto first = [](std::uint32_t x, std::uint32_t y, std::uint64_t s, std::uint32_t seed) {
    PixelSampler sampler(x, y, s, seed);
    const Vec2 p = sampler.next2D();
    return std::array<float, 3>{p.x, p.y, sampler.next1D()};
  };
  EXPECT_EQ(first(1, 2, 3, 4), first(1, 2, 3, 4));
  const std::set<std::array<float, 3>> distinct{
      first(1, 2, 3, 4), first(2, 1, 3, 4), first(1, 2, 4, 4),
      first(1, 2, 3, 5), first(0, 2, 3, 4), first(1, 2, 3 + (std::uint64_t{1} << 32), 4)};
  EXPECT_EQ(distinct.size(), 6u);
}

TEST(PixelSampler, Hard19StaysBelowOneForTheLargestBits) {
  HardCase one = HardCase::counting("random numbers that reach 1", "numbers");
  for (std::uint32_t below = 0; below < 1000; ++below) {
    const float u = detail::toUnitFloat(0xffffffffu - below);
    EXPECT_TRUE(one.within(!(u >= 0 && u < 1), 0)) << below;
  }
  EXPECT_EQ(detail::toUnitFloat(0u), 0.0f);
}

TEST(PixelSampler, Hard20BeyondFourThousandMillionSubSamples) {
  // Either side of every 2^32 the sequence is stratified, and it is not the one before.
  constexpr std::uint32_t kCount = 1024;
  HardCase strata =
               HardCase::counting("strata of 1024 sub-samples beyond 2^32 that do not hold one", "strata"),
           again = HardCase::counting("sub-samples beyond 2^32 that repeat those 2^32 before", "numbers");
  for (const std::uint64_t start :
       {(1ull << 32) - kCount, 1ull << 32, 1ull << 33, 5ull << 40, ~0ull - kCount + 1}) {
    std::vector<int> hits(kCount, 0);
    int repeated = 0;
    for (std::uint32_t i = 0; i < kCount; ++i) {
      const Vec2 p = pairAt(17, 4, start + i, 3), before = pairAt(17, 4, start + i - (1ull << 32), 3);
      ++hits[static_cast<std::size_t>(p.x * 32) * 32 + static_cast<std::size_t>(p.y * 32)];
      repeated += p == before;
    }
    int wrong = 0;
    for (const int h : hits) wrong += h != 1;
    EXPECT_TRUE(strata.within(wrong, 0)) << start;
    EXPECT_TRUE(again.within(repeated, 0)) << start;
  }
}

/// Moments and a chi-squared test on a 16 x 16 grid, over neighbouring pixels at one sub-sample.
void expectUniformOverPixels(std::uint64_t subSample, int dimension) {
  constexpr int kSide = 256, kGrid = 16;
  constexpr double kCount = kSide * kSide;
  Vec2 previous(0.5f);
  double sumX = 0, sumY = 0, sumXX = 0, sumXY = 0, lag = 0;
  std::array<int, kGrid * kGrid> cells{};
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const Vec2 p = pairAt(x, y, subSample, dimension);
      ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
      sumX += p.x, sumY += p.y, sumXX += p.x * p.x, sumXY += p.x * p.y;
      lag += (p.x - 0.5) * (previous.x - 0.5);
      ++cells[static_cast<int>(p.y * kGrid) * kGrid + static_cast<int>(p.x * kGrid)];
      previous = p;
    }
  }
  const double sigma = 1 / std::sqrt(kCount);
  EXPECT_NEAR(sumX / kCount, 0.5, 5 * sigma * std::sqrt(1 / 12.0));
  EXPECT_NEAR(sumY / kCount, 0.5, 5 * sigma * std::sqrt(1 / 12.0));
  EXPECT_NEAR(sumXX / kCount, 1 / 3.0, 5 * sigma * std::sqrt(4 / 45.0));
  EXPECT_NEAR(sumXY / kCount, 0.25, 5 * sigma * std::sqrt(7 / 144.0));
  EXPECT_NEAR(lag / kCount, 0.0, 5 * sigma / 12);
  double chi = 0;
  const double expected = kCount / cells.size();
  for (int c : cells) chi += (c - expected) * (c - expected) / expected;
  EXPECT_LT(chi, chiSquaredLimit(kGrid * kGrid - 1)) << "sub-sample " << subSample;
  EXPECT_GT(chi, kGrid * kGrid - 1 - 5 * std::sqrt(2.0 * (kGrid * kGrid - 1)));
}

TEST(PixelSampler, PixelsAreUniformAndUncorrelated) {
  for (std::uint64_t subSample : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{1000003}}) {
    expectUniformOverPixels(subSample, 0);
    expectUniformOverPixels(subSample, 7);
  }
}

TEST(PixelSampler, DimensionsOfOnePixelAreUncorrelated) {
  constexpr int kCount = 1 << 14;
  double product = 0;
  std::array<int, 256> cells{};
  for (int i = 0; i < kCount; ++i) {
    PixelSampler sampler(100, 200, i, 3);
    const float a = sampler.next2D().x, b = sampler.next2D().x;
    product += (a - 0.5) * (b - 0.5);
    ++cells[static_cast<int>(a * 16) * 16 + static_cast<int>(b * 16)];
  }
  EXPECT_NEAR(product / kCount, 0.0, 5 / (12 * std::sqrt(double{kCount})));
  double chi = 0;
  for (int c : cells) chi += (c - kCount / 256.0) * (c - kCount / 256.0) / (kCount / 256.0);
  EXPECT_LT(chi, chiSquaredLimit(255));
}

}  // namespace
}  // namespace saccade::core
