// The analyzer thread (Haber et al. 2001, Figure 2, middle): takes the newest frame, finds what attracts the
// eye, gives the region queue its priorities; and the same inline, for --threads 0 and still images.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "attention/attended.h"
#include "attention/importance.h"
#include "attention/saliency.h"
#include "core/corrective/messages.h"
#include "core/corrective/queues.h"

namespace saccade::attention {

/// What the last analysis saw. Immutable.
struct AttentionSnapshot {
  std::uint64_t epoch = 0;   ///< of the frame
  core::ImageGray saliency;  ///< per pixel, [0, 1]; empty when the order does not ask for saliency
  Importance importance;     ///< by id
  double milliseconds = 0;   ///< that this analysis took
};

struct AnalyzerTimes {
  std::uint64_t analyses = 0;
  double totalMilliseconds = 0;
};

/// Construct, start and stop on one thread.
class Analyzer {
 public:
  /// `seconds`: the clock by which attention decays; called from any thread.
  explicit Analyzer(const AttentionOptions& options, std::function<double()> seconds = steadySeconds);
  ~Analyzer() { stop(); }
  Analyzer(const Analyzer&) = delete;
  Analyzer& operator=(const Analyzer&) = delete;

  /// Starts the thread. Both channels must live until stop() returns. Not while started.
  void start(core::SnapshotMailbox& mailbox, core::RegionQueue& queue);
  /// Closes the mailbox and joins: waits for the analysis in hand at most (milliseconds; 1 s at 8192 x 8192).
  /// Does nothing when not started.
  void stop();
  /// Analyses on the calling thread and returns the priorities by id, for RegionQueue::setPriorities. Not
  /// while started. Throws core::Error where picture, mask and extents do not fit together.
  std::vector<float> analyzeNow(const core::AnalysisInput& input);

  /// The slider, 0 saliency .. 1 task (clamped); counts from the next analysis. Any thread.
  void setAttention(float weight);
  float attention() const { return attention_.load(std::memory_order_relaxed); }

  /// A person points at an object: its importance rises and decays (attention/attended.h), whatever the
  /// order; counts from the next analysis. 0, an object out of sight or of no frame: harmless. Any thread.
  void attend(std::uint32_t id);

  /// The last analysis, or nothing before the first. Any thread.
  std::shared_ptr<const AttentionSnapshot> latest() const;
  /// Any thread.
  AnalyzerTimes times() const;
  /// Rethrows what ended the thread, if anything did. The owner calls it once a frame. Any thread.
  void check() const;

 private:
  static double steadySeconds();
  std::vector<float> attendedNow(std::size_t entries);
  std::shared_ptr<const AttentionSnapshot> analyze(const core::AnalysisInput& input);
  void run(core::SnapshotMailbox& mailbox, core::RegionQueue& queue);

  const AttentionOptions options_;
  const std::function<double()> seconds_;
  std::atomic<float> attention_;
  SaliencyModel model_;  ///< the analyzing thread's

  mutable std::mutex mutex_;
  AttendedObjects attended_;
  std::shared_ptr<const AttentionSnapshot> latest_;
  AnalyzerTimes times_;
  std::exception_ptr failure_;

  core::SnapshotMailbox* mailbox_ = nullptr;
  std::jthread thread_;  ///< last: joined before anything it uses goes
};

}  // namespace saccade::attention
