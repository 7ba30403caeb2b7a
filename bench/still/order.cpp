#include <algorithm>
#include <vector>

#include "bench/harness/method.h"
#include "bench/reference/grade.h"
#include "bench/still/still.h"
#include "bench/still/views.h"

namespace saccade::bench {
namespace {

constexpr int kFinestShare = 64;  ///< the first point: after 1/64 of all samples
constexpr double kShareOfBase = 0.5;

/// One method on one view.
class Run {
 public:
  Run(Session& session, const StillView& view, const Method& method, Stage& stage, const StillTask& task)
      : session_(session), view_(view), method_(method), stage_(stage), task_(task) {}

  /// `converged`: of all its `total` samples; `base`: without any.
  void measure(const Grader& converged, const Point& base, std::uint64_t total) {
    const double wanted = kShareOfBase * converged.grade(base.linear).flipSalient;
    std::uint64_t before = 0, after = total;  // too few, enough
    bool reached = false;
    for (std::uint64_t share = kFinestShare; share > 1; share /= 2) {
      const std::uint64_t samples = total / share;
      const Grade grade = converged.grade(draw(samples).linear);
      add("@1of" + std::to_string(share), samples, grade);
      if (reached) continue;
      reached = grade.flipSalient <= wanted;
      (reached ? after : before) = samples;
    }
    after = fewestSamples(before, after, [&](std::uint64_t samples) {
      return converged.grade(draw(samples).linear).flipSalient <= wanted;
    });
    Record record = named("");
    record.values["samples_to_half"] = Value::count(static_cast<double>(after), Better::lower);
    record.values["samples"] = Value::count(static_cast<double>(total));
    session_.add(std::move(record), nullptr);
  }

 private:
  Point draw(std::uint64_t samples) {
    session_.checkStop();
    return method_.afterSamples(stage_, task_, samples);
  }

  Record named(const std::string& suffix) const {
    Record record;
    record.key = "order/" + view_.name() + "/" + method_.variant + suffix;
    record.labels = method_.labels;
    record.labels["scene"] = view_.name();
    record.labels["size"] = view_.sizeName();
    return record;
  }

  void add(const std::string& suffix, std::uint64_t samples, const Grade& grade) {
    Record record = named(suffix);
    record.at["samples"] = static_cast<double>(samples);
    addErrors(record, {grade});
    session_.add(std::move(record), nullptr);
  }

  Session& session_;
  const StillView& view_;
  const Method& method_;
  Stage& stage_;
  const StillTask& task_;
};

}  // namespace

std::uint64_t fewestSamples(std::uint64_t tooFew, std::uint64_t enough,
                            const std::function<bool(std::uint64_t)>& isEnough) {
  constexpr int kBisections = 5;
  for (int i = 0; i < kBisections; ++i) {
    const std::uint64_t middle = tooFew + (enough - tooFew) / 2;
    (isEnough(middle) ? enough : tooFew) = middle;
  }
  return enough;
}

void runOrder(Session& session) {
  for (const StillView& view : stillViews(session)) {
    const auto stage = openStage(view.file, view.quality, session.options().seed, session.stop());
    const StillTask task{app::chooseCamera(stage->workspace->scene, {}), view.size, 0, session.stop()};
    for (const Method& method : allMethods()) {
      if (!method.afterSamples || !session.options().wantsMethod(method.name)) continue;
      const Point base = method.afterSamples(*stage, task, 0);
      const Point all =
          method.afterSamples(*stage, task, static_cast<std::uint64_t>(view.size.width) * view.size.height);
      Run(session, view, method, *stage, task).measure(Grader(all.linear), base, all.samples);
    }
  }
}

}  // namespace saccade::bench
