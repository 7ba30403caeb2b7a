// Shows a recorded session again, frame by frame, without tracing a ray.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/recording/session_reader.h"
#include "app/session/corrected_picture.h"
#include "app/session/workspace.h"

namespace saccade::app {

/// Scene and maps that a session was recorded with; `sceneFile` and `mapsFile` where they are now, empty =
/// where they were. No ray-tracing world. Throws core::Error where a file is missing or is not what was
/// recorded.
std::unique_ptr<Workspace> openRecorded(const SessionReader& session, const std::string& sceneFile,
                                        const std::string& mapsFile);

/// Main thread only. Scene, renderer and session must outlive it.
class SessionReplay {
 public:
  SessionReplay(SessionReader& session, const core::Scene& scene, render::BaseRenderer& renderer);

  /// Makes the picture of the next frame. False at the end, which may be early: warnings().
  bool next();

  const RecordedFrame& frame() const { return *frame_; }  ///< after next()
  std::int64_t number() const { return frames_ - 1; }     ///< of frame(), from 0
  std::int64_t frames() const { return frames_; }         ///< shown so far
  const core::ImageRgba8& display() const { return picture_->display(); }
  CorrectedPicture& picture() { return *picture_; }

  /// What was repaired, and where a damaged recording ended; one line each. Complete once next() was false.
  core::Warnings warnings() const;

 private:
  bool show(const RecordedFrame& frame);
  void dropImpossible(core::SampleBatch& batch, const RecordedFrame& frame);

  SessionReader& session_;
  const core::Scene& scene_;
  render::BaseRenderer& renderer_;
  RunStats stats_;
  std::optional<CorrectedPicture> picture_;  ///< from the first frame on, whose settings it is made with
  std::optional<RecordedFrame> frame_;
  std::int64_t frames_ = 0;
  std::uint64_t droppedSamples_ = 0;
  std::string damage_;
};

}  // namespace saccade::app
