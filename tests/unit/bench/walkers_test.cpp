// A method on a moving camera shows what its command shows, and inline it shows the same twice.
#include "bench/methods/walkers.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <map>

#include "app/session/camera_path.h"
#include "bench/harness/experiment.h"
#include "core/image_io.h"
#include "tests/unit/bench/inline_stage.h"

namespace saccade::bench {
namespace {

constexpr app::ImageSize kSize{128, 96};
constexpr std::chrono::duration<double> kForever{1e6};

core::Camera firstCamera() { return inlineCornell().workspace->scene.cameras.at(0); }

bool samePixels(const core::ImageRgb& a, const core::ImageRgb& b) {
  return a.width() == b.width() && a.height() == b.height() &&
         std::memcmp(a.pixels().data(), b.pixels().data(), a.pixels().size() * sizeof(core::Vec3)) == 0;
}

/// What `saccade render` writes with these arguments.
core::ImageRgb rendered(const std::string& arguments) {
  const std::string file = (tests::temporaryFolder() / "rendered.exr").string();
  const std::string command = std::string(SACCADE_BINARY) + " render " + bundledScene("cornell") +
                              " --maps " + mapsOf("cornell") + " --size 128x96 -o " + file + " " + arguments +
                              " 2>/dev/null >/dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  return core::readExr(file);
}

std::unique_ptr<Walker> corrective(const attention::AttentionOptions& attention = {}, bool reuse = true) {
  return walkCorrective(inlineCornell(), kSize, attention, reuse);
}

TEST(Walkers, ShowWhatTheCommandsShow) {
  const struct {
    std::unique_ptr<Walker> walker;
    const char* arguments;
  } cases[] = {{walkBase(inlineCornell(), kSize), "--method base"},
               {walkRaytrace(inlineCornell(), kSize), "--method raytrace"},
               {walkPath(inlineCornell(), kSize), "--method path --spp 1"}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.arguments);
    c.walker->frame(firstCamera(), kForever);
    EXPECT_TRUE(samePixels(c.walker->linear(), rendered(c.arguments)));
    EXPECT_EQ(c.walker->display().pixels(), core::toDisplay(c.walker->linear(), 0).pixels());
  }
}

TEST(Walkers, CorrectiveWithAllTheTimeItNeedsIsRaytrace) {
  const auto raytrace = walkRaytrace(inlineCornell(), kSize), loop = corrective();
  raytrace->frame(firstCamera(), kForever);
  loop->frame(firstCamera(), kForever);
  EXPECT_GT(loop->stats().samplesTraced, 0u);
  EXPECT_EQ(loop->stats().samplesTraced, raytrace->stats().samplesTraced);
  EXPECT_TRUE(samePixels(loop->linear(), raytrace->linear()));
  EXPECT_EQ(loop->display().pixels(), raytrace->display().pixels());
}

TEST(Walkers, AFrameKnowsNothingOfThoseBeforeItWhereItShouldNot) {
  const app::CameraPath path = app::CameraPath::read(bundledPath("cornell"));
  for (const auto walk : {walkBase, walkRaytrace, walkPath}) {
    const auto moved = walk(inlineCornell(), kSize), fresh = walk(inlineCornell(), kSize);
    moved->frame(path.at(1), kForever);
    moved->frame(path.at(2), kForever);
    fresh->frame(path.at(2), kForever);
    EXPECT_TRUE(samePixels(moved->linear(), fresh->linear()));
    EXPECT_EQ(moved->stats().frameMs.size(), 2u);
  }
}

TEST(Walkers, ReuseIsWhatTheCacheLabelSays) {
  const app::CameraPath path = app::CameraPath::read(bundledPath("cornell"));
  for (const bool reuse : {true, false}) {
    const auto walker = corrective({}, reuse);
    for (const double seconds : {1.0, 1.02, 1.04})
      walker->frame(path.at(seconds), std::chrono::milliseconds(2));
    EXPECT_EQ(walker->stats().samplesReused > 0, reuse);
  }
}

/// A short inline walk; what the last frame shows.
core::ImageRgb walked(const Method& method, Stage& stage, const app::CameraPath& path) {
  const auto walker = method.walk(stage, kSize);
  for (const double seconds : {1.0, 1.02, 1.04})
    walker->frame(path.at(seconds), std::chrono::milliseconds(2));
  return walker->linear();
}

TEST(Methods, EveryOneWalksAndInlineTheSameTwice) {
  const app::CameraPath path = app::CameraPath::read(bundledPath("cornell"));
  for (const Method& method : allMethods()) {
    SCOPED_TRACE(method.key());
    ASSERT_TRUE(method.walk);
    EXPECT_TRUE(samePixels(walked(method, inlineCornell(), path), walked(method, inlineCornell(), path)));
  }
}

// The hall has objects enough for every order to be another one; its few in cornell are soon all done.
TEST(Methods, OrdersAndWeightsTraceOtherSamplesInTheSameTime) {
  const std::unique_ptr<Stage> hall = inlineStage("gallery");
  const app::CameraPath path = app::CameraPath::read(bundledPath("gallery"));
  std::map<std::string, core::ImageRgb> seen;
  for (const Method& method : allMethods()) {
    if (method.name == "corrective" && method.labels.at("cache") == "on")
      seen[method.variant] = walked(method, *hall, path);
  }
  ASSERT_EQ(seen.size(), 7u);
  for (const auto& [a, first] : seen) {
    for (const auto& [b, second] : seen) {
      // A weight of 1 leaves the task's importance of attention, but times the gains.
      EXPECT_EQ(samePixels(first, second), a == b) << a << " and " << b;
    }
  }
}

}  // namespace
}  // namespace saccade::bench
