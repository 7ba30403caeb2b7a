// Figure 5's splats leave no pixel bare; Figure 6's samples are the lattice's.
#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "bench/paper/duck_scene.h"
#include "bench/paper/figure5.h"
#include "bench/paper/figure6.h"
#include "bench/paper/untraced_walk.h"
#include "tests/shared_folder.h"

namespace saccade::bench {
namespace {

TEST(Figure5, SplatsLeaveNoPixelBareAndSamplesAreTheLattices) {
  constexpr int kSide = 150;
  for (int last = 1; last <= core::Lattice::kMaxLevel; ++last) {
    const SplatPicture picture = drawSplats(kSide, last, 1);
    EXPECT_EQ(picture.bare, 0) << last;
    int points = 0;
    for (int y = 0; y < kSide; ++y) {
      // The window lies a largest splat away from the lattice's anchor.
      for (int x = 0; x < kSide; ++x) points += core::Lattice::contains(last, x + 161, y + 161);
    }
    EXPECT_EQ(picture.samples, points) << last;
  }
}

std::shared_ptr<core::FrameSnapshot> disc(int size) {
  auto frame = std::make_shared<core::FrameSnapshot>();
  core::Bounds bounds;
  bounds.add(core::Vec3(-1));
  bounds.add(core::Vec3(1));
  frame->view = core::View(core::Camera{}, size, size, bounds);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const int dx = 2 * x - size, dy = 2 * y - size;
      frame->baseAndId.emplace_back(0, 0, 0, dx * dx + dy * dy < size * size ? 1.0f : 0.0f);
    }
  }
  frame->depth.assign(frame->baseAndId.size(), 0.5f);
  core::measureExtents(*frame, 1, 10);
  return frame;
}

TEST(Figure6, NewSamplesAreTheMasksLatticePointsOnceEach) {
  const auto frame = disc(301);
  std::set<std::pair<int, int>> seen;
  const auto visit = [&](int x, int y, int level) {
    EXPECT_EQ(core::Lattice::levelOf(x, y), level);
    EXPECT_TRUE(seen.emplace(x, y).second);
  };
  forEachNewPoint(*frame, 1, 1, 2, visit);
  forEachNewPoint(*frame, 1, 3, 3, visit);
  std::size_t points = 0;
  for (int y = 0; y < 301; ++y) {
    for (int x = 0; x < 301; ++x) points += frame->idAt(x, y) == 1 && core::Lattice::contains(3, x, y);
  }
  EXPECT_EQ(seen.size(), points);
}

TEST(Figure6, AChromeDuckIsTheRoomsOnlyMirror) {
  SACCADE_SHARED_FILE(duck, "scenes/samples/Duck.glb");
  const core::Scene scene = thingInRoom(duck, chrome());
  EXPECT_EQ(scene.idCount(), 1u);
  for (const core::Object& o : scene.objects) {
    if (o.id == 0) continue;
    EXPECT_EQ(scene.materials[static_cast<std::size_t>(o.material)].name, "chrome");
    EXPECT_NEAR(o.bounds.lo.y, 0.45, 1e-5) << "stands on the stool";
    const core::Vec3 extent = o.bounds.extent();
    EXPECT_NEAR(std::max({extent.x, extent.y, extent.z}), 0.5, 1e-5);
  }
  EXPECT_FALSE(scene.defaultLight);
}

TEST(UntracedFrame, AFrozenCacheThawsToItsYoungestSamples) {
  core::Bounds bounds;
  bounds.add(core::Vec3(-1));
  bounds.add(core::Vec3(1));
  const core::View view(core::Camera{}, 64, 64, bounds);
  render::SampleCache cache(std::size_t{1} << 20);
  for (int age = 0; age < 3; ++age) {
    cache.age(view, {});
    core::SampleBatch batch;
    for (int i = 0; i < 300; ++i) {
      core::Sample s;
      s.x = i, s.y = age, s.id = 1, s.level = 7;
      s.position = {0, 0, -0.5f}, s.normal = {0, 0, 1}, s.cosView = 1;
      batch.samples.push_back(s);
    }
    cache.add(batch, cache.cameraAge());
  }
  const FrozenCache frozen(cache, 450);
  EXPECT_EQ(frozen.size(), 450u);
  render::SampleCache thawed(std::size_t{1} << 20);
  frozen.thaw(view, thawed);
  EXPECT_EQ(thawed.cameraAge(), cache.cameraAge());
  int byAge[3] = {0, 0, 0};
  thawed.forEach([&](const core::Sample& s, std::uint64_t age) {
    EXPECT_EQ(static_cast<std::uint64_t>(s.y) + 1, age);
    ++byAge[s.y];
  });
  EXPECT_EQ(byAge[0], 0);
  EXPECT_EQ(byAge[1], 150);
  EXPECT_EQ(byAge[2], 300);
}

}  // namespace
}  // namespace saccade::bench
