#include "bench/still/still.h"

#include <algorithm>
#include <cctype>
#include <map>

#include "bench/harness/method.h"
#include "bench/reference/grade.h"
#include "bench/still/views.h"

namespace saccade::bench {
namespace {

/// Whose picture is kept beside the last one of each method.
constexpr double kPictureBudgetMs = 125;

/// The repeats of one point of one method.
struct Series {
  std::string setting;
  double budgetMs = 0;
  int subSamples = 0;
  std::vector<double> seconds, samples, rays;
  std::vector<Grade> grades;  ///< of pictures that differ from the one before
  core::ImageRgb picture;     ///< the last one
};

/// What one method did on one view.
struct MethodRun {
  Method method;
  std::vector<Series> series;  ///< in the order of the points
  std::uint64_t peakBytes = 0;

  Series& seriesOf(const Point& point) {
    const auto same = [&](const Series& s) { return s.setting == point.setting; };
    const auto found = std::find_if(series.begin(), series.end(), same);
    if (found != series.end()) return *found;
    series.push_back({point.setting, point.budgetMs, point.subSamples, {}, {}, {}, {}, {}});
    return series.back();
  }

  /// Pictures without a deadline repeat exactly: FLIP of the same picture again would tell nothing.
  void take(Point point, const Grader& grader) {
    Series& s = seriesOf(point);
    s.seconds.push_back(point.seconds);
    s.samples.push_back(static_cast<double>(point.samples));
    s.rays.push_back(static_cast<double>(point.rays));
    if (s.picture.pixels() == point.linear.pixels()) return;
    s.grades.push_back(grader.grade(point.linear));
    s.picture = std::move(point.linear);
  }
};

/// "converged, 4 spp" -> "converged-4spp"
std::string keyOf(const std::string& setting) {
  std::string key;
  for (const char c : setting) {
    if (c == ',') key += '-';
    if (c != ',' && c != ' ') key += c;
  }
  return key;
}

void addSpeed(Record& record, const Series& s) {
  record.values["seconds"] = Value::seconds(s.seconds);
  if (s.rays.front() == 0) return;
  record.values["samples_per_second"] = Value::rate(ratios(s.samples, s.seconds));
  record.values["rays_per_second"] = Value::rate(ratios(s.rays, s.seconds));
  if (s.budgetMs > 0) return;
  record.values["samples"] = Value::count(s.samples.front());
  record.values["rays"] = Value::count(s.rays.front(), Better::lower);
}

Record recordOf(const StillView& view, const MethodRun& run, const Series& s) {
  Record record;
  record.key = "still/" + view.name() + "/" + run.method.key() + "@" + keyOf(s.setting);
  record.labels = run.method.labels;
  record.labels["scene"] = view.name();
  record.labels["size"] = view.sizeName();
  record.labels["maps"] = view.quality;
  if (s.budgetMs > 0) record.at["seconds"] = s.budgetMs / 1000;
  if (s.subSamples > 0) record.at["spp"] = s.subSamples;
  addSpeed(record, s);
  addErrors(record, s.grades);
  record.values["peak_bytes"] = Value::bytes(static_cast<double>(run.peakBytes));
  return record;
}

void addPictures(Session& session, Record& record, const Series& s) {
  std::string name = record.key;
  std::replace(name.begin(), name.end(), '/', '_');
  std::replace(name.begin(), name.end(), '@', '_');
  record.files["picture"] = session.picture(name, s.picture);
  record.files["error"] = session.errorMap(name + "_flip", s.grades.back().errors.flipMap);
}

void addRecords(Session& session, const StillView& view, const MethodRun& run, const LoadWatch& watch) {
  std::vector<const Series*> whole;
  for (const Series& s : run.series) {
    if (static_cast<int>(s.seconds.size()) == kRepeats) whole.push_back(&s);
  }
  for (const Series* s : whole) {
    Record record = recordOf(view, run, *s);
    if (s == whole.back() || s->budgetMs == kPictureBudgetMs) addPictures(session, record, *s);
    session.add(std::move(record), &watch);
  }
}

std::vector<MethodRun> chosenMethods(const BenchOptions& options) {
  std::vector<MethodRun> runs;
  for (Method& method : allMethods()) {
    if (method.still && options.wantsMethod(method.name)) runs.push_back({std::move(method), {}, 0});
  }
  return runs;
}

void measure(Session& session, const StillView& view) {
  const auto stage = openStage(view.file, view.quality, session.options().seed, session.stop());
  const Grader grader(referenceOf(*stage->workspace, view, session.stop()).radiance);
  std::vector<MethodRun> runs = chosenMethods(session.options());
  session.say("still: " + view.name() + " " + view.sizeName() + ", " + std::to_string(runs.size()) +
              " methods and variants, " + std::to_string(kRepeats) + " repeats");
  const StillTask task{app::chooseCamera(stage->workspace->scene, {}), view.size, view.longestSeconds,
                       session.stop()};
  StillTask shortest = task;  // long points warm nothing up that short ones do not
  shortest.longestSeconds = 0;
  const LoadWatch watch;
  alternate(static_cast<int>(runs.size()), kRepeats, session.stop(), [&](int i, int round) {
    MethodRun& run = runs[i];
    const bool warmUp = round < 0;
    const PeakMemory peak;
    run.method.still(*stage, warmUp ? shortest : task, [&](Point point) {
      if (!warmUp) run.take(std::move(point), grader);
    });
    run.peakBytes = std::max(run.peakBytes, peak.bytes());
  });
  for (const MethodRun& run : runs) addRecords(session, view, run, watch);
}

Record recordOf(const StillView& view, const Reference& reference) {
  Record record;
  record.key = "reference/" + view.name();
  record.labels = {{"scene", view.name()},
                   {"size", view.sizeName()},
                   {"method", "path"},
                   {"spp", std::to_string(reference.samplesPerPixel)},
                   {"reached", reference.reached ? "yes" : "no"}};
  const Grader grader(reference.radiance);
  addErrors(record, {{reference.own, grader.flipSalient(reference.own)}});
  record.values["asked_relmse"] = Value::error(view.confidence.relmse);
  record.values["asked_relmse"].better = Better::neither;
  record.values["seconds"] = Value::seconds({reference.seconds});
  record.values["seconds"].better = Better::neither;
  return record;
}

}  // namespace

void runReferences(Session& session) {
  for (const StillView& view : stillViews(session)) {
    session.checkStop();
    app::SceneOptions scene;
    scene.path = view.file;
    const auto workspace = app::openWithoutMaps(scene);
    const Reference reference = referenceOf(*workspace, view, session.stop());
    Record record = recordOf(view, reference);
    record.files["picture"] = session.picture("reference_" + view.name(), reference.radiance);
    record.files["error"] = session.errorMap("reference_" + view.name() + "_flip", reference.own.flipMap);
    session.add(std::move(record), nullptr);
  }
}

void runStill(Session& session) {
  for (const StillView& view : stillViews(session)) measure(session, view);
}

}  // namespace saccade::bench
