#include "bench/moving/moving.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "app/session/stats.h"
#include "bench/harness/machine.h"
#include "bench/moving/course.h"
#include "bench/moving/matrix.h"
#include "core/metrics/comparison.h"

namespace saccade::bench {
namespace {

/// Pictures of the main variants are kept at this one.
constexpr double kPictureBudgetMs = 66;

using Repeats = std::map<std::string, std::vector<double>>;  ///< by metric

std::string at(double budgetMs) {
  char text[32];
  std::snprintf(text, sizeof text, "@%gms", budgetMs);
  return text;
}

void append(Repeats& repeats, const Metrics& metrics) {
  for (const auto& [name, value] : metrics) repeats[name].push_back(value);
}

Metrics metricsOf(const WalkResult& walk, const Course& course) {
  Metrics metrics = errorsOf(walk, course.truths());
  metrics.merge(speedOf(walk));
  return metrics;
}

Record recordOf(const Course& course, const Method& method, const std::string& suffix, const Repeats& repeats,
                std::size_t frames) {
  Record record;
  record.key = "moving/" + course.name() + "/" + method.key() + suffix;
  record.labels = method.labels;
  record.labels["scene"] = course.name();
  for (const auto& [name, values] : repeats) record.values[name] = valueOf(name, values);
  record.values["frames"] = Value::count(static_cast<double>(frames));
  record.values["peak_bytes"] = Value::bytes(static_cast<double>(app::peakBytes()));
  return record;
}

/// Displayed frame, reference and error at the last key view.
std::map<std::string, std::string> picturesOf(Session& session, const Course& course, const std::string& name,
                                              const Shot& shot) {
  const core::ImageGray map = core::compareLinear(course.truths().back().reference, shot.linear).flipMap;
  const std::string file = "moving_" + course.name() + "_" + name;
  return {{"picture", session.picture(file, shot.display)},
          {"reference", course.referenceFile()},
          {"error", session.errorMap(file + "_flip", map)}};
}

void sayRow(const Session& session, const Record& record) {
  const auto of = [&](const char* name) {
    const auto found = record.values.find(name);
    return found == record.values.end() ? 0.0 : found->second.median;
  };
  char line[256];
  std::snprintf(
      line, sizeof line,
      "%s: flip %.4f, salient %.4f, step %.4f (raytrace %.4f), relmse %.4f; p50 %.1f, p95 %.1f ms, missed "
      "%.0f %%; %.0f samples a frame, %.0f reused",
      record.key.c_str(), of("flip"), of("flip_salient"), of("flip_step"), of("flip_step_raytrace"),
      of("relmse"), of("frame_p50"), of("frame_p95"), 100 * of("missed_share"), of("samples_per_frame"),
      of("reused_per_frame"));
  session.say(line);
}

/// All methods of one budget on one course.
class BudgetWalks {
 public:
  BudgetWalks(Session& session, Course& course, double budgetMs)
      : session_(session),
        course_(course),
        budgetMs_(budgetMs),
        methods_(movingMethods(session.options(), budgetMs)),
        repeats_(methods_.size()),
        last_(methods_.size()) {}

  void run() {
    if (methods_.empty()) return;
    const double motion = stepsOf(course_.raytraceShots(budgetMs_ / 1000)).at("flip_step");
    const LoadWatch watch;
    alternate(static_cast<int>(methods_.size()), kRepeats, session_.stop(),
              [&](int method, int round) { walk(static_cast<std::size_t>(method), round < 0); });
    for (std::size_t i = 0; i < methods_.size(); ++i) addRow(i, motion, watch);
    addAgainst(watch);
  }

 private:
  void walk(std::size_t i, bool warmUp) {
    WalkResult walk = course_.walk(methods_[i], budgetMs_ / 1000, warmUp);
    if (warmUp) return;
    append(repeats_[i], metricsOf(walk, course_));
    append(repeats_[i], stepsOf(walk));
    last_[i] = std::move(walk);
  }

  bool isMain(std::size_t i) const {
    const std::string key = methods_[i].key();
    return key == kMainMethod || key == "base" || key == std::string(kMainMethod) + "-nocache";
  }

  void addRow(std::size_t i, double motion, const LoadWatch& watch) {
    Record record = recordOf(course_, methods_[i], at(budgetMs_), repeats_[i], last_[i].stats.frameMs.size());
    record.at["budget_ms"] = budgetMs_;
    record.values["flip_step_raytrace"] = valueOf("flip_step_raytrace", {motion});
    if (isMain(i) && budgetMs_ == kPictureBudgetMs)
      record.files =
          picturesOf(session_, course_, methods_[i].key() + at(budgetMs_).substr(1), last_[i].shots.back());
    sayRow(session_, record);
    session_.add(std::move(record), &watch);
  }

  /// Does attention pay, does reuse, do corrections: the main method's error over each other one's.
  void addAgainst(const LoadWatch& watch) {
    const auto main = std::find_if(methods_.begin(), methods_.end(),
                                   [](const Method& m) { return m.key() == kMainMethod; });
    if (main == methods_.end() || methods_.size() < 2) return;
    const Repeats& ours = repeats_[static_cast<std::size_t>(main - methods_.begin())];
    Record record;
    record.key = "moving/" + course_.name() + "/against" + at(budgetMs_);
    record.labels = main->labels;
    record.labels["scene"] = course_.name();
    record.at["budget_ms"] = budgetMs_;
    std::string line = record.key + ", " + kMainMethod + " over others (flip, salient; below 1 it pays):";
    for (std::size_t i = 0; i < methods_.size(); ++i) {
      if (methods_[i].key() == kMainMethod) continue;
      for (const char* metric : {"flip", "flip_salient", "relmse"})
        record.values[std::string(metric) + "_over_" + methods_[i].key()] =
            Value::ratio(ratios(ours.at(metric), repeats_[i].at(metric)), Better::lower);
      char text[128];
      std::snprintf(text, sizeof text, " %s %.3f %.3f;", methods_[i].key().c_str(),
                    record.values["flip_over_" + methods_[i].key()].median,
                    record.values["flip_salient_over_" + methods_[i].key()].median);
      line += text;
    }
    session_.say(line);
    session_.add(std::move(record), &watch);
  }

  Session& session_;
  Course& course_;
  double budgetMs_;
  std::vector<Method> methods_;
  std::vector<Repeats> repeats_;  ///< by method
  std::vector<WalkResult> last_;  ///< by method: the last walk
};

/// Shares of frames that would have missed each budget.
Metrics missesOf(const WalkResult& walk, const std::vector<double>& budgetsMs) {
  const std::vector<double>& times = walk.stats.frameMs;
  Metrics shares;
  for (const double ms : budgetsMs) {
    const auto budget = app::FrameBudget::untilDeadline(std::chrono::duration<double, std::milli>(ms));
    const auto missed = std::count_if(times.begin(), times.end(), [&](double taken) {
      return budget.missedAfter(std::chrono::duration<double, std::milli>(taken));
    });
    shares["missed_share_" + at(ms).substr(1)] =
        static_cast<double>(missed) / static_cast<double>(times.size());
  }
  return shares;
}

/// raytrace and path: the key views alone, since their frames know nothing of those before.
void walkUnbudgeted(Session& session, Course& course) {
  const std::vector<Method> methods = unbudgetedMethods(session.options());
  std::vector<Repeats> repeats(methods.size());
  std::vector<WalkResult> last(methods.size());
  const LoadWatch watch;
  alternate(static_cast<int>(methods.size()), kRepeats, session.stop(), [&](int method, int round) {
    const auto i = static_cast<std::size_t>(method);
    last[i] = course.walk(methods[i], course.stretch().segment, round < 0);
    if (round < 0) return;
    Metrics metrics = metricsOf(last[i], course);
    metrics.erase("missed_share");
    append(repeats[i], metrics);
    append(repeats[i], missesOf(last[i], movingBudgets(session.options().suite)));
  });
  for (std::size_t i = 0; i < methods.size(); ++i) {
    Record record = recordOf(course, methods[i], "", repeats[i], last[i].stats.frameMs.size());
    record.files = picturesOf(session, course, methods[i].key(), last[i].shots.back());
    sayRow(session, record);
    session.add(std::move(record), &watch);
  }
}

std::vector<CourseOptions> coursesOf(const BenchOptions& options) {
  CourseOptions course;
  course.size = options.suite == Suite::quick ? app::ImageSize{128, 128} : app::ImageSize{256, 256};
  course.quality = options.suite == Suite::quick ? "preview" : "medium";
  if (options.suite == Suite::quick) {
    course.segment = 0.25;
    course.referenceRelmse = 1e-2;
    course.referenceSeconds = 3;
  }
  std::vector<CourseOptions> courses;
  const auto add = [&](const std::string& scene, const std::string& path) {
    course.scene = scene;
    course.path = path;
    courses.push_back(course);
  };
  for (const std::string& scene : options.scenes) add(scene, options.path);
  if (!courses.empty()) return courses;
  std::vector<std::string> names = {"gallery"};
  if (options.suite == Suite::quick) names = {"cornell"};
  if (options.suite == Suite::full) names = {"cornell", "table", "gallery"};
  for (const std::string& name : names) add(bundledScene(name), bundledPath(name));
  return courses;
}

}  // namespace

void measureMoving(Session& session) {
  for (const CourseOptions& options : coursesOf(session.options())) {
    Course course(session, options);
    for (const double budgetMs : movingBudgets(session.options().suite)) {
      session.checkStop();
      BudgetWalks(session, course, budgetMs).run();
    }
    walkUnbudgeted(session, course);
  }
}

}  // namespace saccade::bench
