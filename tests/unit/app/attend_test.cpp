// A click on an object, from the frame loop to the samples that it brings.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/app/fixtures.h"

namespace saccade {
namespace {

using app::FrameBudget;
using app::FrameLoop;

constexpr app::ImageSize kSize{160, 120};

class Attend : public testing::Test {
 protected:
  const app::Workspace& workspace_ = tests::workspaceOf(tests::bundled("cornell.glb"));
  app::Headless gl_{tests::runOn("osmesa"), workspace_};
  std::vector<std::uint32_t> ids_;  ///< of the samples of the last step, as they came

  void step(FrameLoop& loop, const FrameBudget& budget) {
    ids_.clear();
    loop.onBatch = [this](core::SampleBatch& batch) {
      for (const core::Sample& s : batch.samples) ids_.push_back(s.id);
    };
    loop.step(workspace_.scene.cameras[0], kSize, budget);
  }
  static std::uint32_t lastOf(const std::vector<std::uint32_t>& ranks) {
    return static_cast<std::uint32_t>(std::max_element(ranks.begin(), ranks.end()) - ranks.begin());
  }
};

TEST_F(Attend, AtRestTheObjectComesNextWhateverTheOrder) {
  for (const auto order : {attention::Order::attention, attention::Order::largest}) {
    app::FrameLoopOptions options{.threads = 0};
    options.corrective.attention.order = order;
    FrameLoop loop(workspace_, *gl_.renderer, options);
    step(loop, FrameBudget::firstSamples(100));
    const std::uint32_t id = lastOf(loop.ranks());
    ASSERT_GT(loop.ranks()[id], 1u);
    loop.attend(id);
    step(loop, FrameBudget::firstSamples(200));
    // What was left of the batch that the first step cut, of about a job's size, was traced before the click.
    const auto waited = std::find(ids_.begin(), ids_.end(), id) - ids_.begin();
    EXPECT_LT(waited, 2 * options.corrective.jobSize);
    EXPECT_EQ(std::count(ids_.begin() + waited, ids_.end(), id), std::ssize(ids_) - waited);
    EXPECT_GT(loop.analyzer().latest()->importance.attended[id], 0);
  }
}

TEST_F(Attend, ConvergesToTheSamePicture) {
  FrameLoop plain(workspace_, *gl_.renderer, {.threads = 0}),
      clicked(workspace_, *gl_.renderer, {.threads = 2});
  step(plain, FrameBudget::untilConverged());
  for (const std::uint32_t id : {0u, 1u, 2u, 3u, 99u}) {
    clicked.attend(id);
    step(clicked, FrameBudget::firstSamples(100));
  }
  step(clicked, FrameBudget::untilConverged());
  ASSERT_TRUE(clicked.converged());
  EXPECT_EQ(plain.linear().pixels(), clicked.linear().pixels());
  EXPECT_EQ(plain.stats().samplesTraced, clicked.stats().samplesTraced);
}

}  // namespace
}  // namespace saccade
