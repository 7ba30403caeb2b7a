// saccade replay: a recorded session again, without tracing a ray.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/cli/console.h"
#include "app/cli/replay_options.h"
#include "app/commands.h"
#include "app/recording/session_check.h"
#include "app/recording/session_comparison.h"
#include "app/recording/session_replay.h"
#include "app/session/headless.h"
#include "app/viewer/replay_viewer.h"
#include "core/error.h"
#include "core/image_io.h"

namespace saccade::app {

namespace {

/// A session with all that shows it off screen.
struct OffScreen {
  SessionReader session;
  std::unique_ptr<Workspace> workspace;
  Headless gl;
  SessionReplay replay;

  OffScreen(const std::string& file, const ReplayOptions& o)
      : session(file),
        workspace(openRecorded(session, o.sceneFile, o.mapsFile)),
        gl({.context = contextOf(o), .threads = 0}, *workspace),
        replay(session, workspace->scene, *gl.renderer) {}

  std::string contextOf(const ReplayOptions& o) const {
    if (!o.context.empty()) return o.context;
    return session.info().on.context == "egl" ? "egl" : "osmesa";
  }
  RecordedOn here() const { return {gl.context->name(), gl.context->renderer(), cpuName()}; }
};

std::filesystem::path frameFile(const std::string& folder, std::int64_t number) {
  char name[32];
  std::snprintf(name, sizeof name, "frame_%05lld.png", static_cast<long long>(number));
  return std::filesystem::path(folder) / name;
}

/// The other side of --compare: another session, or a folder of frames.
class Other {
 public:
  explicit Other(const ReplayOptions& o) : path_(o.compare) {
    if (!std::filesystem::is_directory(path_)) session_ = std::make_unique<OffScreen>(path_, o);
  }

  /// The picture to compare with a frame of the first session; nothing once there are no more.
  std::optional<core::ImageRgba8> pictureFor(const SessionReplay& first) {
    if (!session_) {
      const std::filesystem::path file = frameFile(path_, first.number());
      if (!std::filesystem::exists(file)) return {};
      return core::readImage8(file);
    }
    while (session_->replay.frames() <= first.number()) {
      if (!session_->replay.next()) return {};
    }
    if (!session_->replay.frame().camera.samePicture(first.frame().camera))
      throw core::Error(path_ + ": frame " + std::to_string(first.number()) +
                        " has another camera; compare sessions along the same path and frame rate");
    return session_->replay.display();
  }

  core::Warnings warnings() const { return session_ ? session_->replay.warnings() : core::Warnings{}; }

 private:
  std::string path_;
  std::unique_ptr<OffScreen> session_;
};

void reportCheck(const SessionCheck& check) {
  if (!check.sameMachine())
    spdlog::warn(
        "recorded with another renderer, context, CPU or version of Saccade: {} pictures are equal bit for "
        "bit, {} within {} of "
        "255 in "
        "every tile",
        check.equal(), check.similar(), check.largestTileDifference());
}

int replayOffScreen(const ReplayOptions& o) {
  OffScreen main(o.file, o);
  SessionReplay& replay = main.replay;
  std::optional<Other> other;
  if (!o.compare.empty()) other.emplace(o);
  SessionCheck check(main.session.info().on, main.here());
  SessionComparison comparison;
  if (!o.framesFolder.empty()) std::filesystem::create_directories(o.framesFolder);
  const std::stop_token stop = interruptToken();
  std::int64_t shown = 0;
  std::optional<std::string> failure;
  while (!failure && !stop.stop_requested() && replay.next()) {
    if (replay.frame().seconds < o.fromSeconds) continue;
    ++shown;
    if (o.verify) failure = check.difference(replay.frame(), replay.display());
    if (failure) failure = "frame " + std::to_string(replay.number()) + ": " + *failure;
    if (!o.framesFolder.empty()) core::writePng(frameFile(o.framesFolder, replay.number()), replay.display());
    if (!other) continue;
    const std::optional<core::ImageRgba8> reference = other->pictureFor(replay);
    if (!reference) break;
    comparison.add(replay.number(), replay.frame().seconds, *reference, replay.display());
  }
  if (shown > 0 && !o.output.empty()) core::writePng(o.output, replay.display());
  printWarnings(replay.warnings());
  if (other) printWarnings(other->warnings());
  if (o.verify) reportCheck(check);
  if (failure) throw core::Error(o.file + ": " + *failure);
  if (shown == 0)
    throw core::Error(o.file + ": no frame to show" + (o.fromSeconds > 0 ? " from --from on" : ""));
  if (other) {
    comparison.print(o.json);
  } else {
    std::printf("%lld frames%s\n", static_cast<long long>(shown), o.verify ? ", as they were recorded" : "");
  }
  return 0;
}

int replay(const ReplayOptions& o) {
  const bool offScreen =
      o.headless || o.verify || !o.framesFolder.empty() || !o.compare.empty() || !o.output.empty();
  return offScreen ? replayOffScreen(o) : runReplayViewer(o);
}

}  // namespace

void addReplayCommand(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand(
      "replay",
      "Show a session recorded by walk --record, without tracing a ray: in a window, or off screen");
  auto o = std::make_shared<ReplayOptions>();
  command->add_option("FILE", o->file, "Recorded session")->required();
  command->add_flag("--headless", o->headless, "No window; implied by --verify, --frames, --compare and -o");
  command->add_flag(
      "--verify", o->verify,
      "Compare every picture's hash with the recorded one; exit 1 naming the first that differs "
      "(on another machine: by the mean colours of 32 x 32 tiles)");
  command->add_option("--frames", o->framesFolder, "Write every frame to this folder as PNG");
  CLI::Option* compare = command->add_option(
      "--compare", o->compare,
      "Error frame by frame (RMSE, FLIP) against OTHER: a session along the same cameras, or a folder of "
      "frame_00000.png, ... as --frames writes them");
  compare->option_text("OTHER");
  command->add_flag("--json", o->json, "With --compare: machine-readable output")->needs(compare);
  command->add_option("--from", o->fromSeconds, "Begin at this second; what comes before is replayed unseen")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--speed", o->speed, "Window: times the recorded speed")
      ->check(CLI::Range(1e-3, 1e3))
      ->capture_default_str();
  command->add_option("-o,--output", o->output, "Write the last frame: .png");
  command->add_option("--scene-file", o->sceneFile, "Where the scene is, if not where it was");
  command->add_option("--maps", o->mapsFile, "Where its illumination maps are, if not where they were");
  command->add_option("--context", o->context, "OpenGL off screen: osmesa or egl (default: as recorded)")
      ->check(CLI::IsMember({"osmesa", "egl"}));
  command->add_option("--exit-after", o->exitAfterSeconds, "Window: close after so many seconds")
      ->check(CLI::PositiveNumber);
  command->add_option("--ui-screenshot", o->uiScreenshot, "Window: write what it shows when it closes");
  command->callback([o, &run] { run = [o] { return replay(*o); }; });
}

}  // namespace saccade::app
