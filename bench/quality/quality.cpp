#include "bench/quality/quality.h"

#include "bench/harness/method.h"
#include "bench/reference/reference.h"
#include "core/composite.h"
#include "core/metrics/comparison.h"

namespace saccade::bench {
namespace {

constexpr int kSide = 256;
constexpr int kOversampling = 4;
constexpr Confidence kConfidence{.relmse = 2e-3, .capSeconds = 100};
constexpr Confidence kQuickConfidence{.relmse = 0.02, .capSeconds = 20};

/// A scene's pictures. Main thread only.
class Pictures {
 public:
  Pictures(const std::string& file, const Session& session)
      : stage_(openStage(file, "medium", session.options().seed, session.stop())), session_(session) {}

  const Stage& stage() const { return *stage_; }
  const core::Camera& camera() const { return stage_->workspace->scene.cameras[0]; }

  core::ImageRgb converged(int side, int subSamples) const {
    app::FrameLoopOptions options;
    options.threads = stage_->cores;
    options.seed = stage_->seed;
    options.corrective.samplesPerPixel = subSamples;
    const auto loop = pinnedLoop(*stage_, options);
    loop->step(camera(), {side, side}, app::FrameBudget::untilConverged(), session_.stop());
    session_.checkStop();
    return loop->linear();
  }

  core::FramePtr base() const {
    return stage_->gl->renderer->render(stage_->view(camera(), {kSide, kSide}), 1,
                                        app::CorrectiveOptions{}.nMin);
  }

 private:
  std::unique_ptr<Stage> stage_;
  const Session& session_;
};

/// With the non-diffuse pixels black, so that only the maps are compared.
core::ImageRgb diffuseOnly(const core::FrameSnapshot& frame, core::ImageRgb image) {
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (frame.idAt(x, y) != 0) image.at(x, y) = core::Vec3(0);
    }
  }
  return image;
}

/// Adds the records of one scene.
class Steps {
 public:
  Steps(Session& session, std::string scene) : session_(session), scene_(std::move(scene)) {}

  void add(const std::string& step, std::map<std::string, Value> values) {
    Record record;
    record.key = "quality/" + scene_ + "/" + step;
    record.labels = {{"scene", scene_}, {"step", step}};
    record.values = std::move(values);
    session_.add(record, nullptr);
  }
  void add(const std::string& step, const core::Comparison& c) {
    session_.say("quality: " + scene_ + ", " + step);
    add(step, {{"flip", Value::error(c.flip)}, {"relmse", Value::error(c.relmse)}});
  }

 private:
  Session& session_;
  std::string scene_;
};

void measureScene(Session& session, const std::string& file) {
  const Pictures pictures(file, session);
  const app::Workspace& workspace = *pictures.stage().workspace;
  const Reference reference = referenceOf(workspace, {pictures.camera(), {kSide, kSide}},
                                          session.quick() ? kQuickConfidence : kConfidence, session.stop());
  Steps steps(session, pictures.stage().name);
  steps.add("reference-noise", reference.own);
  steps.add("corrective", core::compareLinear(reference.radiance, pictures.converged(kSide, 1)));
  steps.add("without-glossy-noise", core::compareLinear(reference.radiance, pictures.converged(kSide, 64)));
  const core::ImageRgb large = pictures.converged(kSide * kOversampling, 4);
  steps.add("without-aliasing", core::compareLinear(reference.radiance, boxFiltered(large, kOversampling)));
  const core::FramePtr frame = pictures.base();
  const core::ImageRgb base = core::compositeLinear(kSide, kSide, frame->baseAndId, {});
  steps.add("maps", core::compareLinear(diffuseOnly(*frame, reference.radiance), diffuseOnly(*frame, base)));
  steps.add("left-out", {{"albedo", Value::error(workspace.plan.diffuseEnergyLeftOut)}});
}

}  // namespace

core::ImageRgb boxFiltered(const core::ImageRgb& large, int factor) {
  core::ImageRgb small(large.width() / factor, large.height() / factor);
  for (int y = 0; y < large.height(); ++y) {
    for (int x = 0; x < large.width(); ++x)
      small.at(x / factor, y / factor) += large.at(x, y) / static_cast<float>(factor * factor);
  }
  return small;
}

void measureQuality(Session& session) {
  std::vector<std::string> scenes = session.options().scenes;
  if (scenes.empty()) scenes = {bundledScene("cornell"), bundledScene("table"), bundledScene("gallery")};
  if (session.quick()) scenes.resize(1);
  for (const std::string& file : scenes) measureScene(session, file);
}

}  // namespace saccade::bench
