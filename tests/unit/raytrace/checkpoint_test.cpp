// Checkpoints: whole, right, or refused, and a bake that goes on from one ends with the same bits.
#include "raytrace/bake/checkpoint.h"

#include <gtest/gtest.h>

#include <fstream>
#include <memory>

#include "core/error.h"
#include "tests/temporary_folder.h"
#include "tests/unit/raytrace/bake_scenes.h"

namespace saccade::raytrace {
namespace {

using core::Vec3;
using Builder = SceneBuilder;
constexpr std::uint64_t kKey = 0x1234;
const std::string kAdvice = "start anew";

struct Room {
  core::Scene scene;
  core::Plan plan;
  ChartAtlas atlas;
  std::unique_ptr<World> world;

  Room() {
    Builder b;
    b.box(Builder::matte(0.6f), Vec3(0), Vec3(2), true);
    b.quad(Builder::matte(0, Vec3(5)), Vec3(0.8f, 1.9f, 0.8f), Vec3(0.4f, 0, 0), Vec3(0, 0, 0.4f));
    scene = std::move(b.scene);
    plan.lightmapSize = 48;
    atlas = makeCharts(scene, plan, 48);
    core::applyCharts(scene, atlas.charts);
    world = std::make_unique<World>(scene, plan);
  }
  std::unique_ptr<BakeJob> job(std::uint64_t photons = 20000, std::uint32_t seed = 1) const {
    BakeOptions o;
    o.quality = "preview";
    o.photons = photons;
    o.seed = seed;
    return std::make_unique<BakeJob>(*world, atlas.size, o);
  }
};

std::filesystem::path fileNamed(const std::string& name) { return tests::temporaryFolder() / name; }

std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
void write(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

TEST(Checkpoint, BakeGoneOnWithAfterEveryPieceHasTheSameBits) {
  const Room room;
  auto whole = room.job();
  ASSERT_TRUE(whole->advance({}, {}));
  auto job = room.job();
  const std::filesystem::path file = fileNamed("pieces.part");
  int pauses = 0;
  for (; !job->advance(stopped(), {}); ++pauses) {
    writeCheckpoint(file, kKey, *job);
    auto next = room.job();
    readCheckpoint(file, kKey, *next, kAdvice);
    for (std::size_t i = 0; i < job->stages().size(); ++i) {
      EXPECT_EQ(next->stages()[i].done, job->stages()[i].done);
      EXPECT_EQ(next->stages()[i].seconds, job->stages()[i].seconds);
    }
    job = std::move(next);
  }
  EXPECT_GT(pauses, 10);
  const auto finished = [&](BakeJob& j) { return j.finish(room.atlas.charts, {}, {}).texels; };
  EXPECT_EQ(finished(*job), finished(*whole));
}

TEST(Checkpoint, WhatIsNotFoundYetCostsNothing) {
  const Room room;
  auto job = room.job();
  const std::filesystem::path file = fileNamed("size.part");
  writeCheckpoint(file, kKey, *job);
  EXPECT_LT(std::filesystem::file_size(file), 400u);
  ASSERT_TRUE(job->advance({}, {}));
  writeCheckpoint(file, kKey, *job);
  std::size_t results = 0;
  for (const BakeStage& stage : job->stages()) results += stage.results.size();
  EXPECT_LT(std::filesystem::file_size(file), results);
}

TEST(Checkpoint, EveryTruncationAndFlippedBitsAreRefusedAndChangeNothing) {
  const Room room;
  auto job = room.job();
  for (int i = 0; i < 3; ++i) job->advance(stopped(), {});
  const std::filesystem::path good = fileNamed("good.part"), bad = fileNamed("bad.part");
  writeCheckpoint(good, kKey, *job);
  const std::string whole = bytesOf(good);
  auto fresh = room.job();
  const std::size_t step = std::max<std::size_t>(1, whole.size() / 60);
  for (std::size_t n = 0; n < whole.size(); n += n < 60 ? 1 : step) {
    write(bad, whole.substr(0, n));
    EXPECT_THROW(readCheckpoint(bad, kKey, *fresh, kAdvice), core::Error) << n;
    std::string flipped = whole;
    flipped[n] = static_cast<char>(flipped[n] ^ 0x10);
    write(bad, flipped);
    EXPECT_THROW(readCheckpoint(bad, kKey, *fresh, kAdvice), core::Error) << n;
  }
  write(bad, whole + "x");
  EXPECT_THROW(readCheckpoint(bad, kKey, *fresh, kAdvice), core::Error);
  for (const BakeStage& stage : fresh->stages()) {
    EXPECT_EQ(stage.done, 0u);
    EXPECT_TRUE(std::all_of(stage.results.begin(), stage.results.end(),
                            [](std::byte b) { return b == std::byte{0}; }));
  }
}

TEST(Checkpoint, AnotherScenesOrBakesIsRefusedInOneLineWithTheAdvice) {
  const Room room;
  auto job = room.job();
  job->advance(stopped(), {});
  const std::filesystem::path file = fileNamed("foreign.part");
  writeCheckpoint(file, kKey, *job);
  const auto refusal = [&](std::uint64_t key, BakeJob& other) -> std::string {
    try {
      readCheckpoint(file, key, other, kAdvice);
    } catch (const core::Error& e) {
      return e.what();
    }
    return "";
  };
  const std::string otherScene = refusal(kKey + 1, *room.job());
  const std::string otherPhotons = refusal(kKey, *room.job(30000)),
                    otherSeed = refusal(kKey, *room.job(20000, 2));
  EXPECT_NE(otherScene.find("another scene"), std::string::npos) << otherScene;
  EXPECT_NE(otherPhotons.find("other settings"), std::string::npos) << otherPhotons;
  EXPECT_NE(otherSeed.find("other settings"), std::string::npos) << otherSeed;
  for (const std::string& line : {otherScene, otherPhotons, otherSeed}) {
    EXPECT_NE(line.find(file.string()), std::string::npos);
    EXPECT_TRUE(line.ends_with(kAdvice)) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos);
  }
  EXPECT_EQ(refusal(kKey, *room.job()), "");
}

}  // namespace
}  // namespace saccade::raytrace
