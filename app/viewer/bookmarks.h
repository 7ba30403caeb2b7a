// Cameras that a person keeps of a scene.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/camera.h"

namespace saccade::app {

/// In one JSON file for all scenes, {"version": 1, "scenes": {PATH: [{"name", "eye", "at", "up", "fov"}]}}:
/// each change reads it again, so that two windows on different scenes keep each other's. One thread.
class Bookmarks {
 public:
  /// Reads what the file has of the scene; no file: none. Throws core::Error for a damaged one.
  Bookmarks(std::filesystem::path file, const std::filesystem::path& scene);

  const std::vector<core::Camera>& all() const { return cameras_; }  ///< by number; each has a name
  /// Under the next number. The name says its number. These three write the file; they throw core::Error
  /// where that fails, having changed the list all the same.
  void add(const core::Camera& camera);
  /// In place of one that is there, under its name.
  void set(std::size_t index, const core::Camera& camera);
  void remove(std::size_t index);

 private:
  void save() const;

  std::filesystem::path file_;
  std::string scene_;  ///< absolute, without symbolic links
  std::vector<core::Camera> cameras_;
};

}  // namespace saccade::app
