#include "app/session/long_bake.h"

#include <spdlog/spdlog.h>

#include <optional>
#include <utility>

#include "app/cli/console.h"
#include "core/error.h"
#include "raytrace/bake/checkpoint.h"

namespace saccade::app {
namespace {

using Clock = std::chrono::steady_clock;

std::string percent(raytrace::BakeJob& job) {
  return std::to_string(static_cast<int>(100 * job.progress().fraction)) + " %";
}

void resume(raytrace::BakeJob& job, const LongBake& bake) {
  const std::filesystem::path file = checkpointPath(bake.maps);
  if (!std::filesystem::exists(file)) {
    if (bake.resume && bake.explicitly) spdlog::info("no checkpoint {}: starting anew", file.string());
    return;
  }
  if (!bake.resume) {
    spdlog::info("starting anew; --resume would have gone on from {}", file.string());
    return;
  }
  try {
    raytrace::readCheckpoint(file, bake.sceneKey, job,
                             bake.explicitly ? "bake without --resume to start anew" : "starting anew");
    spdlog::info("going on from {}, {} done", file.string(), percent(job));
  } catch (const core::Error& e) {
    if (bake.explicitly) throw;
    spdlog::warn("{}", e.what());
  }
}

/// Writes checkpoints; warns about the first that fails, and again when one has succeeded in between.
class Keeper {
 public:
  Keeper(raytrace::BakeJob& job, const LongBake& bake) : job_(job), bake_(bake) {}

  bool keep() {
    const std::filesystem::path file = checkpointPath(bake_.maps);
    try {
      std::error_code ignored;  // writing says what is wrong
      std::filesystem::create_directories(std::filesystem::absolute(file).parent_path(), ignored);
      raytrace::writeCheckpoint(file, bake_.sceneKey, job_);
      failed_ = false;
    } catch (const core::Error& e) {
      if (!std::exchange(failed_, true)) spdlog::warn("{}; baking on without a checkpoint", e.what());
    }
    return !failed_;
  }

  /// Keeps what is there and throws how to go on.
  [[noreturn]] void stopped() {
    if (!keep()) {
      const std::string before = howToGoOn(bake_.maps, bake_.explicitly);
      throw core::Error("stopped on request; no checkpoint could be written" +
                        (before.empty() ? ", a new bake starts anew" : before));
    }
    throw core::Error("stopped on request, " + percent(job_) + " done" +
                      howToGoOn(bake_.maps, bake_.explicitly));
  }

 private:
  raytrace::BakeJob& job_;
  const LongBake& bake_;
  bool failed_ = false;
};

}  // namespace

std::filesystem::path checkpointPath(const std::filesystem::path& maps) {
  std::filesystem::path file = maps;
  return file += ".part";
}

std::string howToGoOn(const std::filesystem::path& maps, bool explicitly) {
  std::error_code ignored;
  const std::filesystem::path file = checkpointPath(maps);
  if (!std::filesystem::exists(file, ignored)) return {};
  return std::string("; the same command") + (explicitly ? " with --resume" : "") + " goes on from " +
         file.string();
}

core::IlluminationMaps bakeLong(raytrace::BakeJob& job, core::SceneCharts charts, const LongBake& bake,
                                const std::stop_token& stop, const raytrace::BakeReport& report) {
  resume(job, bake);
  Keeper keeper(job, bake);
  ProgressBar bar("baking");
  const auto show = [&](const raytrace::BakeProgress& p) {
    bar.show(p.fraction, p.secondsLeft, std::string(p.stage));
    if (report) report(p);
  };
  for (bool done = false; !done;) {
    std::stop_source pause;
    const std::stop_callback onStop(stop, [&] { pause.request_stop(); });
    const Clock::time_point due = Clock::now() + bake.every;
    done = job.advance(pause.get_token(), [&](const raytrace::BakeProgress& p) {
      show(p);
      if (Clock::now() >= due) pause.request_stop();
    });
    if (stop.stop_requested()) keeper.stopped();
    if (!done) keeper.keep();
  }
  try {
    return job.finish(std::move(charts), stop, show);
  } catch (const core::Error&) {
    if (stop.stop_requested()) keeper.stopped();
    throw;
  }
}

void forgetCheckpoint(const std::filesystem::path& maps) {
  std::error_code ignored;  // most bakes need none
  std::filesystem::remove(checkpointPath(maps), ignored);
}

}  // namespace saccade::app
