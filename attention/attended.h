// What a person points at (Haber et al. 2001, section 3: "the user's volitional focus of attention"). The
// paper guesses it from where objects stand in the picture; a click tells.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

namespace saccade::attention {

/// Not synchronised: one owner, or its lock. Seconds count on any one clock that does not run backwards.
class AttendedObjects {
 public:
  /// What a click adds to an object's importance at once. Orders give at most 1, so whatever the order the
  /// object is now ahead of all others.
  static constexpr float kHeight = 1;
  /// Half of it is left after this; a converged object takes tens of milliseconds, a look at it seconds.
  static constexpr double kHalfLifeSeconds = 3;
  /// After so many half-lives, nothing is.
  static constexpr int kHalfLives = 8;

  /// Again for the same object: from the beginning. Any id; 0 is none.
  void attend(std::uint32_t id, double seconds);
  /// What is added by id, [0, kHeight], as many entries as asked for; empty while nothing is attended to.
  /// Forgets what has decayed.
  std::vector<float> at(double seconds, std::size_t entries);

 private:
  std::map<std::uint32_t, double> since_;
};

}  // namespace saccade::attention
