#include "bench/moving/course.h"

#include <utility>

#include "app/cli/walk_options.h"
#include "bench/harness/machine.h"
#include "bench/harness/trials.h"
#include "bench/methods/walkers.h"
#include "bench/reference/reference.h"

namespace saccade::bench {
namespace {

app::CameraPath pathOf(const CourseOptions& options, const core::Scene& scene) {
  if (!options.path.empty()) return app::CameraPath::read(options.path);
  return app::CameraPath::orbit(app::chooseCamera(scene, {}), app::kOrbitPeriodSeconds);
}

}  // namespace

Course::Course(Session& session, const CourseOptions& options)
    : stage_(openStage(options.scene, options.quality, session.options().seed, session.stop())),
      size_(options.size),
      path_(pathOf(options, stage_->workspace->scene)),
      stretch_(Stretch::within(path_.lengthSeconds(), options.segment, options.segments)) {
  addReferences(session, options);
}

void Course::addReferences(Session& session, const CourseOptions& options) {
  const Confidence confidence{options.referenceRelmse, options.referenceSeconds};
  const Schedule keyViews(stretch_, stretch_.segment);
  std::vector<Grade> own;
  std::vector<double> samplesPerPixel;
  for (int k = 0; k < keyViews.keyViews(); ++k) {
    const core::Camera camera = path_.at(keyViews.seconds(keyViews.frameOf(k)));
    Reference reference =
        referenceOf(*stage_->workspace, {.camera = camera, .size = size_}, confidence, session.stop());
    samplesPerPixel.push_back(static_cast<double>(reference.samplesPerPixel));
    truths_.emplace_back(std::move(reference.radiance));
    own.push_back({reference.own, truths_.back().flipSalient(reference.own)});
  }
  referenceFile_ = session.picture("moving_" + name() + "_reference", truths_.back().reference());
  Record record;
  record.key = "moving/" + name() + "/reference";
  record.labels = {{"scene", name()}, {"method", "reference"}};
  // Over key views, not repeats: the floor below which no difference means anything.
  addErrors(record, own);
  record.values["spp"] = Value::count(spread(samplesPerPixel).median);
  record.files = {{"picture", referenceFile_}};
  session.add(std::move(record), nullptr);
}

WalkResult Course::walk(const Method& method, double budgetSeconds, bool warmUp) {
  Stretch stretch = stretch_;
  if (warmUp) stretch.segments = 1;
  const Pinned main(mainCores());
  const std::unique_ptr<Walker> walker = method.walk(*stage_, size_);
  return walkOnce(*walker, path_, Schedule(stretch, budgetSeconds));
}

WalkResult Course::raytraceShots(double budgetSeconds) {
  const Schedule schedule(stretch_, budgetSeconds);
  const std::unique_ptr<Walker> walker = walkRaytrace(*stage_, size_);
  WalkResult result;
  const auto shown = [&](int frame) {
    walker->frame(path_.at(schedule.seconds(frame)), std::chrono::duration<double>(budgetSeconds));
    return walker->display();
  };
  for (int k = 0; k < schedule.keyViews(); ++k) {
    Shot shot;
    shot.before = shown(schedule.frameOf(k) - 1);
    shot.display = shown(schedule.frameOf(k));
    shot.linear = walker->linear();
    result.shots.push_back(std::move(shot));
  }
  result.stats = walker->stats();
  return result;
}

}  // namespace saccade::bench
