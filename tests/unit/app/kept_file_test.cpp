// The file of kept samples: round trip, and every way in which it can be damaged.
#include "app/session/kept_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "core/content_hash.h"
#include "core/error.h"
#include "tests/unit/core/temporary_folder.h"

namespace saccade {
namespace {

using app::KeptFile;
using app::KeptVisit;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kPlenty = std::size_t{16} << 20;
constexpr std::uint32_t kIds = 9;
constexpr std::size_t kSampleBytes = 72, kAgeBytes = 20;
constexpr std::size_t kHead = 16 + 40 + 40 + 8 + 16;  ///< up to the number of ages
constexpr std::size_t kFirstSample = kHead + 8 + kAgeBytes;

core::Sample sampleOf(std::mt19937& random) {
  std::uniform_real_distribution<float> u(-1, 1);
  const auto vector = [&] { return core::Vec3(u(random), u(random), u(random)); };
  core::Sample s;
  s.x = static_cast<std::int32_t>(random() % 16384);
  s.y = static_cast<std::int32_t>(random() % 16384);
  s.id = 1 + random() % kIds;
  s.level = static_cast<std::uint8_t>(1 + random() % core::Lattice::kMaxLevel);
  s.thread = static_cast<std::uint8_t>(random());
  s.fromDepth = random() % 2 == 0;
  s.correction = vector(), s.position = vector(), s.normal = vector();
  s.cosView = u(random), s.viewDepth = 5 + u(random);
  s.toEye = vector(), s.changeRate = u(random);
  return s;
}

/// Of ages 3, 5 and 8, the last being the camera's.
void fill(render::SampleCache& cache, std::size_t samplesEach) {
  std::mt19937 random(3);
  for (const std::uint64_t age : {3, 5, 8}) {
    core::SampleBatch batch;
    for (std::size_t i = 0; i < samplesEach; ++i) batch.samples.push_back(sampleOf(random));
    cache.restore(batch, age, 100.0f + static_cast<float>(age));
  }
}

KeptVisit someVisit() {
  KeptVisit v;
  v.origin = {1, 2, 3, 4, 5};
  v.end.camera.eye = {1, 2, 3};
  v.end.camera.up = {0, 1, 0.5f};
  v.end.camera.fovYDegrees = 47;
  v.end.size = {640, 480};
  v.end.aging = 6, v.end.mask = 7;
  return v;
}

class KeptFileTest : public testing::Test {
 protected:
  const tests::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "x.samples";

  Bytes written(std::size_t samplesEach) const {
    render::SampleCache cache(kPlenty);
    fill(cache, samplesEach);
    EXPECT_EQ(app::writeKept(file_, someVisit(), cache, kPlenty), 3 * samplesEach);
    return core::readWholeFile(file_);
  }
  /// With a checksum that is right.
  void put(Bytes bytes) const {
    core::ContentHash hash;
    ASSERT_LT(bytes.size(), std::size_t{1} << 20) << "one piece";
    bytes.resize(bytes.size() - 8);
    hash.add(bytes);
    const std::uint64_t sum = hash.value();
    bytes.insert(bytes.end(), reinterpret_cast<const std::uint8_t*>(&sum),
                 reinterpret_cast<const std::uint8_t*>(&sum) + 8);
    core::writeFileAtomically(file_, bytes);
  }
  /// One line that says what was found; the cache stays empty.
  void expectRefused(const std::string& why) const {
    render::SampleCache cache(kPlenty);
    try {
      KeptFile(file_, {}).samples(kIds, cache);
      ADD_FAILURE() << "taken";
    } catch (const core::Error& e) {
      EXPECT_NE(std::string(e.what()).find(why), std::string::npos) << e.what();
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
    }
    EXPECT_EQ(cache.size(), 0u);
  }
  template <class T>
  void expectRefusedWith(Bytes bytes, std::size_t at, T value, const std::string& why) const {
    std::memcpy(bytes.data() + at, &value, sizeof value);
    put(std::move(bytes));
    expectRefused(why);
  }
};

TEST_F(KeptFileTest, RoundTrip) {
  render::SampleCache cache(kPlenty), again(kPlenty);
  fill(cache, 1000);
  app::writeKept(file_, someVisit(), cache, kPlenty);
  const KeptFile file(file_, {});
  file.samples(kIds, again);
  EXPECT_EQ(again.cameraAge(), 8u);
  const auto content = [](const render::SampleCache& c) {
    Bytes all;
    const auto add = [&](const auto& value) {
      const auto* from = reinterpret_cast<const std::uint8_t*>(&value);
      all.insert(all.end(), from, from + sizeof value);
    };
    c.forEachAge([&](std::uint64_t age, float pixelsPerRadian, std::size_t samples) {
      add(age), add(pixelsPerRadian), add(samples);
    });
    c.forEach([&](const core::Sample& s, std::uint64_t age) {
      add(s.x), add(s.y), add(s.id), add(s.level), add(s.thread), add(s.fromDepth), add(s.correction);
      add(s.position), add(s.normal), add(s.cosView), add(s.viewDepth), add(s.toEye), add(s.changeRate),
          add(age);
    });
    return all;
  };
  EXPECT_EQ(content(again), content(cache));
  const KeptVisit& v = file.visit();
  const KeptVisit expected = someVisit();
  EXPECT_TRUE(v.end.samePicture(expected.end));
  EXPECT_EQ(v.end.aging, 6u);
  EXPECT_EQ(v.end.mask, 7u);
  EXPECT_EQ(v.origin.scene, 1u);
  EXPECT_EQ(v.origin.maps, 2u);
  EXPECT_EQ(v.origin.settings, 3u);
  EXPECT_EQ(v.origin.program, 4u);
  EXPECT_EQ(v.origin.machine, 5u);
}

TEST_F(KeptFileTest, TheLayoutIsTheOneThatTheHeaderStates) {
  const Bytes bytes = written(7);
  EXPECT_EQ(bytes.size(), kHead + 8 + 3 * (kAgeBytes + 7 * kSampleBytes) + 8);
  EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + 8), "SACSAMPL");
  const auto at = [&](std::size_t where) { return static_cast<int>(bytes[where]); };
  EXPECT_EQ(at(8), static_cast<int>(app::kKeptVersion));
  EXPECT_EQ(at(12), static_cast<int>(kSampleBytes));
  for (int hash = 0; hash < 5; ++hash) EXPECT_EQ(at(16 + 8 * static_cast<std::size_t>(hash)), hash + 1);
  EXPECT_EQ(at(kHead), 3);
  EXPECT_EQ(at(kHead + 8), 3);
  EXPECT_EQ(at(kHead + 8 + 12), 7);
}

TEST_F(KeptFileTest, TheOldestAreLeftOut) {
  render::SampleCache cache(kPlenty);
  fill(cache, 100);
  const std::size_t bytes = kHead + 8 + 3 * kAgeBytes + 8 + 150 * kSampleBytes + kSampleBytes / 2;
  EXPECT_EQ(app::writeKept(file_, someVisit(), cache, bytes), 150u);
  EXPECT_LE(std::filesystem::file_size(file_), bytes);
  render::SampleCache again(kPlenty);
  KeptFile(file_, {}).samples(kIds, again);
  std::vector<std::size_t> counts;
  again.forEachAge([&](std::uint64_t, float, std::size_t samples) { counts.push_back(samples); });
  EXPECT_EQ(counts, (std::vector<std::size_t>{50, 100}));
  EXPECT_EQ(app::writeKept(file_, someVisit(), cache, 10), 0u);
  render::SampleCache none(kPlenty);
  KeptFile(file_, {}).samples(kIds, none);
  EXPECT_EQ(none.size(), 0u);
  EXPECT_EQ(none.cameraAge(), 8u);
}

TEST_F(KeptFileTest, CutAnywhere) {
  const Bytes bytes = written(20);
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    core::writeFileAtomically(file_, std::span(bytes).first(n));
    expectRefused("file of kept samples");
  }
}

TEST_F(KeptFileTest, AnyBitFlipped) {
  const Bytes bytes = written(2);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    Bytes damaged = bytes;
    damaged[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    core::writeFileAtomically(file_, damaged);
    expectRefused("file of kept samples");
  }
}

TEST_F(KeptFileTest, NumbersThatNoWalkMakes) {
  const Bytes bytes = written(5);
  const std::string samples = "samples that no walk makes", ages = "ages that no walk has";
  const float nan = std::nanf("");
  for (std::size_t field = kFirstSample + 12; field < kFirstSample + kSampleBytes; field += 4) {
    expectRefusedWith(bytes, field, nan, samples);
    expectRefusedWith(bytes, field, INFINITY, samples);
  }
  expectRefusedWith(bytes, kFirstSample + 4, std::uint32_t{0}, samples);
  expectRefusedWith(bytes, kFirstSample + 4, kIds + 1, samples);
  expectRefusedWith(bytes, kFirstSample + 4, 0xffffffffu, samples);
  expectRefusedWith(bytes, kFirstSample + 8, std::uint8_t{0}, samples);
  expectRefusedWith(bytes, kFirstSample + 8, std::uint8_t{8}, samples);
  expectRefusedWith(bytes, kHead + 8, std::uint64_t{0}, ages);
  expectRefusedWith(bytes, kHead + 8, std::uint64_t{7}, ages);  // before age 5
  expectRefusedWith(bytes, kHead + 8, ~std::uint64_t{0}, ages);
  expectRefusedWith(bytes, kHead + 16, nan, ages);
  expectRefusedWith(bytes, kHead + 16, -1.0f, ages);
  for (const std::uint64_t count : {std::uint64_t{1} << 62, ~std::uint64_t{0}, std::uint64_t{1000}})
    expectRefusedWith(bytes, kHead + 20, count, "");
  for (const std::uint64_t count : {std::uint64_t{0}, std::uint64_t{2}, std::uint64_t{4}, ~std::uint64_t{0}})
    expectRefusedWith(bytes, kHead, count, "");
  expectRefusedWith(bytes, kHead - 24, -1, "image size");
  expectRefusedWith(bytes, kHead - 20, 1 << 20, "image size");
  expectRefusedWith(bytes, 8, app::kKeptVersion + 1, "another version of saccade");
  expectRefusedWith(bytes, 12, std::uint32_t{57}, "another version of saccade");
  Bytes longer = bytes;
  longer.insert(longer.end() - 8, 3, 0);
  put(longer);
  expectRefused("another number of samples");
}

TEST_F(KeptFileTest, WhatIsNoFileOfSamples) {
  for (const std::string& foreign : {std::string(), std::string("P6"), std::string(5000, 'x')}) {
    core::writeFileAtomically(file_, Bytes(foreign.begin(), foreign.end()));
    expectRefused("file of kept samples");
  }
  std::filesystem::remove(file_);
  expectRefused("no such file");
  std::filesystem::create_directory(file_);
  expectRefused("not a regular file");
  std::filesystem::remove(file_);
  written(1000);
  core::LoadLimits little;
  little.memoryBytes = 10000;
  EXPECT_THROW(KeptFile(file_, little), core::Error);
}

TEST_F(KeptFileTest, WhereNothingCanBeWritten) {
  render::SampleCache cache(kPlenty);
  fill(cache, 10);
  EXPECT_THROW(app::writeKept("/proc/x.samples", someVisit(), cache, kPlenty), core::Error);
  EXPECT_THROW(app::writeKept(folder_ / "none" / "x.samples", someVisit(), cache, kPlenty), core::Error);
  EXPECT_EQ(folder_.entries(), 0u);
}

}  // namespace
}  // namespace saccade
