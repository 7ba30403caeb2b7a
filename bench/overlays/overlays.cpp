#include "bench/overlays/overlays.h"

#include <chrono>
#include <string>
#include <vector>

#include "app/session/camera_path.h"
#include "app/viewer/overlay_view.h"
#include "bench/harness/method.h"

namespace saccade::bench {
namespace {

constexpr app::ImageSize kSize{512, 512};
constexpr int kFrames = 25;
constexpr double kFrameMs = 40;
constexpr std::uint64_t kSamples = 5000;
constexpr const char* kScene = "gallery";

double drawMs(app::OverlayView& view, app::Aov aov, const app::FrameLoop& loop) {
  core::ImageRgba8 picture = loop.display();
  const auto begin = std::chrono::steady_clock::now();
  view.draw(aov, 0.7f, picture);
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

struct Costs {
  std::vector<double> movingMs, restMs;
};

Costs costsOf(const Stage& stage, const app::CameraPath& path, app::Aov aov) {
  const auto loop = pinnedLoop(stage, {.threads = 0, .seed = stage.seed});
  app::OverlayView view(*loop, stage.workspace->scene, app::CorrectiveOptions{}.maxAge);
  Costs costs;
  const auto step = [&](int frame) {
    loop->step(path.at(frame * kFrameMs / 1000), kSize, app::FrameBudget::firstSamples(kSamples));
  };
  for (int i = 0; i < kFrames; ++i) {
    step(i);
    costs.movingMs.push_back(drawMs(view, aov, *loop));
  }
  for (int i = 0; i < kFrames; ++i) costs.restMs.push_back(drawMs(view, aov, *loop));
  return costs;
}

}  // namespace

void measureOverlays(Session& session) {
  const auto stage = openStage(bundledScene(kScene), "preview", session.options().seed, session.stop());
  const auto path = app::CameraPath::read(bundledPath(kScene));
  const Pinned main(mainCores());
  for (std::size_t i = 0; i < app::aovNames().size(); ++i) {
    session.checkStop();
    const LoadWatch watch;
    const Costs costs = costsOf(*stage, path, static_cast<app::Aov>(i));
    Record record;
    record.key = "overlays/" + app::aovNames()[i];
    record.labels = {{"scene", kScene}, {"overlay", app::aovNames()[i]}};
    record.values = {{"moving_ms", Value::milliseconds(costs.movingMs)},
                     {"rest_ms", Value::milliseconds(costs.restMs)}};
    session.say(record.key + ": " + std::to_string(record.values["moving_ms"].median) + " ms");
    session.add(std::move(record), &watch);
  }
}

}  // namespace saccade::bench
