// `walk --keep-cache`: a second visit begins where the first ended, and still ends at the ray-traced image.
#include "app/session/kept_cache.h"

#include <gtest/gtest.h>

#include <string>

#include "app/session/camera_path.h"
#include "tests/command_line.h"
#include "tests/unit/app/fixtures.h"
#include "tests/unit/core/own_cache_folder.h"

namespace saccade {
namespace {

using app::FrameBudget;
using app::FrameLoop;
using app::FrameLoopOptions;
using app::KeptCache;

constexpr app::ImageSize kSize{200, 150};

class KeptVisits : public testing::TestWithParam<int> {
 protected:
  const app::Workspace& workspace_ = tests::workspaceOf(tests::bundled("cornell.glb"));
  app::Headless gl_{tests::runOn("osmesa"), workspace_};
  const core::Camera home_ = workspace_.scene.cameras[0];
  const tests::OwnCacheFolder folder_;

  FrameLoopOptions options() const { return {.threads = GetParam(), .asynchronousAnalysis = GetParam() > 0}; }
  KeptCache kept(const app::CorrectiveOptions& corrective = {}, std::uint32_t seed = 1) const {
    return {workspace_, {}, corrective, seed};
  }
  /// Some frames of an orbit that end at the first camera, then `samples` more there.
  void walk(FrameLoop& loop, std::uint64_t samples) const {
    const app::CameraPath path = app::CameraPath::orbit(home_, 30);
    for (int i = 12; i > 0; --i)
      loop.step(path.at(i / 25.0), kSize, FrameBudget::untilDeadline(std::chrono::milliseconds(5)));
    loop.step(home_, kSize, FrameBudget::firstSamples(samples));
  }
  void expectConvergesToRayTraced(FrameLoop& loop, const core::Camera& camera) const {
    loop.step(camera, kSize, FrameBudget::untilConverged());
    ASSERT_TRUE(loop.converged());
    EXPECT_EQ(tests::largestDifference(loop.linear(), tests::rayTraced(workspace_, loop.frame())), 0);
  }
};

TEST_P(KeptVisits, TheSecondBeginsWithThePictureThatTheFirstEndedWith) {
  FrameLoop first(workspace_, *gl_.renderer, options());
  walk(first, 2000);
  const std::uint32_t exact = first.layer().exactCount();
  ASSERT_GE(exact, 2000u);
  ASSERT_LT(exact, first.frame().nonDiffusePixels);
  kept().keep(first);

  FrameLoop second(workspace_, *gl_.renderer, options());
  kept().restore(second);
  EXPECT_EQ(second.cache().size(), first.cache().size());
  second.step(home_, kSize, FrameBudget::firstSamples(0));
  EXPECT_EQ(second.stats().samplesTraced, 0u);
  EXPECT_EQ(second.stats().samplesResumed, exact);
  EXPECT_GE(second.layer().exactCount(), exact);
  if (GetParam() == 0) {  // else samples for older cameras came in late: more to show than the first did
    EXPECT_EQ(second.layer().coveredCount(), first.layer().coveredCount());
    EXPECT_EQ(tests::largestDifference(second.linear(), first.linear()), 0);
  }
  expectConvergesToRayTraced(second, home_);
  EXPECT_EQ(second.stats().samplesTraced + exact, second.frame().nonDiffusePixels);
}

TEST_P(KeptVisits, ASecondFromElsewhereBeginsWithPlaceholders) {
  FrameLoop first(workspace_, *gl_.renderer, options());
  walk(first, 2000);
  kept().keep(first);
  core::Camera beside = home_;
  beside.eye.x += 0.02f;

  FrameLoop second(workspace_, *gl_.renderer, options());
  kept().restore(second);
  second.step(beside, kSize, FrameBudget::firstSamples(0));
  EXPECT_GT(second.stats().samplesReused, 1000u);
  EXPECT_EQ(second.stats().samplesResumed, 0u);
  EXPECT_EQ(second.layer().exactCount(), 0u);
  expectConvergesToRayTraced(second, beside);
  expectConvergesToRayTraced(second, home_);
}

TEST_P(KeptVisits, AWalkWithKeptSamplesThenRestEqualsRayTraced) {
  for (int visit = 0; visit < 3; ++visit) {
    FrameLoop loop(workspace_, *gl_.renderer, options());
    kept().restore(loop);
    EXPECT_EQ(loop.cache().size() > 0, visit > 0);
    walk(loop, 500);
    expectConvergesToRayTraced(loop, home_);
    kept().keep(loop);
  }
}
INSTANTIATE_TEST_SUITE_P(Threads, KeptVisits, testing::Values(0, 1, 2, 8));

class KeptSamples : public KeptVisits {
 protected:
  /// One visit, and what its file holds.
  app::KeptVisit visit(std::uint64_t samples = 2000) {
    FrameLoop loop(workspace_, *gl_.renderer, options());
    walk(loop, samples);
    kept().keep(loop);
    return app::KeptFile(kept().file(), {}).visit();
  }
  void rewrite(const app::KeptVisit& visit) const {
    render::SampleCache cache(std::size_t{64} << 20);
    app::KeptFile(kept().file(), {}).samples(workspace_.scene.idCount(), cache);
    app::writeKept(kept().file(), visit, cache, std::size_t{64} << 20);
  }
  void expectExactAtOnce(bool exact, const FrameLoopOptions& with) {
    FrameLoop loop(workspace_, *gl_.renderer, with);
    kept().restore(loop);
    EXPECT_GT(loop.cache().size(), 0u);
    loop.step(home_, kSize, FrameBudget::firstSamples(0));
    EXPECT_EQ(loop.stats().samplesResumed > 0, exact);
    EXPECT_EQ(loop.layer().exactCount() > 0, exact);
    EXPECT_GT(loop.layer().coveredCount(), 2000u);
    expectConvergesToRayTraced(loop, home_);
  }
};

TEST_P(KeptSamples, AreExactOnlyWhereEverythingIsTheSame) {
  const app::KeptVisit good = visit();
  expectExactAtOnce(true, options());
  app::KeptVisit other = good;
  other.origin.machine ^= 1;
  rewrite(other);
  expectExactAtOnce(false, options());
  other = good;
  other.end.mask ^= 1;  // another rasteriser
  rewrite(other);
  expectExactAtOnce(false, options());
  other = good;
  other.end.size.width += 1;
  rewrite(other);
  expectExactAtOnce(false, options());
  rewrite(good);
  FrameLoopOptions stricter = options();
  stricter.corrective.delta = 0.05f;
  expectExactAtOnce(false, stricter);
  expectExactAtOnce(true, options());
}

TEST_P(KeptSamples, OfAnotherOriginAreNotUsed) {
  const app::KeptVisit good = visit();
  for (std::uint64_t app::SampleOrigin::*part : {&app::SampleOrigin::scene, &app::SampleOrigin::maps,
                                                 &app::SampleOrigin::settings, &app::SampleOrigin::program}) {
    app::KeptVisit other = good;
    other.origin.*part ^= 1;
    rewrite(other);
    FrameLoop loop(workspace_, *gl_.renderer, options());
    kept().restore(loop);
    EXPECT_EQ(loop.cache().size(), 0u);
    rewrite(good);
  }
  app::CorrectiveOptions twice;
  twice.samplesPerPixel = 2;
  const auto sizeWith = [&](const KeptCache& cache) {
    FrameLoop loop(workspace_, *gl_.renderer, options());
    cache.restore(loop);
    return loop.cache().size();
  };
  EXPECT_EQ(sizeWith(kept(twice)), 0u);
  EXPECT_EQ(sizeWith(kept({}, 2)), 0u);
  app::CorrectiveOptions elsewise;
  elsewise.delta = 0.3f, elsewise.nMin = 20, elsewise.maxAge = 7, elsewise.jobSize = 8;
  EXPECT_GT(sizeWith(kept(elsewise)), 2000u);
}

TEST_P(KeptSamples, StayWithinTheBound) {
  FrameLoopOptions small = options();
  small.corrective.cacheMb = 1;
  FrameLoop loop(workspace_, *gl_.renderer, options());
  loop.step(home_, {480, 360}, FrameBudget::untilConverged());
  kept(small.corrective).keep(loop);
  EXPECT_LE(std::filesystem::file_size(kept().file()), std::size_t{1} << 20);
  kept().keep(loop);
  ASSERT_GT(std::filesystem::file_size(kept().file()), std::size_t{1} << 20);
  FrameLoop second(workspace_, *gl_.renderer, small);
  kept(small.corrective).restore(second);
  EXPECT_LE(second.cache().bytes(), std::size_t{1} << 20);
  EXPECT_GT(second.cache().size(), 10'000u);
  expectConvergesToRayTraced(second, home_);
}
INSTANTIATE_TEST_SUITE_P(Inline, KeptSamples, testing::Values(0));

std::string walkWith(const std::string& maps, const std::string& options = "") {
  return "walk '" + tests::bundled("cornell.glb").string() +
         "' --headless --seconds 0.1 --size 64x48 --samples 300 --threads 1 --keep-cache --quality preview "
         "--maps '" +
         (tests::temporaryFolder() / maps).string() + "' " + options;
}
const std::string kWalk = walkWith("kept.maps");

TEST(KeepCacheOption, SaysInOneLineWhatItDid) {
  const auto said = [](const std::string& walk, const std::string& words) {
    const tests::Ran ran = tests::saccade(walk);
    EXPECT_EQ(ran.status, 0) << ran.err;
    const std::size_t at = ran.err.find(words);
    EXPECT_NE(at, std::string::npos) << words << "\n" << ran.err;
    EXPECT_EQ(ran.err.rfind(words), at) << ran.err;
    EXPECT_EQ(ran.err.find("warning"), std::string::npos) << ran.err;
  };
  said(kWalk, "for the next visit");
  said(kWalk, "samples of the last visit");
  said(kWalk + "--spp 2", "not used: --spp or --seed has changed");
  said(kWalk + "--spp 2 --delta 0.2 --camera 0", "beginning with");
  said(kWalk + "--spp 2 --record '" + (tests::temporaryFolder() / "kept.session").string() + "'",
       "the samples of the last visit are not used");
  said(walkWith("seed2.maps", "--seed 2"), "not used: the illumination maps have changed");
  said(walkWith("diffuse.maps", "--nondiffuse 0.9"), "not used: the scene has changed");
}

TEST(KeepCacheOption, AFullDiskIsAWarning) {
  tests::saccade(kWalk);  // bakes
  const tests::Ran ran = tests::saccade(kWalk, "trap '' XFSZ; ulimit -f 8; ");
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.err.find("the samples of this visit are lost"), std::string::npos) << ran.err;
  const tests::Ran next = tests::saccade(kWalk);
  EXPECT_NE(next.err.find("beginning with"), std::string::npos) << "the old file is whole: " << next.err;
}

TEST(KeepCacheOption, ADamagedFileIsAWarningAndWrittenAnew) {
  tests::saccade(kWalk);
  for (const auto& entry : std::filesystem::directory_iterator(tests::temporaryFolder() / "cache/saccade")) {
    if (entry.path().extension() == ".samples") std::filesystem::resize_file(entry.path(), 5000);
  }
  const tests::Ran ran = tests::saccade(kWalk);
  EXPECT_EQ(ran.status, 0) << ran.err;
  const std::size_t warning = ran.err.find("warning: ");
  EXPECT_EQ(ran.err.rfind("warning: "), warning) << ran.err;
  EXPECT_NE(ran.err.find("damaged or cut off; it will be written anew"), std::string::npos) << ran.err;
  EXPECT_NE(tests::saccade(kWalk).err.find("beginning with"), std::string::npos);
}

}  // namespace
}  // namespace saccade
