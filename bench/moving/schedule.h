// Which camera each frame of a timed walk sees.
//
// The camera moves in virtual real time: the path runs at its true speed, and a frame with budget b stands b
// after the one before, so that a small budget means small steps. Pictures are compared at key views, which
// stand at the same path times for every budget, exactly: the segment between two of them is divided into
// round(segment / b) equal steps (at least one), each nearly b. A frame that misses its deadline does not
// delay the next camera: lateness is reported, not mixed into the error.
#pragma once

namespace saccade::bench {

/// The part of a path that is walked, in seconds of the path.
struct Stretch {
  double begin = 0;
  double segment = 0.5;  ///< > 0, between key views
  int segments = 3;      ///< at least 1

  /// Segments of `segment` seconds, as many as fit into `seconds`, in the middle of a path of `length`
  /// seconds; one shorter segment where none fits. Throws core::Error for a path without length.
  static Stretch within(double length, double segment, int segments);
};

/// Immutable; any thread.
class Schedule {
 public:
  /// `budgetSeconds` > 0.
  Schedule(const Stretch& stretch, double budgetSeconds);

  /// Frame 0 stands at the beginning, cold; the last one at the last key view.
  int frames() const { return stretch_.segments * steps_ + 1; }
  /// 0 <= frame < frames().
  double seconds(int frame) const;
  /// The key view that a frame stands at, in [0, segments), or -1. Frame 0 is none: it has no past.
  int keyView(int frame) const { return frame > 0 && frame % steps_ == 0 ? frame / steps_ - 1 : -1; }
  /// The frame of a key view.
  int frameOf(int keyView) const { return (keyView + 1) * steps_; }
  int keyViews() const { return stretch_.segments; }
  double budgetSeconds() const { return budget_; }

 private:
  Stretch stretch_;
  double budget_;
  int steps_;  ///< a segment
};

}  // namespace saccade::bench
