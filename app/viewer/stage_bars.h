// Where the frames' time went: a stacked bar a frame, one part a stage, against the budget.
#pragma once

#include <deque>
#include <map>
#include <string>
#include <vector>

#include "core/image.h"

namespace saccade::app {

/// The last frames by stage. One thread.
class StageTimes {
 public:
  static constexpr std::size_t kShown = 120;
  /// What no stage accounts for: input, and whatever a stage does not time.
  static constexpr const char* kRest = "other";
  /// Putting the picture and the panel on the screen.
  static constexpr const char* kPresent = "show";

  struct Frame {
    double totalMs = 0;
    std::vector<float> partMs;  ///< as stages(), missing ones 0; their sum is totalMs
  };

  /// `summedMs`: RunStats::stageMs, which grows from frame to frame; smaller sums are another scene's. Null
  /// without a scene. Parts that overlap are cut so that the sum holds.
  void add(const std::map<std::string, double>* summedMs, double presentMs, double totalMs);

  const std::deque<Frame>& frames() const { return frames_; }  ///< newest last
  /// In the order of a frame, from below; grows where a run has other stages.
  const std::vector<std::string>& stages() const { return stages_; }
  double meanMs() const;                        ///< of the frames shown; 0 without any
  double meanMs(std::size_t stage) const;       ///< the stage's share of it
  static core::Rgba8 color(std::size_t stage);  ///< of the bars and of the legend

 private:
  std::size_t indexOf(const std::string& stage);

  std::vector<std::string> stages_{"age", "draw", "warp", "correct", "composite", kPresent, kRest};
  std::map<std::string, double> last_;
  std::deque<Frame> frames_;
};

/// Between ImGui's Begin and End: frame rate, bars with the budget's line, the legend with means. As wide as
/// there is room.
void drawStageBars(const StageTimes& times, float budgetMs);

}  // namespace saccade::app
