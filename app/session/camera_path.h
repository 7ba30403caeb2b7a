// Where the camera is at a time: a JSON path, smooth between its keys, or an orbit.
#pragma once

#include <filesystem>
#include <vector>

#include "core/camera.h"

namespace saccade::app {

struct CameraKey {
  double seconds = 0;
  core::Camera camera;
};

/// Immutable; any thread.
class CameraPath {
 public:
  /// JSON [{"t": s, "eye": [x,y,z], "at": [..], "up": [..], "fov": degrees}, ...]; times must rise. "up" and
  /// "fov" may be left out (0,1,0 and 60). Throws core::Error naming file, key and rule.
  static CameraPath read(const std::filesystem::path& file);
  /// Around the point `camera` looks at, about the world's Y axis, once per `periodSeconds`, starting at
  /// `camera`.
  static CameraPath orbit(const core::Camera& camera, double periodSeconds);
  /// Standing still.
  static CameraPath still(const core::Camera& camera);

  /// Clamped at both ends; Catmull-Rom between keys (monotone in time, passes through every key exactly).
  core::Camera at(double seconds) const;
  double lengthSeconds() const { return end_; }

 private:
  CameraPath(std::vector<CameraKey> keys, double begin, double end)
      : keys_(std::move(keys)), begin_(begin), end_(end) {}
  std::vector<CameraKey> keys_;  ///< at least one; may reach beyond [begin_, end_] to shape the curve's ends
  double begin_, end_;           ///< seconds; times of keys
};

}  // namespace saccade::app
