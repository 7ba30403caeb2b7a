#include "bench/moving/moving.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "bench/harness/machine.h"
#include "bench/moving/course.h"
#include "bench/moving/matrix.h"
#include "core/metrics/comparison.h"

namespace saccade::bench {
namespace {

/// Pictures of the main variants are kept at this one: with much more time a small picture converges.
constexpr double kPictureBudgetMs = 16;

/// What the walks of one method gave.
struct Trials {
  Method method;
  std::vector<Grade> grades;  ///< by walk, as all below
  std::vector<double> steps;
  std::map<std::string, std::vector<double>> speeds;
  std::vector<double> peakBytes;
  WalkResult last;

  void take(WalkResult walk, const Course& course) {
    grades.push_back(meanGrade(walk, course.truths()));
    steps.push_back(stepOf(walk));
    for (const auto& [name, value] : speedOf(walk)) speeds[name].push_back(value);
    last = std::move(walk);
  }
};

std::string at(double budgetMs) {
  char text[32];
  std::snprintf(text, sizeof text, "@%gms", budgetMs);
  return text;
}

std::vector<Trials> trialsOf(std::vector<Method> methods) {
  std::vector<Trials> trials;
  trials.reserve(methods.size());
  for (Method& method : methods) trials.push_back({std::move(method), {}, {}, {}, {}, {}});
  return trials;
}

/// A warm-up and kRepeats walks of each, in alternating order.
void walkAll(Session& session, Course& course, double budgetSeconds, std::vector<Trials>& trials) {
  alternate(static_cast<int>(trials.size()), kRepeats, session.stop(), [&](int i, int round) {
    Trials& own = trials[static_cast<std::size_t>(i)];
    const PeakMemory peak;
    WalkResult walk = course.walk(own.method, budgetSeconds, round < 0);
    if (round < 0) return;
    own.peakBytes.push_back(static_cast<double>(peak.bytes()));
    own.take(std::move(walk), course);
  });
}

Record recordOf(const Course& course, const Trials& trials, const std::string& suffix) {
  Record record;
  record.key = "moving/" + course.name() + "/" + trials.method.key() + suffix;
  record.labels = trials.method.labels;
  record.labels["scene"] = course.name();
  addErrors(record, trials.grades);
  for (const auto& [name, values] : trials.speeds) record.values[name] = speedValue(name, values);
  record.values["frames"] = Value::count(static_cast<double>(trials.last.stats.frameMs.size()));
  record.values["peak_bytes"] = Value::bytes(spread(trials.peakBytes).max);
  return record;
}

/// Displayed frame, reference and error at the last key view.
std::map<std::string, std::string> picturesOf(Session& session, const Course& course, const std::string& name,
                                              const Shot& shot) {
  const core::ImageGray map = core::compareLinear(course.truths().back().reference(), shot.linear).flipMap;
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

bool isMain(const Method& method) {
  const std::string key = method.key();
  return key == kMainMethod || key == "base" || key == std::string(kMainMethod) + "-nocache";
}

Value motion(const std::vector<double>& repeats) {
  Value value = Value::errors(repeats);
  value.better = Better::neither;
  return value;
}

/// As a part of a metric's name, which is a word.
std::string wordOf(std::string key) {
  std::replace(key.begin(), key.end(), '-', '_');
  return key;
}

/// kMainMethod's errors over another's, walk by walk.
void addRatios(Record& record, const Trials& ours, const Trials& other) {
  const auto add = [&](const char* name, auto figure) {
    std::vector<double> values;
    for (std::size_t i = 0; i < ours.grades.size(); ++i)
      values.push_back(figure(ours.grades[i]) / figure(other.grades[i]));
    record.values[std::string(name) + "_over_" + wordOf(other.method.key())] =
        Value::ratio(values, Better::lower);
  };
  add("flip", [](const Grade& g) { return g.errors.flip; });
  add("flip_salient", [](const Grade& g) { return g.flipSalient; });
  add("relmse", [](const Grade& g) { return g.errors.relmse; });
}

/// Does attention pay, does reuse, do corrections?
void addAgainst(Session& session, const Course& course, double budgetMs, const std::vector<Trials>& trials,
                const LoadWatch& watch) {
  const auto ours = std::find_if(trials.begin(), trials.end(),
                                 [](const Trials& t) { return t.method.key() == kMainMethod; });
  if (ours == trials.end() || trials.size() < 2) return;
  Record record;
  record.key = "moving/" + course.name() + "/against" + at(budgetMs);
  record.labels = ours->method.labels;
  record.labels["scene"] = course.name();
  record.at["budget_ms"] = budgetMs;
  for (const Trials& other : trials) {
    if (&other != &*ours) addRatios(record, *ours, other);
  }
  std::string line = std::string(kMainMethod) + " over others in flip_salient (below 1 it pays):";
  const std::string prefix = "flip_salient_over_";
  for (const auto& [name, value] : record.values) {
    if (!name.starts_with(prefix)) continue;
    char text[128];
    std::snprintf(text, sizeof text, " %s %.3f (%.3f to %.3f)", name.substr(prefix.size()).c_str(),
                  value.median, value.min, value.max);
    line += text;
  }
  session.say(record.key + ", " + line);
  session.add(std::move(record), &watch);
}

void walkBudget(Session& session, Course& course, double budgetMs) {
  std::vector<Trials> trials = trialsOf(movingMethods(session.options(), budgetMs));
  if (trials.empty()) return;
  const double exactStep = stepOf(course.raytraceShots(budgetMs / 1000));
  const LoadWatch watch;
  walkAll(session, course, budgetMs / 1000, trials);
  for (const Trials& own : trials) {
    Record record = recordOf(course, own, at(budgetMs));
    record.at["budget_ms"] = budgetMs;
    record.values["flip_step"] = motion(own.steps);
    record.values["flip_step_raytrace"] = motion({exactStep});
    if (isMain(own.method) && budgetMs == kPictureBudgetMs)
      record.files =
          picturesOf(session, course, own.method.key() + at(budgetMs).substr(1), own.last.shots.back());
    sayRow(session, record);
    session.add(std::move(record), &watch);
  }
  addAgainst(session, course, budgetMs, trials, watch);
}

double missedShare(const std::vector<double>& frameMs, double budgetMs) {
  const auto budget = app::FrameBudget::untilDeadline(std::chrono::duration<double, std::milli>(budgetMs));
  const auto missed = std::count_if(frameMs.begin(), frameMs.end(), [&](double ms) {
    return budget.missedAfter(std::chrono::duration<double, std::milli>(ms));
  });
  return static_cast<double>(missed) / static_cast<double>(frameMs.size());
}

/// raytrace and path: the key views alone, since their frames know nothing of those before. They stand at the
/// time that their frames take; how many of the last walk's would have missed each budget is said.
void walkUnbudgeted(Session& session, Course& course) {
  std::vector<Trials> trials = trialsOf(unbudgetedMethods(session.options()));
  if (trials.empty()) return;
  const LoadWatch watch;
  walkAll(session, course, course.stretch().segment, trials);
  for (Trials& own : trials) {
    own.speeds.erase("missed_share");
    for (const double ms : movingBudgets(session.options().suite))
      own.speeds["missed_share_" + at(ms).substr(1)] = {missedShare(own.last.stats.frameMs, ms)};
    Record record = recordOf(course, own, "");
    record.at["frame_ms"] = record.values.at("frame_p50").median;
    record.files = picturesOf(session, course, own.method.key(), own.last.shots.back());
    sayRow(session, record);
    session.add(std::move(record), &watch);
  }
}

std::vector<CourseOptions> coursesOf(const BenchOptions& options) {
  CourseOptions course;
  course.size = options.suite == Suite::quick ? app::ImageSize{128, 128} : app::ImageSize{256, 256};
  course.quality = options.suite == Suite::quick ? "preview" : "medium";
  if (options.suite == Suite::quick) {
    course.segment = 0.375;
    course.segments = 2;
    course.referenceRelmse = 1e-2;
    course.referenceSeconds = 6;
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
      walkBudget(session, course, budgetMs);
    }
    walkUnbudgeted(session, course);
  }
}

}  // namespace saccade::bench
