#include "app/viewer/scene_tools.h"

#include <cstdio>
#include <utility>

#include "core/cache_folder.h"
#include "core/error.h"

namespace saccade::app {

namespace {

constexpr float kRoomDiagonal = 20;  ///< metres; PathTolerance's centimetre is meant for rooms

PathTolerance toleranceIn(const core::Scene& scene) {
  PathTolerance tolerance;
  tolerance.eyeMetres *= scene.bounds.diagonal() / kRoomDiagonal;
  return tolerance;
}

}  // namespace

std::filesystem::path freeFile(const std::string& stem, const std::string& extension) {
  std::error_code failed;
  const std::filesystem::path folder = std::filesystem::current_path(failed);
  for (int i = 1; !failed; ++i) {
    char number[16];
    std::snprintf(number, sizeof number, "_%04d", i);
    std::filesystem::path file = folder / (stem + number);
    file += extension;
    if (!std::filesystem::exists(file, failed)) return file;
  }
  throw core::Error("the current folder cannot be read: " + failed.message() + "; start in another one");
}

void request(render::Key key, bool control, ToolRequests& wanted) {
  using render::Key;
  if (key == Key::b) wanted.addBookmark = true;
  if (key == Key::t) wanted.recordPath = true;
  if (key == Key::p) wanted.playPath = true;
  if (key < Key::f2 || key > Key::f9) return;
  (control ? wanted.setBookmark : wanted.goTo) =
      static_cast<std::size_t>(key) - static_cast<std::size_t>(Key::f2);
}

SceneTools::SceneTools(const core::Scene& scene) : scene_(scene), drive_(scene.bounds.diagonal()) {
  try {
    bookmarks_.emplace(core::configFolder() / "bookmarks.json", scene.path);
  } catch (const core::Error& e) {
    message_ = e.what();
  }
}

const std::vector<core::Camera>& SceneTools::bookmarks() const {
  static const std::vector<core::Camera> kNone;
  return bookmarks_ ? bookmarks_->all() : kNone;
}

void SceneTools::serve(const ToolRequests& requests, const core::Camera& camera, double now) {
  try {
    serveBookmarks(requests, camera, now);
    if (requests.recordPath) toggleRecording(now);
    if (requests.playPath) togglePlaying(camera, now);
  } catch (const core::Error& e) {
    message_ = e.what();
  }
}

void SceneTools::serveBookmarks(const ToolRequests& requests, const core::Camera& camera, double now) {
  const auto there = [this](const std::optional<std::size_t>& index) {
    return index && *index < bookmarks().size();
  };
  if (there(requests.goTo)) drive_.flyTo(bookmarks()[*requests.goTo], camera, now);
  if (!bookmarks_) {
    if (requests.addBookmark) message_ = "bookmarks cannot be kept; set HOME or XDG_CONFIG_HOME";
    return;
  }
  if (there(requests.setBookmark)) bookmarks_->set(*requests.setBookmark, camera);
  if (there(requests.removeBookmark)) bookmarks_->remove(*requests.removeBookmark);
  if (requests.addBookmark) {
    bookmarks_->add(camera);
    message_ = "kept as " + bookmarks().back().name;
  }
}

void SceneTools::play(const CameraPath& path, double now) {
  path_ = path;
  drive_.play(path, now);
}

void SceneTools::togglePlaying(const core::Camera& camera, double now) {
  if (drive_.playing()) return drive_.stop();
  if (recording_) toggleRecording(now);
  if (!path_) {
    message_ = "no path yet: record one, or start with --path FILE";
    return;
  }
  drive_.play(*path_, camera, now);
}

void SceneTools::toggleRecording(double now) {
  recording_ = !recording_;
  if (!recording_) return saveRecorded();
  recorded_.clear();
  recordStart_ = now;
}

void SceneTools::observe(const core::Camera& camera, double now) {
  if (!recording_) return;
  const double seconds = now - recordStart_;
  if (recorded_.empty() || seconds > recorded_.back().seconds) recorded_.push_back({seconds, camera});
}

void SceneTools::saveRecorded() {
  if (recorded_.empty()) return;
  const std::vector<CameraKey> keys = thinned(recorded_, toleranceIn(scene_));
  path_ = CameraPath::through(keys);  // playable even where it cannot be written
  const std::filesystem::path file = freeFile("saccade_path", ".json");
  writeCameraPath(file, keys);
  message_ = "saved " + file.string() + ": " + std::to_string(keys.size()) + " keys of " +
             std::to_string(recorded_.size()) + " frames";
}

}  // namespace saccade::app
