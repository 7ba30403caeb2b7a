// What moves the window's camera when no keys do: flights from place to place, and paths.
#pragma once

#include <optional>

#include "app/session/camera_path.h"

namespace saccade::app {

/// From one camera to another in `seconds` that grow with the way: it starts and arrives at rest, with a
/// level horizon, and arrives exactly. Immutable; any thread.
class Flight {
 public:
  /// `sceneDiagonal` in metres sets the pace.
  Flight(const core::Camera& from, const core::Camera& to, float sceneDiagonal);
  double seconds() const { return seconds_; }
  /// Since the start; clamped at both ends.
  core::Camera at(double seconds) const;

 private:
  core::Camera from_, to_;
  double seconds_;
};

/// Seconds are the window's clock and grow. One thread.
class CameraDrive {
 public:
  explicit CameraDrive(float sceneDiagonal) : sceneDiagonal_(sceneDiagonal) {}

  void flyTo(const core::Camera& to, const core::Camera& from, double now);
  /// At once.
  void play(const CameraPath& path, double now);
  /// After a flight to where the path begins.
  void play(const CameraPath& path, const core::Camera& from, double now);
  /// At its end a path that loops flies back and begins again.
  void setLoop(bool on) { loop_ = on; }
  void stop();

  bool moving() const { return flight_ || path_; }
  bool playing() const { return path_.has_value(); }
  /// Where the camera is now; nothing while nothing moves it. The last call of a motion gives its end
  /// exactly.
  std::optional<core::Camera> at(double now);

 private:
  std::optional<core::Camera> alongPath(double now);

  float sceneDiagonal_;
  bool loop_ = false;
  std::optional<Flight> flight_;
  std::optional<CameraPath> path_;
  double start_ = 0;  ///< of the flight, else of the path
};

}  // namespace saccade::app
