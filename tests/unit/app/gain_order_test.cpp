// Samples go where samples have changed the picture: from the batches of one frame to the order of the next.
#include <gtest/gtest.h>

#include <map>

#include "tests/unit/app/fixtures.h"

namespace saccade {
namespace {

using app::FrameBudget;
using app::FrameLoop;
using attention::Order;

constexpr app::ImageSize kSize{160, 120};

class GainOrder : public testing::Test {
 protected:
  const app::Workspace& workspace_ = tests::workspaceOf(tests::bundled("cornell.glb"));
  app::Headless gl_{tests::runOn("osmesa"), workspace_};

  /// The object that the second of two views corrects first, when samples of the first view make `changed`
  /// white and leave all others as the base has them.
  std::uint32_t firstOfSecondView(Order order, std::uint32_t changed) {
    app::FrameLoopOptions options{.threads = 0};
    options.corrective.attention.order = order;
    FrameLoop loop(workspace_, *gl_.renderer, options);
    loop.onBatch = [changed](core::SampleBatch& batch) {
      for (core::Sample& s : batch.samples) s.correction = core::Vec3(s.id == changed ? 10.0f : 0.0f);
    };
    core::Camera camera = workspace_.scene.cameras[0];
    loop.step(camera, kSize, FrameBudget::firstSamples(2000));
    camera.eye.x += 0.01f;
    std::uint32_t first = 0;
    loop.onBatch = [&first](core::SampleBatch& batch) {
      if (first == 0 && !batch.samples.empty()) first = batch.samples.front().id;
    };
    loop.step(camera, kSize, FrameBudget::firstSamples(10));
    return first;
  }
  std::vector<std::uint32_t> visible() {
    FrameLoop loop(workspace_, *gl_.renderer, {.threads = 0});
    loop.step(workspace_.scene.cameras[0], kSize, FrameBudget::firstSamples(0));
    std::vector<std::uint32_t> ids;
    for (std::uint32_t id = 1; id < loop.frame().extents.size(); ++id) {
      if (loop.frame().extents[id].pixels > 100) ids.push_back(id);
    }
    return ids;
  }
};

TEST_F(GainOrder, TheObjectThatSamplesChangedComesFirst) {
  const auto ids = visible();
  ASSERT_GE(ids.size(), 2u);
  for (const std::uint32_t id : ids) {
    for (const Order order : {Order::gain, Order::attention}) EXPECT_EQ(firstOfSecondView(order, id), id);
  }
}

TEST_F(GainOrder, ImportanceAloneDoesNotAsk) {
  const auto ids = visible();
  for (const std::uint32_t id : ids) {
    EXPECT_EQ(firstOfSecondView(Order::scanline, id), firstOfSecondView(Order::scanline, ids[0]));
  }
}

}  // namespace
}  // namespace saccade
