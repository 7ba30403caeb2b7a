// The three channels between the threads (Haber 2001, section 4.2). All bounded, all closable; a lock covers
// one queue operation, never work. All functions may be called from any thread unless a line says otherwise.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "core/corrective/messages.h"

namespace saccade::core {

/// Latest wins: the analyzer takes the newest frame, whatever it missed.
class SnapshotMailbox {
 public:
  void put(AnalysisInput input);
  /// Waits for a frame newer than the last one taken; nothing once closed. One consumer.
  std::optional<AnalysisInput> take();
  /// True while the consumer waits: "if the analyzer thread requests a new frame" (step 8).
  bool wanted() const;
  void close();

 private:
  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  std::optional<AnalysisInput> newest_;
  bool waiting_ = false;
  bool closed_ = false;
};

/// The priority queue of sample regions (PQ in the paper), one region per visible non-diffuse object.
///
/// Departure from the paper, section 4.4: a job's successor is entered when the job is handed out, not when
/// it is done. The order of jobs is then a function of frame and priorities alone, whatever the number of
/// tracers; that samples of a level can arrive after those of the next is met by the correction layer, which
/// knows levels.
class RegionQueue {
 public:
  /// `inhibition` in [0, 1): the share of its priority that a region loses with each lattice level, those
  /// before its start level included (they are done: the paper's regions all begin at level 1). 0.1 is
  /// section 3's 10 % rule; 0 is winner-takes-all: the best region until it has converged, then the next.
  ///
  /// Departure from the paper, which found 10 to 20 % right: kInhibition is more. A sample of one level
  /// stands for five times the pixels of one of the next, whatever the object, so that what a sample mends
  /// falls with the level much faster than importance differs between objects (bench/walkorder measures it).
  explicit RegionQueue(int jobSize, float inhibition = kInhibition)
      : jobSize_(jobSize < 1 ? 1 : jobSize), kept_(1 - inhibition) {}

  /// A new frame: every region starts again at its object's start level, with its last known priority (1 for
  /// an object that the analyzer has not seen yet). Sequence numbers start at 0 with every new epoch.
  /// `gains`: what a sample is worth by id, (0, 1] (core/corrective/sample_gains.h), 1 for ids beyond its
  /// end: a factor of what inhibition reduces, too. `known`, null or one entry for each of the frame's
  /// pixels: a level's jobs pass over the pixels that are known as well already, and those that are known as
  /// well as a fresh sample of the last level come when all levels are done, as one level more.
  void beginFrame(FramePtr frame, std::vector<float> gains = {}, KnownLevels known = nullptr);
  /// Priorities in (0, kHighestPriority] by id, from the analyzer; ids beyond the span keep theirs, and [0]
  /// is ignored. Higher values count as kHighestPriority, NaN and negative ones as kLowestPriority, 0 (not in
  /// the picture) as kUnseenPriority. Regions keep their progress; the reductions by level that they have
  /// suffered are applied again. What exceeds 1 (a click) is not reduced: a person looks there.
  void setPriorities(std::span<const float> byId);
  /// The best job; ties go to the smaller id. Its region goes on with the same level at the same priority,
  /// or, when the level is finished, with the next level and what inhibition leaves of the priority
  /// (sections 3 and 4.4). Nothing when no region is left or the queue is closed.
  std::optional<Job> tryPop();
  /// Like tryPop, but waits for work; nothing only when closed.
  std::optional<Job> pop();
  /// Jobs that are left are not handed out; waiting tracers return.
  void close();
  /// No job left to hand out for the present frame.
  bool exhausted() const;

  /// By id, up to the last object of the present frame: how many regions come up to and including the
  /// object's own, as priorities stand now: 1 = its job is handed out next; 0 = not in the frame, or all of
  /// it handed out.
  std::vector<std::uint32_t> ranks() const;

  static constexpr float kInhibition = 0.5f;
  static constexpr float kLowestPriority = 1e-6f;
  static constexpr float kHighestPriority = 2;  ///< an order's 1, plus what a click adds
  static constexpr float kUnseenPriority = 1;   ///< of an object that no analysis has seen yet

 private:
  struct Region {
    std::uint32_t id = 0;
    float priority = 0;  ///< times gain, reduced by level
    LatticeCursor cursor;
    bool refresh = false;     ///< all levels are done: see Job::refresh
    std::int64_t points = 1;  ///< lattice points in the box per job, about jobSize pixels on the mask
  };
  /// Heap order: whether b goes before a.
  static bool later(const Region& a, const Region& b);
  float reducedPriority(const Region& region) const;
  std::optional<Job> popLocked();
  bool beginNextLevel(Region& region) const;

  const int jobSize_;  ///< pixels, at least 1
  const float kept_;   ///< of a priority when a level is done
  mutable std::mutex mutex_;
  std::condition_variable filled_;
  FramePtr frame_;
  std::vector<float> basePriority_;  ///< by id
  std::vector<float> gains_;         ///< by id, of the present frame
  KnownLevels known_;                ///< of the present frame
  std::vector<Region> heap_;
  std::uint64_t nextSequence_ = 0;
  bool closed_ = false;
};

/// FIFO of sample batches (SQ in the paper), bounded: a full queue holds its tracer back.
class SampleQueue {
 public:
  explicit SampleQueue(std::size_t maxBatches = 4096) : maxBatches_(maxBatches < 1 ? 1 : maxBatches) {}

  /// Waits while full. False once closed (the batch is dropped).
  bool push(SampleBatch batch);
  /// What was pushed before close can still be taken.
  std::optional<SampleBatch> tryPop();
  /// Waits until a batch is there or the deadline passes or the queue is closed.
  std::optional<SampleBatch> popUntil(std::chrono::steady_clock::time_point deadline);
  void close();

 private:
  std::optional<SampleBatch> takeFront(std::unique_lock<std::mutex> lock);

  const std::size_t maxBatches_;
  std::mutex mutex_;
  std::condition_variable notEmpty_, notFull_;
  std::deque<SampleBatch> batches_;
  bool closed_ = false;
};

}  // namespace saccade::core
