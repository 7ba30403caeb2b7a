// What a person does in an open scene beside walking: points at objects, keeps places, records and plays
// paths.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/session/picking.h"
#include "app/viewer/bookmarks.h"
#include "app/viewer/camera_drive.h"
#include "core/scene/scene.h"
#include "render/window/window.h"

namespace saccade::app {

/// What buttons and keys ask for; each is served once.
struct ToolRequests {
  bool recordPath = false;  ///< begin, or end and save
  bool playPath = false;    ///< begin, or stop
  bool addBookmark = false;
  std::optional<std::size_t> goTo, setBookmark, removeBookmark;  ///< bookmarks from 0; others are ignored
};

/// Seconds are the window's clock. One thread. Nothing here throws: what fails is said in message().
class SceneTools {
 public:
  /// The scene must outlive the tools. Recorded paths go into the current folder.
  explicit SceneTools(const core::Scene& scene);

  void serve(const ToolRequests& requests, const core::Camera& camera, double now);
  /// A path that is played at once, and by playPath later.
  void play(const CameraPath& path, double now);
  void flyTo(const core::Camera& to, const core::Camera& from, double now) { drive_.flyTo(to, from, now); }
  /// A person takes the camera.
  void release() { drive_.stop(); }
  void setLoop(bool on) { drive_.setLoop(on); }
  /// Where flights and paths have the camera now; nothing: it is free.
  std::optional<core::Camera> camera(double now) { return drive_.at(now); }
  /// Once a frame, with the camera it shows.
  void observe(const core::Camera& camera, double now);

  /// Nothing under the pointer: nothing is picked.
  void setPicked(std::optional<PickedObject> picked) { picked_ = std::move(picked); }

  const std::optional<PickedObject>& picked() const { return picked_; }
  const std::vector<core::Camera>& bookmarks() const;
  bool recording() const { return recording_; }
  double recordedSeconds() const { return recorded_.empty() ? 0 : recorded_.back().seconds; }
  bool playing() const { return drive_.playing(); }
  bool hasPath() const { return path_.has_value(); }
  /// What was done or failed last; empty: nothing since the last call.
  std::string takeMessage() { return std::exchange(message_, {}); }

 private:
  void serveBookmarks(const ToolRequests& requests, const core::Camera& camera, double now);
  void toggleRecording(double now);
  void togglePlaying(const core::Camera& camera, double now);
  void saveRecorded();

  const core::Scene& scene_;
  CameraDrive drive_;
  std::optional<Bookmarks> bookmarks_;  ///< nothing: they cannot be kept
  std::optional<CameraPath> path_;      ///< the one that playPath plays
  std::vector<CameraKey> recorded_;
  bool recording_ = false;
  double recordStart_ = 0;
  std::optional<PickedObject> picked_;
  std::string message_;
};

/// What a key asks for, if anything.
void request(render::Key key, bool control, ToolRequests& wanted);

/// STEM_0001EXT in the current folder, the first number that is free. Throws core::Error where the folder
/// cannot be listed.
std::filesystem::path freeFile(const std::string& stem, const std::string& extension);

}  // namespace saccade::app
