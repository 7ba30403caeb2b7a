#include "bench/approximation/approximation.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "app/cli/options.h"
#include "bench/harness/method.h"
#include "core/composite.h"
#include "core/image_io.h"
#include "core/metrics/flip.h"

namespace saccade::bench {
namespace {

constexpr app::ImageSize kSize{512, 512};
constexpr std::uint64_t kSamples[] = {0, 100, 1000, 10000};
constexpr double kBudgetsMs[] = {33, 100};

/// Of what is displayed, over the pixels of the mask.
struct MaskedError {
  double rmse = 0, flip = 0;
};

MaskedError errorOf(const core::FrameSnapshot& frame, const core::ImageRgba8& truth,
                    const core::ImageRgba8& shown) {
  const core::ImageGray map = core::flip(truth, shown);
  MaskedError sum;
  for (std::size_t i = 0; i < frame.ids.size(); ++i) {
    if (frame.ids[i] == 0) continue;
    const core::Rgba8 a = truth.pixels()[i], b = shown.pixels()[i];
    for (const int d : {a.r - b.r, a.g - b.g, a.b - b.b}) sum.rmse += d * d / (255.0 * 255.0);
    sum.flip += static_cast<double>(map.pixels()[i]);
  }
  const double pixels = std::max(1u, frame.nonDiffusePixels);
  return {std::sqrt(sum.rmse / (3 * pixels)), sum.flip / pixels};
}

/// One frame from a cold start.
struct Shot {
  MaskedError with, without;
  double bareShare = 0;  ///< of the mask, without a splat
  double probesMs = 0;
  double shadeNs = 0;  ///< a bare pixel
  core::ImageRgba8 picture;
};

class SceneRun {
 public:
  SceneRun(Session& session, const std::string& file)
      : session_(session), stage_(openStage(file, "preview", session.options().seed, session.stop())) {
    camera_ = app::chooseCamera(stage_->workspace->scene, {});
    const auto loop = pinnedLoop(*stage_, options(false));
    loop->step(camera_, kSize, app::FrameBudget::untilConverged(), session.stop());
    truth_ = loop->display();
  }

  void measure() {
    const LoadWatch watch;
    for (const std::uint64_t samples : kSamples) {
      const Shot shot = shoot(app::FrameBudget::firstSamples(samples));
      add(shot, "@" + std::to_string(samples), std::to_string(samples) + " samples", nullptr);
      if (samples == 0) addCosts(shot, watch);
    }
    for (const double ms : kBudgetsMs) {
      const std::string name = std::to_string(static_cast<int>(ms)) + " ms";
      const auto budget = app::FrameBudget::untilDeadline(std::chrono::duration<double, std::milli>(ms));
      add(shoot(budget), "@" + std::to_string(static_cast<int>(ms)) + "ms", name, &watch);
    }
  }

 private:
  app::FrameLoopOptions options(bool approximation) const {
    app::FrameLoopOptions o;
    o.threads = stage_->tracers;
    o.seed = stage_->seed;
    o.corrective.approximation = approximation;
    o.probesAFrame = render::Approximation::kMostProbes;
    return o;
  }

  Shot shoot(const app::FrameBudget& budget) {
    session_.checkStop();
    const auto loop = pinnedLoop(*stage_, options(true));
    loop->step(camera_, kSize, budget, session_.stop());
    const core::FrameSnapshot& frame = loop->frame();
    Shot shot;
    core::ImageRgba8 corrected;
    core::compositeDisplay(kSize.width, kSize.height, frame.baseAndId, loop->corrections(), 0, corrected);
    shot.with = errorOf(frame, truth_, loop->display());
    shot.without = errorOf(frame, truth_, corrected);
    const double mask = std::max(1u, frame.nonDiffusePixels);
    const double bare = mask - loop->layer().coveredCount();
    shot.bareShare = bare / mask;
    const auto& stages = loop->stats().stageMs;
    if (stages.contains("probes")) shot.probesMs = stages.at("probes");
    // The analysis before the first sample has looked at the picture too: all of the mask.
    if (stages.contains("approximate")) shot.shadeNs = 1e6 * stages.at("approximate") / (mask + bare);
    shot.picture = loop->display();
    return shot;
  }

  void add(const Shot& shot, const std::string& at, const std::string& setting, const LoadWatch* watch) {
    Record record;
    record.key = "approximation/" + stage_->name + at;
    record.labels = {{"scene", stage_->name}, {"after", setting}};
    record.values = {{"rmse_with", Value::error(shot.with.rmse)},
                     {"rmse_without", Value::error(shot.without.rmse)},
                     {"flip_with", Value::error(shot.with.flip)},
                     {"flip_without", Value::error(shot.without.flip)},
                     {"bare_share", Value::error(shot.bareShare)}};
    if (at == "@0") record.files["picture"] = session_.picture("approximation_" + stage_->name, shot.picture);
    session_.add(std::move(record), watch);
  }

  void addCosts(const Shot& shot, const LoadWatch& watch) {
    Record record;
    record.key = "approximation/" + stage_->name;
    record.labels = {{"scene", stage_->name}};
    record.values = {{"probes_ms", Value::milliseconds({shot.probesMs})},
                     {"shade_ns", Value::milliseconds({shot.shadeNs})}};
    record.values["shade_ns"].unit = "ns";
    session_.add(std::move(record), &watch);
  }

  Session& session_;
  std::unique_ptr<Stage> stage_;
  core::Camera camera_;
  core::ImageRgba8 truth_;
};

}  // namespace

void measureApproximation(Session& session) {
  std::vector<std::string> scenes = session.options().scenes;
  if (scenes.empty()) {
    for (const char* name : {"cornell", "table", "gallery"}) scenes.push_back(bundledScene(name));
    if (const auto glossy = sharedFile("references/cycles/cornell_glossy.glb")) scenes.push_back(*glossy);
  }
  for (const std::string& file : scenes) {
    session.say("approximation: " + sceneName(file));
    const Pinned main(mainCores());
    SceneRun(session, file).measure();
  }
}

}  // namespace saccade::bench
