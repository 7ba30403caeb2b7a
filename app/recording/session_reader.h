// Reads a recorded session back, frame by frame.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/recording/session_info.h"
#include "app/recording/session_settings.h"
#include "core/corrective/messages.h"

namespace saccade::app {

/// One thread at a time. A recording that was cut off or damaged ends with the last frame before the damage;
/// damage() then says what is the matter.
class SessionReader {
 public:
  /// Throws core::Error naming the file and what to do: no recording, another version, being recorded.
  explicit SessionReader(const std::filesystem::path& file);
  ~SessionReader();

  const std::filesystem::path& file() const;
  const SessionInfo& info() const;

  /// The frame that nextFrame() will give; null at the end. Valid until nextFrame().
  const RecordedFrame* peek() const;
  /// Nothing at the end. Numbers are checked: sizes within [1, render::kMaxImageSide], finite cameras, times
  /// that do not fall (those that do are raised: backwardTimes()).
  std::optional<RecordedFrame> nextFrame();
  /// Of the frame that nextFrame() gave last, in the order in which they arrived; nothing after the last, or
  /// at damage.
  std::optional<core::SampleBatch> nextBatch();

  std::int64_t framesRead() const;     ///< given by nextFrame()
  std::int64_t backwardTimes() const;  ///< frames whose time was earlier than the last one's
  bool frameIsWhole() const;           ///< no damage among the batches given since nextFrame()
  const std::string& damage() const;   ///< empty while nothing is wrong

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace saccade::app
