// What a picture costs in rays and samples, as numbers: a change that makes the tracer or the schedule worse
// shows here on any machine, however busy; so does one that makes them better, which then belongs here.
// Inline runs at 160 x 120 in the bundled scenes' first camera.
//
// The numbers are those of one machine. Another kind of processor rounds a few pixels of the mask otherwise
// (llvmpipe and Embree choose their code by it: Embree's SSE2 code gives 6 of gallery's 29,469 rays less, and
// the same samples), hence the margins.
#include <gtest/gtest.h>

#include <array>

#include "core/image_io.h"
#include "core/metrics/comparison.h"
#include "core/metrics/flip.h"
#include "tests/unit/app/fixtures.h"

namespace saccade {
namespace {

using app::FrameBudget;
using app::FrameLoop;

constexpr double kRayMargin = 0.002, kSampleMargin = 0.01;
constexpr std::uint64_t kStep = 16;             // samples between two looks at relative MSE
constexpr std::uint64_t kFlipStep = 5 * kStep;  // FLIP takes its time
constexpr app::ImageSize kSize{160, 120};

struct Cost {
  const char* scene;
  double pixels, rays;                  ///< non-diffuse pixels; rays of all of them
  std::array<double, 3> relmseSamples;  ///< until relative MSE stays below kRelmseGoals of the base's
  std::array<double, 2> flipSamples;    ///< until mean FLIP stays below kFlipGoals of the base's
};
constexpr std::array<double, 3> kRelmseGoals{0.5, 0.1, 0.01};
constexpr std::array<double, 2> kFlipGoals{0.5, 0.1};

void PrintTo(const Cost& c, std::ostream* os) { *os << c.scene; }

/// The samples after which an error stayed below each goal.
template <std::size_t N>
class Reached {
 public:
  explicit Reached(const std::array<double, N>& goals) : goals_(goals) {}
  void look(double error, std::uint64_t samples) {
    for (std::size_t i = 0; i < N; ++i) {
      if (!(error < goals_[i])) {
        samples_[i] = 0;
      } else if (samples_[i] == 0) {
        samples_[i] = static_cast<double>(samples);
      }
    }
  }
  const std::array<double, N>& samples() const { return samples_; }

 private:
  std::array<double, N> goals_, samples_{};
};

class Counts : public testing::TestWithParam<Cost> {
 protected:
  const app::Workspace& workspace_ = tests::workspaceOf(tests::bundled(GetParam().scene));
  app::Headless gl_{tests::runOn("osmesa"), workspace_};
  FrameLoop loop_{workspace_, *gl_.renderer, {.threads = 0}};

  void step(std::uint64_t samples) {
    loop_.step(workspace_.scene.cameras[0], kSize, FrameBudget::firstSamples(samples));
  }
  raytrace::TraceAllResult all() { return raytrace::traceAll(loop_.tracer(), loop_.frame(), 0, {}); }
};

TEST_P(Counts, RaysAPixel) {
  step(0);
  const raytrace::TraceAllResult all = this->all();
  EXPECT_NEAR(static_cast<double>(all.traced), GetParam().pixels, kRayMargin * GetParam().pixels);
  EXPECT_NEAR(static_cast<double>(all.counters.rays), GetParam().rays, kRayMargin * GetParam().rays);
  // The frame loop shoots the very same, on any machine.
  loop_.step(workspace_.scene.cameras[0], kSize, FrameBudget::untilConverged());
  EXPECT_EQ(loop_.stats().samplesTraced, all.traced);
  EXPECT_EQ(loop_.stats().rays, all.counters.rays);
}

TEST_P(Counts, SamplesToAnError) {
  step(0);
  const core::ImageRgb reference =
      core::compositeLinear(kSize.width, kSize.height, loop_.frame().baseAndId, all().corrections);
  const core::ImageRgba8 referenceDisplay = core::toDisplay(reference, 0);
  const auto relmse = [&] { return core::relativeMse(reference, loop_.linear()); };
  const auto flip = [&] { return core::meanOf(core::flip(referenceDisplay, loop_.display())); };
  const double baseRelmse = relmse(), baseFlip = flip();
  Reached reachedRelmse(kRelmseGoals);
  Reached reachedFlip(kFlipGoals);
  while (!loop_.converged()) {
    step(kStep);
    const std::uint64_t samples = loop_.stats().samplesTraced;
    reachedRelmse.look(relmse() / baseRelmse, samples);
    if (samples % kFlipStep == 0) reachedFlip.look(flip() / baseFlip, samples);
  }
  const auto expectNear = [](const auto& expected, const auto& samples, std::uint64_t resolution) {
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR(samples[i], expected[i],
                  std::max(kSampleMargin * expected[i], static_cast<double>(resolution)))
          << "goal " << i;
    }
  };
  expectNear(GetParam().relmseSamples, reachedRelmse.samples(), kStep);
  expectNear(GetParam().flipSamples, reachedFlip.samples(), kFlipStep);
}

// Relative MSE falls late: a coarse splat that met a lamp's reflection is brighter than all that is right.
constexpr Cost kCosts[] = {{"cornell.glb", 2246, 9749, {1792, 1808, 2176}, {80, 1360}},
                           {"table.glb", 2710, 19067, {1440, 2368, 2688}, {240, 1440}},
                           {"gallery.glb", 5936, 29469, {5776, 5904, 5904}, {1040, 5280}}};
INSTANTIATE_TEST_SUITE_P(Scenes, Counts, testing::ValuesIn(kCosts));

}  // namespace
}  // namespace saccade
