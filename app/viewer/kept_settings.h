// What the window keeps between runs: how it was left, and which scenes it showed. In one JSON file,
// configFolder()/settings.json.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "app/cli/options.h"

namespace saccade::app {

inline constexpr std::size_t kMostRecent = 10;

/// Nothing: never changed, the program's own default goes.
struct KeptSettings {
  std::optional<ImageSize> window;  ///< panel included, while not full screen; as render::Window takes it
  std::optional<bool> fullscreen;
  std::optional<bool> panelVisible;
  std::optional<bool> errorPlotOpen;
  std::optional<bool> corrections;
  std::optional<bool> reuse;
  std::optional<bool> approximation;
  std::optional<double> attention;   ///< [0, 1]
  std::optional<double> fps;         ///< [0.1, 1000]
  std::optional<double> exposureEv;  ///< [-64, 64]
  std::optional<double> delta;       ///< [0, 2]
  /// Scene files, absolute, newest first, none twice, kMostRecent at most.
  std::vector<std::filesystem::path> recent;
};

/// The file of them. One thread at a time.
class SettingsFile {
 public:
  /// Finds its place, it need not be there. Where there is no place for it one warning says that nothing is
  /// kept.
  SettingsFile();

  /// What was kept, less recent scenes that are gone. What cannot be read is as never changed, which one
  /// warning says. No file: nothing was changed.
  KeptSettings load() const;
  /// Changes what is kept now, so that what another window kept meanwhile stays. Of two that do so within the
  /// same milliseconds one may be lost; the file is whole at any time. One that load could not read is kept
  /// beside the new one, under its name and ".broken" (the last one of several). Where nothing can be written
  /// one warning says so, and no more. What changes nothing writes nothing.
  void change(const std::function<void(KeptSettings&)>& change);

 private:
  void write(const KeptSettings& settings) const;

  std::filesystem::path file_;  ///< empty: no place
  bool warned_ = false;         ///< that nothing can be written
};

/// To the front, made absolute.
void addRecent(KeptSettings& settings, const std::filesystem::path& scene);

}  // namespace saccade::app
