// What `saccade replay` was asked for, shared by its two forms.
#pragma once

#include <optional>
#include <string>

namespace saccade::app {

struct ReplayOptions {
  std::string file;
  bool headless = false;
  bool verify = false;
  std::string framesFolder;
  std::string compare;  ///< another session, or a folder of frames; the reference
  bool json = false;
  double fromSeconds = 0;
  double speed = 1;
  std::string output;
  std::string sceneFile, mapsFile;  ///< empty = where they were
  std::string context;              ///< empty = as recorded
  std::optional<double> exitAfterSeconds;
  std::string uiScreenshot;
};

}  // namespace saccade::app
