// What `saccade walk` was asked for, shared by its two forms.
#pragma once

#include <optional>
#include <string>

#include "app/cli/options.h"

namespace saccade::app {

class FrameLoop;

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
  std::string output;
  bool converge = false;
  std::optional<double> budgetMs;
  std::optional<std::uint64_t> samples;
  std::string uiScreenshot;
  std::optional<double> exitAfterSeconds;
  std::string overlay;
};

/// Writes the last frame to options.output, linear or as displayed after its extension.
void writeLast(const WalkOptions& options, FrameLoop& loop);

}  // namespace saccade::app
