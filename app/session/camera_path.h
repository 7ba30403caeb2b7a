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
  /// Through these, at least one, times rising.
  static CameraPath through(std::vector<CameraKey> keys);

  /// Clamped at both ends; Catmull-Rom between keys (monotone in time, passes through every key exactly).
  core::Camera at(double seconds) const;
  double beginSeconds() const { return begin_; }
  double lengthSeconds() const { return end_; }  ///< from 0, whenever the first key is
  /// Those within the path's time, as a file holds them.
  std::vector<CameraKey> keys() const;

 private:
  CameraPath(std::vector<CameraKey> keys, double begin, double end)
      : keys_(std::move(keys)), begin_(begin), end_(end) {}
  std::vector<CameraKey> keys_;  ///< at least one; may reach beyond [begin_, end_] to shape the curve's ends
  double begin_, end_;           ///< seconds; times of keys
};

/// In the form that CameraPath::read takes, to the last bit. Throws core::Error when it cannot be written.
void writeCameraPath(const std::filesystem::path& file, const std::vector<CameraKey>& keys);

/// How far a path may stray from the cameras it was made from.
struct PathTolerance {
  float eyeMetres = 0.01f;
  float radians = 0.005f;  ///< between lines of sight: 0.3 degrees
  float fovDegrees = 0.1f;
};

/// Whether a camera is within the tolerance of another; both upright alike.
bool within(const PathTolerance& tolerance, const core::Camera& a, const core::Camera& b);

/// As few of the recorded keys as a greedy choice finds through which a path strays from none of them by more
/// than the tolerance. Times rise; the first and the last stay. Fewer than three are returned as they are.
std::vector<CameraKey> thinned(const std::vector<CameraKey>& recorded, const PathTolerance& tolerance);

}  // namespace saccade::app
