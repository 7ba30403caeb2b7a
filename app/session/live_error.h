// Error against seconds of the picture at which the camera rests, measured while it converges. The reference
// is what it converges to: every non-diffuse pixel of the same frame, ray-traced in scanline order, so that
// the curve ends at 0 exactly (design fact 6).
//
// One thread of the lowest priority traces the reference and measures the pictures; it starts with the first
// rest that is observed. Pictures from before the reference is ready are kept, so that the curve has its
// beginning. Exact floats of non-diffuse pixels alone are kept: the others never change.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "app/session/log_series.h"
#include "core/corrective/messages.h"
#include "core/image.h"
#include "core/progress.h"

namespace saccade::raytrace {
class CorrectiveTracer;
}

namespace saccade::app {

/// How far the picture was from the ray-traced one.
struct ErrorPoint {
  double seconds = 0;  ///< since the camera came to rest, > 0
  double relmse = 0;   ///< of linear radiance (core/metrics/comparison.h)
  double flip = 0;     ///< mean, of what is seen at the window's exposure
};

/// One picture of a resting camera.
struct RestingPicture {
  core::FramePtr frame;                     ///< a new one = a new rest
  std::span<const core::Vec4> corrections;  ///< width * height; read during the call only
  double seconds = 0;                       ///< since the camera came to rest, growing
  bool converged = false;
  float exposureEv = 0;
};

/// Made, called and destroyed by one thread, which never waits for more than a list operation of the other.
class LiveError {
 public:
  /// The camera has come to rest: the reference is begun.
  static constexpr double kRestSeconds = 0.3;
  /// Pictures kept of one rest: kMaxPictures, fewer where they are more than kPictureBytes together, but
  /// kMinPictures. Beside them the work in hand: five pictures, and FLIP's planes (about 150 bytes a pixel).
  static constexpr std::size_t kMaxPictures = 32, kMinPictures = 4;
  static constexpr std::size_t kPictureBytes = std::size_t{128} << 20;

  /// width * height corrections of a frame; polls progress.stop and then throws core::Error. Called by the
  /// background thread.
  using Trace =
      std::function<std::vector<core::Vec4>(const core::FrameSnapshot& frame, const core::Progress&)>;

  struct State {
    bool resting = false;            ///< a rest is observed
    double referenceDone = 0;        ///< fraction of the reference, 1 = there
    std::vector<ErrorPoint> points;  ///< measured so far, by time
    std::size_t waiting = 0;         ///< pictures still to be measured
    bool complete = false;           ///< the converged picture is measured, and all before it
    std::string failure;             ///< why there is no curve, else empty
  };

  explicit LiveError(Trace trace);
  /// Cancels and joins. Destroy whatever keeps the cores busy first: the thread needs one to see the request.
  ~LiveError();
  LiveError(const LiveError&) = delete;
  LiveError& operator=(const LiveError&) = delete;

  /// The picture of the last step while the camera rests and the curve is looked at; once a frame. Copies it
  /// where the curve has room for it. Another exposure: FLIP is measured again.
  void observe(const RestingPicture& picture);
  /// The camera moved, or nobody looks: cancels what is under way and lets the pictures go. Cheap when
  /// nothing is observed.
  void reset();
  State state() const;

 private:
  struct Picture {
    double seconds;
    std::vector<core::Vec3> corrections;  ///< of the non-diffuse pixels in scanline order
    std::optional<ErrorPoint> error;      ///< guarded by mutex_
  };
  using Series = LogSeries<std::shared_ptr<Picture>>;
  /// What the thread does next: trace the reference where there is none, else measure the picture.
  struct Task {
    core::FramePtr frame;
    std::shared_ptr<const core::ImageRgb> reference;
    std::shared_ptr<Picture> picture;
    float exposureEv;
    std::stop_token stop;  ///< the rest is over; requested before its state goes, so it tells under the lock
  };

  void begin(const core::FramePtr& frame);
  void setExposure(float ev);
  void keep(const RestingPicture& picture);
  void release();
  void work(const std::stop_token& end);
  std::optional<Task> nextTask(const std::stop_token& end);
  std::optional<Task> findTask() const;
  void run(const Task& task);
  void traceReference(const Task& task);
  void measure(const Task& task);

  const Trace trace_;
  std::stop_source cancel_;  ///< of this rest; the owner's

  // Written by the owner under the lock, which the thread takes to read them; the owner reads without.
  core::FramePtr frame_;  ///< null = no rest is observed
  float exposureEv_ = 0;
  bool released_ = false;  ///< the rest is long enough
  bool complete_ = false;  ///< the converged picture is kept
  Series pictures_{kMaxPictures};

  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  double referenceDone_ = 0;
  std::shared_ptr<const core::ImageRgb> reference_;
  std::string failure_;
  std::jthread thread_;  ///< last: joined before anything it uses goes
};

/// Traces with a copy of `tracer`, whose world must outlive the result; on the calling thread.
LiveError::Trace tracedBy(const raytrace::CorrectiveTracer& tracer);

}  // namespace saccade::app
