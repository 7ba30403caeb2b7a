#include "bench/maps/maps.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <thread>

#include "app/cli/console.h"
#include "app/session/workspace.h"
#include "bench/maps/bake_rates.h"
#include "bench/maps/beside_cycles.h"
#include "bench/maps/gathered_maps.h"
#include "bench/maps/map_error.h"
#include "bench/maps/point_reference.h"
#include "bench/maps/soonness.h"
#include "bench/maps/worst_points.h"
#include "bench/peers/curve.h"
#include "raytrace/bake/baker.h"

namespace saccade::bench {
namespace {

constexpr double kSecondsPerSetting = 5;  ///< after them a bake is not repeated
constexpr double kGoalRatio = 1.0 / 3;    ///< of the gather's seconds
constexpr std::size_t kWorstPoints = 32;

struct Subject {
  std::string file;
  float unitScale = 1;
  bool besideCycles = false;
  bool rates = false;  ///< a small, a middling and a large scene say enough
  bool high = false;   ///< takes many minutes in large scenes
};

/// How much is done.
struct Effort {
  std::vector<std::string> qualities;
  std::vector<double> errors;  ///< to be reached
  PointTask task;
  PointConfidence confidence;
  double leastGatherSeconds = 20, mostGatherSeconds = 45;
};

Effort effortOf(const Session& session) {
  if (session.quick()) return {{"preview", "medium"}, {0.1}, {.points = 512}, {0.05, 10}, 2, 5};
  return {{"preview", "medium", "high"}, {0.1, 0.05}, {}, {}};
}

std::string percentOf(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f %%", 100 * x);
  return text;
}

std::string shortNumber(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", x);
  return text;
}

/// All figures of one scene. Main thread only.
class MapsOfScene {
 public:
  MapsOfScene(Session& session, Subject subject)
      : session_(session),
        subject_(std::move(subject)),
        name_(sceneName(subject_.file)),
        effort_(effortOf(session)),
        threads_(static_cast<int>(std::max(1u, std::thread::hardware_concurrency()))) {}

  void run() {
    session_.say("maps: " + name_ + ", reference");
    reference_ = pointReferenceOf(*app::openWithoutMaps(sceneOptions("preview")), effort_.task,
                                  effort_.confidence, session_.stop());
    if (reference_.points.empty()) {
      session_.say("maps: " + name_ + " shows no irradiance anywhere; left out");
      return;
    }
    reportReference();
    for (const std::string& quality : effort_.qualities) {
      if (quality != "high" || subject_.high) bake(quality);
    }
    gather();
    for (const double error : effort_.errors) reportSoonness(error);
    if (subject_.rates) measureBakeRates(session_, name_, *opened_);
    if (subject_.besideCycles)
      measureCyclesBake(session_, subject_.file, *opened_->world, reference_, medium_, threads_);
  }

 private:
  std::string keyOf(const std::string& name) const { return "maps/" + name_ + "/" + name; }

  app::SceneOptions sceneOptions(const std::string& quality) const {
    app::SceneOptions options;
    options.path = subject_.file;
    options.load.unitScale = subject_.unitScale;
    options.quality = quality;
    return options;
  }
  std::filesystem::path folder() const { return session_.options().folder / "maps"; }

  Record recordOf(const std::string& name, const std::string& method) const {
    Record record;
    record.key = keyOf(name);
    record.labels = {{"scene", name_}, {"method", method}};
    return record;
  }

  /// What `world`, with its maps set, holds at the points.
  std::vector<core::Vec3> lookUp(const raytrace::World& world) const {
    std::vector<core::Vec3> found;
    found.reserve(reference_.points.size());
    for (const raytrace::SurfacePoint& p : reference_.points)
      found.push_back(raytrace::mapIrradiance(world, p));
    return found;
  }

  void reportReference() {
    const std::vector<core::Vec3> nothing(reference_.points.size(), core::Vec3(0));
    const MapError counts = errorOf(nothing, reference_.truth);
    Record record = recordOf("reference", "reference");
    record.values = {{"relerr", Value::error(reference_.noise)},
                     {"points", Value::count(static_cast<double>(counts.lit + counts.dark))},
                     {"dark_points", Value::count(static_cast<double>(counts.dark))},
                     {"paths", Value::count(static_cast<double>(reference_.samplesPerPoint))}};
    if (!reference_.reached) record.labels["status"] = "stopped before its noise was as low as asked for";
    session_.add(record, nullptr);
  }

  static void addErrors(Record& record, const MapError& error) {
    record.values["relerr"] = Value::error(error.relative);
    record.values["relerr_with_dark"] = Value::error(error.withDark);
    record.values["bias"] = Value::error(error.bias);
    record.values["bias"].better = Better::neither;
    record.values["p99"] = Value::error(error.p99);
  }

  /// Of all layers, blocks of finer texels included.
  static void addSize(Record& record, const core::IlluminationMaps& maps) {
    const std::size_t texels = (maps.texels.size() + maps.detail.texels.size()) / 3;
    record.values["texels"] = Value::count(static_cast<double>(texels));
    record.values["map_bytes"] = Value::bytes(static_cast<double>(maps.lightBytes()));
  }

  /// As `saccade bake` does it, a few times where that is quick.
  void bake(const std::string& quality) {
    const app::BakeRequest request{.file = folder() / (name_ + "-" + quality + ".maps"),
                                   .always = true,
                                   .threads = threads_,
                                   .seed = session_.options().seed};
    const app::SceneOptions options = sceneOptions(quality);
    const LoadWatch watch;
    std::vector<double> seconds;
    double spent = 0;
    for (int round = 0; round < kRepeats && (round == 0 || spent < kSecondsPerSetting); ++round) {
      session_.say("maps: " + name_ + ", " + quality + ", repeat " + std::to_string(round + 1));
      opened_.reset();
      seconds.push_back(timed([&] { opened_ = app::openWorkspace(options, request, session_.stop()); }));
      spent += seconds.back();
    }
    const std::vector<core::Vec3> found = lookUp(*opened_->world);
    const MapError error = errorOf(found, reference_.truth);
    Record record = recordOf(quality, "ours");
    record.labels["quality"] = quality;
    record.at = {{"particles", static_cast<double>(raytrace::qualityOf(quality).photons)}};
    record.values = {{"seconds", Value::seconds(seconds)}};
    addErrors(record, error);
    addSize(record, opened_->maps);
    session_.add(record, &watch);
    session_.say("maps: " + name_ + ", " + quality + ": error " + percentOf(error.relative));
    ours_.push_back({spread(seconds).median, error.relative});
    if (quality == "medium") medium_ = {spread(seconds).median, found};
    mapsFile_ = request.file;
    mapsOptions_ = options;
    writeWorstPoints(folder() / (name_ + "-" + quality + "-worst.csv"), *opened_->world, reference_, found,
                     kWorstPoints);
  }

  /// Stopped where it has taken so long that ours is proved to be soon enough.
  double gatherCap() const {
    double enough = 0;
    for (const double error : effort_.errors) {
      const auto ours = secondsToError(ours_, error);
      if (ours) enough = std::max(enough, ours->seconds / kGoalRatio);
    }
    return std::clamp(1.2 * enough, effort_.leastGatherSeconds, effort_.mostGatherSeconds);
  }

  /// Four times the paths from point to point, less where the time would not do.
  static std::uint64_t nextPaths(const GatheredMaps& maps, double cap) {
    const std::uint64_t n = maps.paths();
    if (n == 0) return 1;
    const auto affordable = static_cast<std::uint64_t>(static_cast<double>(n) * cap / maps.seconds());
    return std::min(4 * n, affordable);
  }

  void gather() {
    // The seconds until there is something to gather into: all but charts.
    const double ready = timed([&] {
      opened_ = app::openWorkspace(mapsOptions_, {.file = mapsFile_, .threads = threads_}, session_.stop());
    });
    const LoadWatch watch;
    const double cap = gatherCap();
    GatheredMaps gathered(*opened_, session_.options().seed, threads_);
    double error = 1e9;
    for (std::uint64_t n = 1; error > effort_.errors.back(); n = nextPaths(gathered, cap)) {
      if (10 * n < 11 * gathered.paths()) break;  // the cap is reached, as near as it pays
      session_.say("maps: " + name_ + ", path-traced gather, " + std::to_string(n) + " paths a texel");
      app::ProgressBar bar("gathering");
      gathered.growTo(n, {[&](double fraction) { bar.show(fraction); }, session_.stop()});
      error = reportGather(gathered, ready, watch);
    }
    opened_->world->setMaps(&opened_->maps);
  }

  double reportGather(const GatheredMaps& gathered, double ready, const LoadWatch& watch) {
    double seconds = ready + gathered.seconds();
    const core::IlluminationMaps maps = gathered.maps(seconds);
    opened_->world->setMaps(&maps);
    const MapError error = errorOf(lookUp(*opened_->world), reference_.truth);
    opened_->world->setMaps(&opened_->maps);
    const std::string paths = std::to_string(gathered.paths());
    Record record = recordOf("gather@" + paths + "paths", "path-traced gather");
    record.at = {{"paths", static_cast<double>(gathered.paths())}};
    record.values = {{"seconds", Value::seconds({seconds})}};
    addErrors(record, error);
    addSize(record, maps);
    session_.add(record, &watch);
    session_.say("maps: " + name_ + ", gather, " + paths + " paths: error " + percentOf(error.relative));
    gather_.push_back({seconds, error.relative});
    return error.relative;
  }

  void reportSoonness(double error) {
    Record record = soonness(ours_, gather_, error);
    record.key = keyOf("to-" + shortNumber(error));
    record.labels["scene"] = name_;
    session_.add(record, &watch_);
  }

  Session& session_;
  Subject subject_;
  std::string name_;
  Effort effort_;
  int threads_;
  PointReference reference_;
  std::unique_ptr<app::Workspace> opened_;  ///< with the maps baked last
  app::SceneOptions mapsOptions_;           ///< of those
  std::filesystem::path mapsFile_;
  std::vector<CurvePoint> ours_, gather_;
  OurBake medium_;
  LoadWatch watch_;
};

/// Those of another person's scenes that are not in metres say so; Cycles bakes the room that it has
/// rendered.
Subject subjectOf(const std::string& file) {
  const std::string name = sceneName(file);
  return {file, name == "conference" ? 0.003f : 1.0f, name == "cornell_glossy",
          name == "cornell" || name == "gallery" || name == "conference",
          name != "gallery" && name != "conference"};
}

std::vector<Subject> subjectsOf(const Session& session) {
  std::vector<std::string> files = session.options().scenes;
  if (files.empty()) files = {bundledScene("cornell")};
  if (session.options().scenes.empty() && !session.quick()) {
    files.insert(files.end(), {bundledScene("table"), bundledScene("gallery")});
    for (const char* relative :
         {"scenes/conference/conference.obj", "references/cycles/cornell_glossy.glb"}) {
      const auto file = sharedFile(relative);
      if (file) files.push_back(*file);
      if (!file)
        session.say(std::string("maps: ") + relative +
                    " of the shared folder is not here (set SACCADE_SHARED)");
    }
  }
  std::vector<Subject> subjects(files.size());
  std::transform(files.begin(), files.end(), subjects.begin(), subjectOf);
  return subjects;
}

}  // namespace

void measureMaps(Session& session) {
  for (const Subject& subject : subjectsOf(session)) MapsOfScene(session, subject).run();
}

}  // namespace saccade::bench
