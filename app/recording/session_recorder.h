// `walk --record`: hands what a frame loop shows to a thread that writes it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <variant>

#include "app/recording/session_writer.h"
#include "app/session/session_sink.h"

namespace saccade::app {

/// The walk goes on whatever happens to the file: a failure is logged once, as an error, and the rest of the
/// session is not recorded. Pictures are hashed and everything is encoded in the writing thread; the frame
/// loop moves or shares what it has, and waits only while kQueueBytes are waiting to be written.
///
/// Main thread only.
class SessionRecorder : public SessionSink {
 public:
  static constexpr std::size_t kQueueBytes = std::size_t{64} << 20;
  /// A disk that writes nothing for so long ends the recording, not the walk.
  static constexpr std::chrono::seconds kPatience{2};

  struct Outcome {
    bool complete = false;
    std::int64_t frames = 0;      ///< recorded; where incomplete, the last second's may be missing
    std::uint64_t samples = 0;    ///< recorded
    double writerCpuSeconds = 0;  ///< of the writing thread
    /// The longest that anything handed over was not yet committed: no kill could have cost more of the walk.
    double longestAtRiskSeconds = 0;
  };

  /// Throws core::Error when `file` exists and is not a recording. Another failure is logged, and nothing
  /// recorded.
  SessionRecorder(const std::filesystem::path& file, const SessionInfo& info);
  /// Finishes, if finish() was not called.
  ~SessionRecorder() override;

  /// The session's time of the frames to come, seconds, not falling.
  void setSeconds(double seconds) { seconds_ = seconds; }

  void batch(core::SampleBatch&& batch) override;
  void frame(const ShownFrame& frame) override;

  /// Waits until everything is written, and closes the file.
  Outcome finish();

 private:
  using Clock = std::chrono::steady_clock;

  struct PendingFrame {
    RecordedFrame frame;
    std::shared_ptr<const core::ImageRgba8> display;
  };
  using Item = std::variant<core::SampleBatch, PendingFrame>;
  /// What came in since the writer looked last.
  struct Arrivals {
    std::deque<Item> items;
    Clock::time_point first;  ///< when the first of them came
  };

  static std::size_t bytesOf(const Item& item);
  void push(Item item);
  void work(const SessionInfo& info);
  void writeAll(SessionWriter& writer);
  Arrivals waitForItems();
  void write(SessionWriter& writer, Item& item);
  void fail(const std::string& why, std::int64_t frames);

  const std::filesystem::path file_;
  double seconds_ = 0;
  std::mutex mutex_;  ///< of what follows
  std::condition_variable arrived_, written_;
  Arrivals waiting_;
  std::size_t waitingBytes_ = 0;  ///< of waiting_ and of what is being written
  bool ending_ = false;
  bool failed_ = false;
  Outcome outcome_;
  std::thread thread_;
};

}  // namespace saccade::app
