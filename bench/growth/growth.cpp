#include "bench/growth/growth.h"

#include <cmath>

#include "app/session/camera_path.h"
#include "bench/growth/frame.h"
#include "bench/harness/method.h"
#include "core/error.h"

namespace saccade::bench {
namespace {

/// A point of one curve.
struct GrowthPoint {
  std::string quantity, geometry;
  double at = 0;  ///< what was asked for, in the key
  FrameSize size;

  std::string key() const {
    char value[32];
    std::snprintf(value, sizeof value, "%g", at);
    return "growth/" + quantity + "/" + (geometry.empty() ? "" : geometry + "/") + value;
  }
};

/// 10 to the power of `from`, `from` + step, ... `to`.
std::vector<double> powers(double from, double to, double step) {
  std::vector<double> values;
  for (double e = from; e < to + step / 2; e += step) values.push_back(std::round(std::pow(10.0, e)));
  return values;
}

std::vector<GrowthPoint> pointsOf(bool few) {
  std::vector<GrowthPoint> points;
  for (const bool instanced : {true, false}) {
    for (const double n : few ? powers(4, 5, 1) : powers(4, 7, 0.5)) {
      GrowthPoint p{"triangles", instanced ? "instanced" : "copied", n, {}};
      p.size.scene.triangles = static_cast<std::size_t>(n);
      p.size.scene.instanced = instanced;
      points.push_back(p);
    }
  }
  for (const double n : few ? powers(3, 5, 2) : powers(2, 6, 0.5)) {
    GrowthPoint p{"samples", "", n, {}};
    p.size.samples = static_cast<std::size_t>(n);
    points.push_back(p);
  }
  for (const double n : few ? powers(1, 3, 2) : powers(1, 4, 0.5)) {
    GrowthPoint p{"objects", "", n, {}};
    p.size.scene.balls = static_cast<std::size_t>(n);
    p.size.scene.triangles = 1'000'000;  // a hundred triangles for each of 10,000
    points.push_back(p);
  }
  for (const double millions :
       few ? std::vector<double>{0.1, 1} : std::vector<double>{0.1, 0.25, 0.5, 1, 2, 4, 8}) {
    GrowthPoint p{"pixels", "", 1e6 * millions, {}};
    p.size.side = static_cast<int>(std::lround(std::sqrt(p.at)));
    points.push_back(p);
  }
  return points;
}

Value millisecondsOf(const Figures& f, const std::string& stage) {
  Value value = Value::milliseconds({f.at(stage + "_min"), f.at(stage), f.at(stage + "_max")});
  value.repeats = static_cast<int>(f.at("frames"));
  return value;
}

void measurePoint(Session& session, const GrowthPoint& point) {
  session.say(point.key());
  Record record;
  record.key = point.key();
  record.labels = {{"quantity", point.quantity}};
  if (!point.geometry.empty()) record.labels["geometry"] = point.geometry;
  record.at = {{point.quantity, point.at}};
  const LoadWatch watch;
  try {
    const Figures f = inChild("frame", point.size.arguments(), session.stop());
    record.at = {{point.quantity, f.at(point.quantity)}};
    for (const char* stage : {"frame", "age", "draw", "warp", "composite"})
      record.values[std::string(stage) + "_ms"] = millisecondsOf(f, stage);
    record.values["peak_bytes"] = Value::bytes(f.at("bytes"));
    record.values["scene_bytes"] = Value::bytes(f.at("scene_bytes"));
    record.values["build"] = Value::seconds({f.at("build")});
  } catch (const core::Error& e) {
    session.checkStop();
    session.say(point.key() + ": " + e.what());
    record.labels["status"] = e.what();
  }
  session.add(record, &watch);
}

/// Frames of 50 ms beside the draw, as Haber 2001, section 5, counts samples: drawing and warping come before
/// them.
Record tracerPoint(const Stage& stage, const app::CameraPath& path, int tracers,
                   const std::stop_token& stop) {
  constexpr int kFrames = 20;
  constexpr std::chrono::milliseconds kBudget(50);
  const Pinned main(mainCores());
  const auto loop = pinnedLoop(stage, {.threads = tracers, .seed = stage.seed, .asynchronousAnalysis = true});
  std::vector<double> samples, frames;
  for (int i = -1; i < kFrames; ++i) {
    if (stop.stop_requested()) throw core::Error("stopped on request");
    const core::Camera camera = path.at(path.lengthSeconds() * (i + 1) / (kFrames + 1));
    const double start =
        1000 * timed([&] { loop->step(camera, {}, app::FrameBudget::firstSamples(0), stop); });
    const std::uint64_t before = loop->stats().samplesTraced;
    loop->step(camera, {}, app::FrameBudget::untilDeadline(kBudget), stop);
    if (i < 0) continue;
    frames.push_back(start);
    samples.push_back(static_cast<double>(loop->stats().samplesTraced - before));
  }
  Value inBudget = Value::rate(samples);
  inBudget.unit = "1/50 ms";
  Record record;
  record.key = "growth/threads/" + std::to_string(tracers);
  record.labels = {{"quantity", "threads"}};
  record.at = {{"threads", tracers}};
  record.values = {{"samples_in_50ms", inBudget}, {"frame_ms", Value::milliseconds(frames)}};
  return record;
}

void measureTracers(Session& session) {
  const auto stage = openStage(bundledScene("gallery"), "preview", session.options().seed, session.stop());
  const app::CameraPath path = app::CameraPath::read(bundledPath("gallery"));
  for (const int tracers : session.quick() ? std::vector<int>{1, 2} : std::vector<int>{1, 2, 4, 8}) {
    session.say("growth/threads/" + std::to_string(tracers));
    const LoadWatch watch;
    session.add(tracerPoint(*stage, path, tracers, session.stop()), &watch);
  }
}

}  // namespace

void measureGrowth(Session& session) {
  for (const GrowthPoint& point : pointsOf(session.quick())) measurePoint(session, point);
  measureTracers(session);
}

}  // namespace saccade::bench
