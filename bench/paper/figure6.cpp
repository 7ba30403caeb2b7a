#include "bench/paper/figure6.h"

#include "bench/harness/method.h"
#include "bench/paper/duck_scene.h"
#include "bench/paper/untraced_walk.h"
#include "core/composite.h"
#include "core/metrics/comparison.h"
#include "raytrace/bake/baker.h"
#include "raytrace/bake/light_charts.h"
#include "raytrace/reference.h"

namespace saccade::bench {
namespace {

constexpr app::ImageSize kSize{512, 512};
constexpr int kMinSamples = 10;                            // N_min
constexpr double kPaperLevels12 = 58, kPaperLevel3 = 188;  ///< new samples in the paper's c) and d)
/// Of the way to what it looks at, that the camera goes to zoom in.
constexpr float kApproach = 0.5f;

std::unique_ptr<Stage> openScene(core::Scene scene, std::uint32_t seed, const std::stop_token& stop) {
  auto stage = std::make_unique<Stage>();
  stage->name = "duck";
  stage->cores = static_cast<int>(std::thread::hardware_concurrency());
  stage->seed = seed;
  stage->workspace = std::make_unique<app::Workspace>();
  app::Workspace& w = *stage->workspace;
  w.scene = std::move(scene);
  w.plan = core::makePlan(w.scene);
  raytrace::BakeOptions bake;
  bake.quality = "preview";
  raytrace::LightCharts charts = raytrace::chartByLight(
      w.scene, w.plan, {.quality = bake.quality, .seed = seed, .threads = stage->cores}, {nullptr, stop});
  w.world = std::move(charts.world);
  bake.seed = seed;
  bake.threads = stage->cores;
  w.maps =
      raytrace::bakeMaps(*w.world, std::move(charts.atlas.charts), charts.atlas.size, bake, {nullptr, stop});
  w.world->setMaps(&w.maps);
  stage->gl = std::make_unique<app::Headless>(app::RunOptions{}, w);
  return stage;
}

core::Camera zoomed(core::Camera camera) {
  camera.eye += kApproach * (camera.at - camera.eye);
  return camera;
}

/// The zoomed-in frame on its way from warped samples to corrected ones.
class ZoomedView {
 public:
  ZoomedView(const Stage& stage, const core::Camera& camera, const FrozenCache& samples)
      : tracer_(*stage.workspace->world, {.seed = stage.seed}), cache_(kCacheBytes) {
    const core::View view = stage.view(camera, kSize);
    samples.thaw(view, cache_);
    cache_.age(view, {.nMin = kMinSamples});
    frame_ = stage.gl->renderer->render(view, cache_.cameraAge(), kMinSamples);
    layer_.beginFrame(frame_);
    warped_ = cache_.warp(*frame_, layer_).splatted;
  }

  /// Traces and splats new samples of two levels and those between; their number.
  int correct(int first, int last) {
    int samples = 0;
    raytrace::RayCounters counters;
    for (std::uint32_t id = 1; id < frame_->extents.size(); ++id) {
      forEachNewPoint(*frame_, id, first, last, [&](int x, int y, int level) {
        layer_.splat(tracer_.trace(*frame_, x, y, level, counters));
        ++samples;
      });
    }
    return samples;
  }

  core::ImageRgb picture() {
    return core::compositeLinear(kSize.width, kSize.height, frame_->baseAndId, layer_.pixels());
  }
  core::ImageRgb reference(const std::stop_token& stop) const {
    const raytrace::TraceAllResult all = raytrace::traceAll(tracer_, *frame_, 0, {nullptr, stop});
    return core::compositeLinear(kSize.width, kSize.height, frame_->baseAndId, all.corrections);
  }
  std::size_t warped() const { return warped_; }
  std::uint32_t pixels() const { return frame_->nonDiffusePixels; }
  std::uint32_t covered() const { return layer_.coveredCount(); }

 private:
  static constexpr std::size_t kCacheBytes = std::size_t{64} << 20;
  raytrace::CorrectiveTracer tracer_;
  render::SampleCache cache_;
  render::CorrectionLayer layer_;
  core::FramePtr frame_;
  std::size_t warped_ = 0;
};

/// A step of the figure: its picture, its error map and the record, which the caller completes.
Record stepOf(Session& session, const std::string& letter, const std::string& shows,
              const core::ImageRgb& picture, const core::ImageRgb& reference) {
  const core::Comparison error = core::compareLinear(reference, picture);
  Record record;
  record.key = "figures/duck-" + letter;
  record.labels = {{"figure", "6" + letter}, {"shows", shows}, {"scene", "duck"}};
  record.values = {{"rmse", Value::error(error.rmse)},
                   {"relmse", Value::error(error.relmse)},
                   {"flip", Value::error(error.flip)},
                   {"flip_p95", Value::error(error.flipP95)}};
  record.files = {{"picture", session.picture("figure6-" + letter, picture)},
                  {"error", session.errorMap("figure6-" + letter + "-flip", error.flipMap)}};
  return record;
}

}  // namespace

void drawFigure6(Session& session) {
  const auto file = sharedFile("scenes/samples/Duck.glb");
  if (!file) {
    session.say(
        "figures: no Figure 6, for want of scenes/samples/Duck.glb in the shared folder (SACCADE_SHARED)");
    return;
  }
  session.say("figures: a chrome-plated duck (Figure 6)");
  const auto stage = openScene(thingInRoom(*file, chrome()), session.options().seed, session.stop());
  const core::Camera camera = stage->workspace->scene.cameras.at(0);

  app::FrameLoop loop(*stage->workspace, *stage->gl->renderer, {.threads = 0, .seed = stage->seed});
  loop.step(camera, kSize, app::FrameBudget::untilConverged(), session.stop());
  const core::ImageRgb converged = loop.linear();
  const raytrace::CorrectiveTracer tracer(*stage->workspace->world, {.seed = stage->seed});
  const raytrace::TraceAllResult all = raytrace::traceAll(tracer, loop.frame(), 0, {nullptr, session.stop()});
  Record a =
      stepOf(session, "a", "converged", converged,
             core::compositeLinear(kSize.width, kSize.height, loop.frame().baseAndId, all.corrections));
  a.values["samples"] = Value::count(static_cast<double>(loop.stats().samplesTraced));
  session.add(std::move(a), nullptr);

  ZoomedView view(*stage, zoomed(camera), FrozenCache(loop.cache(), loop.cache().size()));
  const core::ImageRgb reference = view.reference(session.stop());
  Record b = stepOf(session, "b", "zoomed in, warped samples alone", view.picture(), reference);
  b.values["warped"] = Value::count(static_cast<double>(view.warped()));
  b.values["nondiffuse_pixels"] = Value::count(view.pixels());
  b.values["covered_pixels"] = Value::count(view.covered());
  session.add(std::move(b), nullptr);
  const auto withNew = [&](const char* letter, const char* shows, int first, int last, double papers) {
    const int samples = view.correct(first, last);
    Record record = stepOf(session, letter, shows, view.picture(), reference);
    record.values["new_samples"] = Value::count(samples);
    record.values["new_samples_paper"] = Value::count(papers);
    session.add(std::move(record), nullptr);
  };
  withNew("c", "and new samples of levels 1 and 2", 1, 2, kPaperLevels12);
  withNew("d", "and new samples of level 3", 3, 3, kPaperLevel3);
}

}  // namespace saccade::bench
