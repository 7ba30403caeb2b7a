// Writes a recorded session into its SQLite file.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "app/recording/session_info.h"
#include "app/recording/session_settings.h"
#include "core/corrective/messages.h"

namespace saccade::app {

/// Throws core::Error when `file` exists and is not a recording: that is not overwritten.
void refuseForeignFile(const std::filesystem::path& file);

/// One thread at a time. The file is locked while it is written: another writer or reader is turned away.
/// Every function throws core::Error naming the file; afterwards it is not to be called again. What was
/// committed until then stays.
class SessionWriter {
 public:
  /// A transaction collects frames for so long: half of the second that a kill may cost, since on a busy
  /// machine the writer wakes late (measured: up to 1.2 s at risk with 0.8 s here, under four times the load
  /// there are cores for).
  static constexpr std::chrono::milliseconds kCommitEvery{500};

  /// Replaces an earlier recording of this name.
  SessionWriter(const std::filesystem::path& file, const SessionInfo& info,
                std::chrono::milliseconds commitEvery = kCommitEvery);
  /// Closes; what is not committed is lost.
  ~SessionWriter();

  void write(const core::SampleBatch& batch);
  /// The batches since the last frame belong to it.
  void write(const RecordedFrame& frame);
  /// Commits if a transaction is old enough, and says whether it did; call at least as often as that.
  bool commitIfDue();
  /// Commits the rest and makes one plain file of it.
  void finish();

  std::int64_t frames() const;
  std::uint64_t samples() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace saccade::app
