// AgingTest::change: sample by sample, expected change of what is displayed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "core/corrective/change_rate.h"
#include "render/splat/sample_cache.h"
#include "tests/unit/render/splat_fixture.h"

namespace saccade::render {
namespace {

using core::Sample;
using core::Vec3;
using namespace testing;

constexpr std::size_t kPlenty = std::size_t{64} << 20;

AgingOptions change(float delta, int maxAge = 30) {
  return {.nMin = 10, .delta = delta, .maxAge = maxAge, .test = AgingTest::change};
}

Sample sample(const Vec3& position, const Vec3& eye, float changeRate) {
  Sample s;
  s.id = 1;
  s.level = 4;
  s.position = position;
  s.normal = {0, 1, 0};
  s.toEye = glm::normalize(eye - position);
  s.cosView = s.toEye.y;
  s.viewDepth = 1;
  s.changeRate = changeRate;
  return s;
}

/// Points anywhere in the unit cube, rates from 0 to 3; x tells them apart.
std::vector<Sample> scattered(const Vec3& eye, int count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> u(-1, 1);
  std::vector<Sample> samples;
  for (int i = 0; i < count; ++i) {
    samples.push_back(sample({u(random), u(random), u(random)}, eye, 1.5f + 1.5f * u(random)));
    samples.back().x = i;
    samples.back().level = static_cast<std::uint8_t>(1 + i % 7);
  }
  return samples;
}

std::set<int> keptOf(const std::vector<Sample>& samples, const Vec3& from, const Vec3& to, float delta) {
  SampleCache cache(kPlenty);
  cache.age(viewFrom(from), change(delta));
  cache.add({0, 0, samples}, cache.cameraAge());
  const auto result = cache.age(viewFrom(to), change(delta));
  std::set<int> kept;
  cache.forEach([&](const Sample& s, std::uint64_t) { kept.insert(s.x); });
  EXPECT_EQ(result.kept, kept.size());
  EXPECT_EQ(result.kept + result.deleted, samples.size());
  EXPECT_EQ(cache.size(), kept.size());
  return kept;
}

TEST(SampleCacheChange, KeepsWhatIsExpectedToChangeByDeltaAtMost) {
  // The eye turns by 0.1 rad about the point: a chord of 2 sin 0.05 = 0.09996.
  const Vec3 from(0, 3, 0), to(3 * std::sin(0.1f), 3 * std::cos(0.1f), 0);
  EXPECT_EQ(keptOf({sample(Vec3(0), from, 1.0f)}, from, to, 0.1f).size(), 1u);
  EXPECT_EQ(keptOf({sample(Vec3(0), from, 1.01f)}, from, to, 0.1f).size(), 0u);
  // Motion around the normal, which <normal, v> does not see.
  const Vec3 side(2, 2, 0), other(0, 2, 2);
  EXPECT_EQ(keptOf({sample(Vec3(0), side, 1.0f)}, side, other, 0.1f).size(), 0u);
  // Nearer along the same line nothing changes.
  EXPECT_EQ(keptOf({sample(Vec3(0), from, 100.0f)}, from, 0.3f * from, 0.01f).size(), 1u);
}

TEST(SampleCacheChange, FollowsItsFormulaAndIsMonotoneInDelta) {
  const Vec3 from(0.2f, 2, 2.5f), to(0.6f, 1.7f, 2.4f);
  const std::vector<Sample> samples = scattered(from, 1000);
  std::set<int> before;
  for (const float delta : {0.0f, 0.01f, 0.05f, 0.2f, 0.4f, 3.0f}) {
    const std::set<int> kept = keptOf(samples, from, to, delta);
    EXPECT_TRUE(std::includes(kept.begin(), kept.end(), before.begin(), before.end()));
    for (const Sample& s : samples) {
      const float expected = s.changeRate * glm::length(glm::normalize(to - s.position) - s.toEye);
      if (std::abs(expected - delta) > 1e-5f) {
        EXPECT_EQ(kept.contains(s.x), expected < delta) << s.x << " at " << delta;
      }
    }
    before = kept;
  }
  EXPECT_EQ(before.size(), samples.size());
}

TEST(SampleCacheChange, TurningTheHeadInvalidatesNothing) {
  const Vec3 eye(0.5f, 2, 0.3f);
  SampleCache cache(kPlenty);
  cache.age(viewFrom(eye), change(1e-5f));
  cache.add({0, 0, scattered(eye, 500)}, cache.cameraAge());
  for (const Vec3& at : {Vec3(1, 0, 0), Vec3(0, 0.2f, 1), Vec3(-1, -1, 0.5f)}) {
    EXPECT_EQ(cache.age(viewFrom(eye, at), change(1e-5f)).deleted, 0u);
  }
}

TEST(SampleCacheChange, TheOrderOfSamplesDoesNotMatter) {
  const Vec3 from(0.2f, 2, 2.5f), to(0.5f, 1.9f, 2.4f);
  std::vector<Sample> samples = scattered(from, 1500);
  const std::set<int> kept = keptOf(samples, from, to, 0.1f);
  EXPECT_GT(kept.size(), 100u);
  EXPECT_LT(kept.size(), 1400u);
  std::shuffle(samples.begin(), samples.end(), std::mt19937(3));
  EXPECT_EQ(keptOf(samples, from, to, 0.1f), kept);
}

TEST(SampleCacheChange, AnEyeOnTheSampleInvalidates) {
  const Vec3 from(0, 3, 0);
  EXPECT_TRUE(keptOf({sample(Vec3(1), from, 0.5f)}, from, Vec3(1), 2).empty());
}

TEST(SampleCacheChange, ARateThatIsNoNumberIsNotStored) {
  const Vec3 from(0, 3, 0);
  SampleCache cache(kPlenty);
  cache.age(viewFrom(from), change(0.1f));
  EXPECT_EQ(cache.add({0, 0, {sample(Vec3(0), from, std::nanf(""))}}, cache.cameraAge()), 0u);
}

/// As in walks that are aged by the paper's test.
TEST(SampleCacheChange, ARateThatWasNotEstimatedIsTakenForTheUsualOne) {
  const Vec3 from(0, 3, 0), to(3 * std::sin(0.1f), 3 * std::cos(0.1f), 0);
  const float expected = core::kUnknownChangeRate * 2 * std::sin(0.05f);
  EXPECT_EQ(keptOf({sample(Vec3(0), from, 0)}, from, to, 1.01f * expected).size(), 1u);
  EXPECT_EQ(keptOf({sample(Vec3(0), from, 0)}, from, to, 0.99f * expected).size(), 0u);
}

TEST(SampleCacheChange, LeavesAfterMaxAge) {
  const Vec3 eye(0, 3, 0);
  SampleCache cache(kPlenty);
  cache.age(viewFrom(eye), change(0.1f, 5));
  cache.add({0, 0, std::vector<Sample>(300, sample(Vec3(0), eye, 0))}, cache.cameraAge());
  for (int i = 0; i < 5; ++i) EXPECT_EQ(cache.age(viewFrom(eye), change(0.1f, 5)).kept, 300u);
  EXPECT_EQ(cache.age(viewFrom(eye), change(0.1f, 5)).kept, 0u);
}

}  // namespace
}  // namespace saccade::render
