// What `saccade walk` was asked for, shared by its two forms.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/cli/options.h"
#include "app/session/workspace.h"
#include "render/context/gl_context.h"

namespace saccade::app {

class FrameLoop;
class SessionRecorder;

inline constexpr double kOrbitPeriodSeconds = 12;

struct WalkOptions {
  SceneOptions scene;
  CameraOptions camera;
  RunOptions run;
  CorrectiveOptions corrective;
  ImageSize size;
  bool headless = false;
  bool orbit = false;
  std::string path;
  double fps = 25;
  std::optional<double> seconds;
  std::string framesFolder;
  std::string record;
  std::string output;
  bool converge = false;
  bool keepCache = false;
  std::optional<double> budgetMs;
  std::optional<std::uint64_t> samples;
  std::string uiScreenshot;
  std::optional<double> exitAfterSeconds;
  std::string overlay;
  std::optional<double> uiScale;  ///< nothing: what the display says
  /// Said on the command line: goes before what the window kept (app/viewer/window_settings.h).
  struct Given {
    bool size = false, fps = false, attention = false, exposure = false, delta = false, approximation = false;
  } given;
};

/// For another scene in the same window: what was said about the first one itself (how to read it, its maps,
/// camera, path and recording) does not hold for it.
WalkOptions laterVisit(const WalkOptions& first, const std::filesystem::path& scene);

/// What both forms open a scene with.
BakeRequest bakeOf(const WalkOptions& options);

/// What --record asked for, or null. Throws core::Error when the file is there and no recording.
std::unique_ptr<SessionRecorder> makeRecorder(const WalkOptions& options, const Workspace& workspace,
                                              const render::GlContext& context);
/// Closes the recording and says what became of it. The walk's exit status: 1 where it is incomplete.
int finishRecording(SessionRecorder* recorder, const std::string& file);

/// Writes the last frame to options.output, linear or as displayed after its extension.
void writeLast(const WalkOptions& options, FrameLoop& loop);

}  // namespace saccade::app
