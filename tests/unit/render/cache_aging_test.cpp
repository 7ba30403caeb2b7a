// Aging: the paper's pseudo code (Haber 2001, section 4.5), analytic cases of its measure, and the bound on
// memory.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "render/splat/sample_cache.h"
#include "tests/unit/render/splat_fixture.h"

namespace saccade::render {
namespace {

using core::Sample;
using core::SampleBatch;
using core::Vec3;
using namespace testing;

constexpr std::size_t kPlenty = std::size_t{64} << 20;
constexpr std::size_t kPage = 256;

Sample sample(std::uint32_t id, int level, const Vec3& position, const Vec3& normal, const Vec3& eye) {
  Sample s;
  s.id = id;
  s.level = static_cast<std::uint8_t>(level);
  s.position = position;
  s.normal = normal;
  s.cosView = glm::dot(normal, glm::normalize(eye - position));
  s.viewDepth = 1;
  return s;
}

SampleBatch repeated(const Sample& s, std::size_t count) { return {0, 0, std::vector<Sample>(count, s)}; }

/// An eye `degrees` off the normal (0, 1, 0) of a sample at the origin.
Vec3 eyeOff(float degrees) {
  const float a = degrees * core::kPi / 180;
  return 3.0f * Vec3(std::sin(a), std::cos(a), 0);
}

std::size_t keptAfterMove(float fromDegrees, float toDegrees, float delta) {
  SampleCache cache(kPlenty);
  cache.age(viewFrom(eyeOff(fromDegrees)), {});
  cache.add(repeated(sample(1, 4, Vec3(0), {0, 1, 0}, eyeOff(fromDegrees)), 20), cache.cameraAge());
  return cache.age(viewFrom(eyeOff(toDegrees)), {10, delta, 30}).kept;
}

TEST(SampleCacheAging, DeltaIsAChangeOfCosine) {
  // Design fact 15: at normal incidence 0.05 admits 18 degrees, 0.2 admits 37.
  EXPECT_EQ(keptAfterMove(0, 18, 0.05f), 20u);
  EXPECT_EQ(keptAfterMove(0, 19, 0.05f), 0u);
  EXPECT_EQ(keptAfterMove(0, 36, 0.2f), 20u);
  EXPECT_EQ(keptAfterMove(0, 38, 0.2f), 0u);
  // Away from it, it is stricter: cos 60 - cos 63 = 0.046, cos 60 - cos 64 = 0.062.
  EXPECT_EQ(keptAfterMove(60, 63, 0.05f), 20u);
  EXPECT_EQ(keptAfterMove(60, 64, 0.05f), 0u);
  // The distance does not matter, for v is normalised.
  SampleCache cache(kPlenty);
  cache.age(viewFrom(Vec3(0, 1, 0)), {});
  cache.add(repeated(sample(1, 4, Vec3(0), {0, 1, 0}, Vec3(0, 1, 0)), 20), cache.cameraAge());
  EXPECT_EQ(cache.age(viewFrom(Vec3(0, 9, 0)), {10, 0.01f, 30}).kept, 20u);
}

TEST(SampleCacheAging, TurningTheHeadInvalidatesNothing) {
  SampleCache cache(kPlenty);
  const Vec3 eye(0.5f, 2, 0.3f);
  std::mt19937 random(4);
  std::uniform_real_distribution<float> u(-1, 1);
  cache.age(viewFrom(eye), {});
  for (int i = 0; i < 500; ++i) {
    const Vec3 normal = glm::normalize(Vec3(u(random), u(random), u(random)));
    cache.add(repeated(sample(1 + static_cast<std::uint32_t>(i) % 3, 1 + i % 7, Vec3(u(random), 0, u(random)),
                              normal, eye),
                       1),
              cache.cameraAge());
  }
  for (int turn = 0; turn < 10; ++turn) {
    const auto result =
        cache.age(viewFrom(eye, eye + Vec3(u(random), u(random), u(random))), {10, 1e-5f, 30});
    EXPECT_EQ(result.deleted, 0u);
    EXPECT_EQ(result.kept, 500u);
  }
}

TEST(SampleCacheAging, LeavesAfterMaxAge) {
  SampleCache cache(kPlenty);
  const auto view = viewFrom(eyeOff(0));
  cache.age(view, {});
  cache.add(repeated(sample(1, 4, Vec3(0), {0, 1, 0}, eyeOff(0)), 300), cache.cameraAge());
  for (int i = 0; i < 5; ++i) EXPECT_EQ(cache.age(view, {10, 0.1f, 5}).kept, 300u);
  const auto result = cache.age(view, {10, 0.1f, 5});
  EXPECT_EQ(result.kept, 0u);
  EXPECT_EQ(result.deleted, 300u);
  EXPECT_EQ(cache.count(1, 4), 0u);
  // MAX_AGE 0 keeps what the present camera made and nothing else.
  cache.add(repeated(sample(1, 4, Vec3(0), {0, 1, 0}, eyeOff(0)), 3), cache.cameraAge());
  EXPECT_EQ(cache.age(view, {10, 0.1f, 0}).kept, 0u);
}

TEST(SampleCacheAging, OnlyMoreThanHalfCondemnsAnAge) {
  for (const int invalid : {5, 6}) {
    SampleCache cache(kPlenty);
    cache.age(viewFrom(eyeOff(0)), {});
    Sample good = sample(1, 3, Vec3(0), {0, 1, 0}, eyeOff(40));
    Sample bad = sample(1, 3, Vec3(0), {0, 1, 0}, eyeOff(0));
    cache.add(repeated(good, static_cast<std::size_t>(10 - invalid)), cache.cameraAge());
    cache.add(repeated(bad, static_cast<std::size_t>(invalid)), cache.cameraAge());
    bad.level = 5;  // finer samples are not asked, but share the fate
    cache.add(repeated(bad, 50), cache.cameraAge());
    bad.id = 2;
    good.id = 3;
    cache.add(repeated(good, 10), cache.cameraAge());  // another object, all valid
    const auto result = cache.age(viewFrom(eyeOff(40)), {10, 0.1f, 30});
    EXPECT_EQ(result.kept, invalid == 5 ? 70u : 10u);
    EXPECT_EQ(cache.count(3, 3), 10u);
  }
}

TEST(SampleCacheAging, ObjectsBelowNMinAreTestedWithAllTheyHave) {
  for (const float degrees : {0.0f, 40.0f}) {
    SampleCache cache(kPlenty);
    cache.age(viewFrom(eyeOff(0)), {});
    for (const int level : {2, 4, 6}) {
      cache.add(repeated(sample(1, level, Vec3(0), {0, 1, 0}, eyeOff(0)), 3), cache.cameraAge());
    }
    EXPECT_EQ(cache.age(viewFrom(eyeOff(degrees)), {10, 0.1f, 30}).kept, degrees == 0 ? 9u : 0u);
  }
}

TEST(SampleCacheAging, AnEyeOnTheSampleInvalidatesIt) {
  SampleCache cache(kPlenty);
  cache.age(viewFrom(eyeOff(0)), {});
  cache.add(repeated(sample(1, 4, Vec3(1), {0, 1, 0}, eyeOff(0)), 20), cache.cameraAge());
  EXPECT_EQ(cache.age(viewFrom(Vec3(1)), {10, 1, 30}).kept, 0u);
}

/// The pseudo code of section 4.5, line by line, on maps.
class PlainCache {
 public:
  using Key = std::pair<std::uint64_t, float>;  // age, and what tells samples apart
  void add(const Sample& s, std::uint64_t age) { objects_[s.id][s.level].push_back({s, age}); }
  void age(const Vec3& eye, const AgingOptions& o, std::uint64_t cameraAge) {
    for (auto& [id, levels] : objects_) {
      std::set<int> tested;
      for (int level = 7; level >= 1; --level) {
        if (levels[level].size() >= static_cast<std::size_t>(o.nMin)) tested = {level};
      }
      if (tested.empty()) tested = {1, 2, 3, 4, 5, 6, 7};
      std::map<std::uint64_t, int> invalid, total;
      for (const int level : tested) {
        for (const auto& [s, made] : levels[level]) {
          const float d = glm::dot(s.normal, glm::normalize(eye - s.position));
          ++total[cameraAge - made];
          if (std::abs(d - s.cosView) > o.delta) ++invalid[cameraAge - made];
        }
      }
      for (auto& [level, samples] : levels) {
        std::erase_if(samples, [&, &total = total, &invalid = invalid](const auto& entry) {
          const std::uint64_t j = cameraAge - entry.second;
          return j > static_cast<std::uint64_t>(o.maxAge) || 2 * invalid[j] > total[j];
        });
      }
    }
  }
  std::multiset<Key> content() const {
    std::multiset<Key> all;
    for (const auto& [id, levels] : objects_) {
      for (const auto& [level, samples] : levels) {
        for (const auto& [s, made] : samples) all.insert({made, s.correction.x});
      }
    }
    return all;
  }

 private:
  std::map<std::uint32_t, std::map<int, std::vector<std::pair<Sample, std::uint64_t>>>> objects_;
};

TEST(SampleCacheAging, FollowsThePseudoCode) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> u(-1, 1);
  SampleCache cache(kPlenty);
  PlainCache plain;
  const AgingOptions options{10, 0.1f, 6};
  std::size_t deletedByTest = 0;
  float serial = 0;
  for (int step = 0; step < 60; ++step) {
    const float angle = 0.07f * static_cast<float>(step);
    const Vec3 eye(3 * std::cos(angle), 1 + u(random), 3 * std::sin(angle));
    const auto result = cache.age(viewFrom(eye), options);
    plain.age(eye, options, cache.cameraAge());
    deletedByTest += result.deleted;
    std::multiset<PlainCache::Key> content;
    std::map<std::pair<std::uint32_t, int>, std::uint32_t> counts;
    cache.forEach([&](const Sample& s, std::uint64_t age) {
      content.insert({age, s.correction.x});
      ++counts[{s.id, s.level}];
    });
    ASSERT_EQ(content, plain.content()) << "step " << step;
    ASSERT_EQ(cache.size(), result.kept);
    for (const auto& [key, n] : counts) ASSERT_EQ(cache.count(key.first, key.second), n);
    // Points of spheres; some late, of the camera before.
    for (int i = 0; i < 400; ++i) {
      const Vec3 normal = glm::normalize(Vec3(u(random), u(random), u(random)) + Vec3(0, 0.01f, 0));
      const std::uint32_t id = 1 + random() % 9 * (random() % 200 == 0 ? 100 : 1);
      Sample s = sample(id, 2 + static_cast<int>(random() % 6),
                        0.5f * normal + Vec3(0, 0, 0.2f * static_cast<float>(id % 5)), normal, eye);
      s.correction.x = serial++;
      const std::uint64_t age = cache.cameraAge() - (cache.cameraAge() > 1 && random() % 10 == 0 ? 1 : 0);
      ASSERT_EQ(cache.add(repeated(s, 1), age), 1u);
      plain.add(s, age);
    }
  }
  EXPECT_GT(deletedByTest, 1000u);
}

TEST(SampleCacheMemory, TheOldestLeaveFirst) {
  const auto view = viewFrom(eyeOff(0));
  const Sample s = sample(1, 4, Vec3(0), {0, 1, 0}, eyeOff(0));
  SampleCache probe(kPlenty);
  probe.age(view, {});
  probe.add(repeated(s, 1), probe.cameraAge());
  const std::size_t pageBytes = probe.bytes();

  SampleCache cache(4 * pageBytes + pageBytes / 2);
  for (std::uint64_t age = 1; age <= 3; ++age) {
    cache.age(view, {});
    EXPECT_EQ(cache.add(repeated(s, 2 * kPage), age), 2 * kPage);
    EXPECT_LE(cache.bytes(), 4 * pageBytes + pageBytes / 2);
  }
  std::map<std::uint64_t, std::size_t> byAge;
  cache.forEach([&](const Sample&, std::uint64_t age) { ++byAge[age]; });
  EXPECT_EQ(byAge, (std::map<std::uint64_t, std::size_t>{{2, 2 * kPage}, {3, 2 * kPage}}));
  // Samples older than all that is stored do not drive out younger ones, nor do equals each other.
  EXPECT_EQ(cache.add(repeated(s, 7), 1), 0u);
  EXPECT_EQ(cache.add(repeated(s, 4 * kPage), 3), 2 * kPage);
  EXPECT_EQ(cache.size(), 4 * kPage);
  EXPECT_EQ(cache.count(1, 4), 4 * kPage);
  EXPECT_EQ(cache.bytes(), 4 * pageBytes);
  cache.clear();
  EXPECT_EQ(cache.bytes(), 0u);
  EXPECT_EQ(cache.size(), 0u);
  EXPECT_EQ(cache.count(1, 4), 0u);
}

TEST(SampleCacheMemory, OfTheOldestAgeTheLeastSalientLeaveFirst) {
  // Salience is the order of arrival: object 1 before 2 before 3. Object 2 is deleted by the aging test,
  // which moves samples about.
  const Vec3 near = eyeOff(0), far = eyeOff(40);
  SampleCache probe(kPlenty);
  probe.age(viewFrom(near), {});
  probe.add(repeated(sample(1, 4, Vec3(0), {0, 1, 0}, near), 1), 1);
  SampleCache cache(8 * probe.bytes());
  cache.age(viewFrom(near), {});
  SampleBatch batch;
  for (std::uint32_t id = 1; id <= 3; ++id) {
    for (std::size_t i = 0; i < 600; ++i) {
      Sample s = sample(id, 4, Vec3(0), {0, 1, 0}, id == 2 ? near : far);
      s.correction.x = static_cast<float>(batch.samples.size());
      batch.samples.push_back(s);
    }
  }
  ASSERT_EQ(cache.add(batch, 1), 1800u);  // in eight pages, the last of which holds 8
  ASSERT_EQ(cache.age(viewFrom(far), {10, 0.1f, 30}).deleted, 600u);
  ASSERT_EQ(cache.size(), 1200u);  // in five pages

  const auto oldest = [&] {
    std::set<float> all;
    cache.forEach([&](const Sample& s, std::uint64_t age) {
      if (age == 1) all.insert(s.correction.x);
    });
    return all;
  };
  std::size_t left = 1200;
  for (std::size_t pages = 1; pages <= 8; ++pages) {
    ASSERT_EQ(cache.add(repeated(sample(4, 4, Vec3(0), {0, 1, 0}, far), kPage), 2), kPage);
    // Three pages are free; then a page of the oldest for each, the incomplete one first.
    const std::size_t dropped = pages <= 3 ? 0 : std::min<std::size_t>(1200, 176 + (pages - 4) * kPage);
    left = 1200 - dropped;
    const std::set<float> kept = oldest();
    ASSERT_EQ(kept.size(), left) << pages;
    EXPECT_EQ(cache.count(1, 4), std::min<std::size_t>(left, 600));
    EXPECT_EQ(cache.count(3, 4), left - std::min<std::size_t>(left, 600));
    EXPECT_EQ(cache.size(), left + pages * kPage);
    std::size_t rank = 0;  // the first `left` of objects 1 and 3 in the order of their arrival
    for (const float serial : kept) {
      EXPECT_EQ(serial, static_cast<float>(rank < 600 ? rank : rank + 600));
      ++rank;
    }
  }
  EXPECT_EQ(left, 0u);
  EXPECT_EQ(cache.add(repeated(sample(4, 4, Vec3(0), {0, 1, 0}, far), 1), 2), 0u);
}

TEST(SampleCacheMemory, NoMemoryKeepsNothing) {
  SampleCache cache(100);
  cache.age(viewFrom(eyeOff(0)), {});
  EXPECT_EQ(cache.add(repeated(sample(1, 4, Vec3(0), {0, 1, 0}, eyeOff(0)), 5), 1), 0u);
  EXPECT_EQ(cache.size(), 0u);
  EXPECT_EQ(cache.bytes(), 0u);
}

TEST(SampleCacheMemory, SamplesComeBackAsTheyWere) {
  const auto frame = maskFrame(40, 30, [](int, int) { return 7u; });
  SampleCache cache(kPlenty);
  cache.age(frame->view, {});
  SampleBatch batch;
  batch.samples = latticeSamples(*frame, 7);
  batch.samples[5].fromDepth = true;
  EXPECT_EQ(cache.add(batch, 1), batch.samples.size());
  std::size_t i = 0;
  cache.forEach([&](const Sample& s, std::uint64_t age) {
    const Sample& o = batch.samples[i++];
    EXPECT_EQ(age, 1u);
    EXPECT_EQ(s.x, o.x);
    EXPECT_EQ(s.y, o.y);
    EXPECT_EQ(s.id, o.id);
    EXPECT_EQ(s.level, o.level);
    EXPECT_EQ(s.thread, o.thread);
    EXPECT_EQ(s.fromDepth, o.fromDepth);
    EXPECT_EQ(s.correction, o.correction);
    EXPECT_EQ(s.position, o.position);
    EXPECT_EQ(s.normal, o.normal);
    EXPECT_EQ(s.cosView, o.cosView);
    EXPECT_EQ(s.viewDepth, o.viewDepth);
  });
  EXPECT_EQ(i, batch.samples.size());
}

TEST(SampleCacheMemory, IgnoresWhatIsNotFinite) {
  SampleCache cache(kPlenty);
  cache.age(viewFrom(eyeOff(0)), {});
  const Sample good = sample(1, 4, Vec3(0), {0, 1, 0}, eyeOff(0));
  SampleBatch batch = repeated(good, 7);
  batch.samples[1].position.y = std::nanf("");
  batch.samples[2].position.x = INFINITY;
  batch.samples[3].normal.z = std::nanf("");
  batch.samples[4].correction.x = -INFINITY;
  EXPECT_EQ(cache.add(batch, 1), 3u);
  EXPECT_EQ(cache.size(), 3u);
}

}  // namespace
}  // namespace saccade::render
