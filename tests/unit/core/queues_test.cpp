// The analyzer's mailbox and the tracers' queue of samples: nothing lost, and threads that always come home.
#include "core/corrective/queues.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "tests/unit/core/mask_frame.h"

namespace saccade::core {
namespace {

using namespace std::chrono_literals;
using tests::frameOf;

TEST(SnapshotMailbox, LatestWinsAndIsTakenOnce) {
  SnapshotMailbox box;
  EXPECT_FALSE(box.wanted());
  const auto ids = std::vector<std::uint32_t>{1};
  for (std::uint64_t epoch : {1, 2, 3}) box.put({frameOf(1, 1, ids, 1, 10, epoch), nullptr});
  EXPECT_EQ(box.take()->frame->epoch, 3u);
  std::uint64_t next = 0;
  {
    std::jthread analyzer([&] { next = box.take()->frame->epoch; });
    while (!box.wanted()) std::this_thread::yield();
    box.put({frameOf(1, 1, ids, 1, 10, 4), nullptr});
  }
  EXPECT_EQ(next, 4u);
  EXPECT_FALSE(box.wanted());
}

TEST(SnapshotMailbox, CloseWakesTheAnalyzer) {
  SnapshotMailbox box;
  {
    std::jthread analyzer([&] { EXPECT_FALSE(box.take()); });
    while (!box.wanted()) std::this_thread::yield();
    box.close();
  }
  EXPECT_FALSE(box.wanted());
  box.put({frameOf(1, 1, {1}, 1), nullptr});
  EXPECT_FALSE(box.take());
}

SampleBatch batchOf(std::uint64_t sequence) {
  SampleBatch batch;
  batch.sequence = sequence;
  return batch;
}

TEST(SampleQueue, FirstInFirstOut) {
  SampleQueue queue;
  EXPECT_FALSE(queue.tryPop());
  for (std::uint64_t i = 0; i < 5; ++i) EXPECT_TRUE(queue.push(batchOf(i)));
  for (std::uint64_t i = 0; i < 4; ++i) EXPECT_EQ(queue.tryPop()->sequence, i);
  EXPECT_EQ(queue.popUntil(std::chrono::steady_clock::now() + 1h)->sequence, 4u);
  EXPECT_FALSE(queue.popUntil(std::chrono::steady_clock::now() + 1ms));
}

TEST(SampleQueue, AFullQueueHoldsTheTracerBackUntilThereIsRoom) {
  SampleQueue queue(2);
  std::atomic<int> pushed = 0;
  std::jthread tracer([&] {
    for (std::uint64_t i = 0; i < 5; ++i) {
      ASSERT_TRUE(queue.push(batchOf(i)));
      ++pushed;
    }
  });
  while (pushed < 2) std::this_thread::yield();
  std::this_thread::sleep_for(5ms);
  EXPECT_EQ(pushed, 2);
  for (std::uint64_t i = 0; i < 5; ++i) {
    EXPECT_EQ(queue.popUntil(std::chrono::steady_clock::now() + 1h)->sequence, i);
    EXPECT_LE(pushed, static_cast<int>(i) + 3);
  }
}

TEST(SampleQueue, CloseFreesBothSidesAndKeepsWhatWasPushed) {
  SampleQueue queue(1);
  EXPECT_TRUE(queue.push(batchOf(7)));
  {
    std::jthread tracer([&] { EXPECT_FALSE(queue.push(batchOf(8))); });
    queue.close();
  }
  EXPECT_EQ(queue.tryPop()->sequence, 7u);
  EXPECT_FALSE(queue.popUntil(std::chrono::steady_clock::now() + 1h));
}

TEST(SampleQueue, ManyTracersLoseNothing) {
  constexpr int kTracers = 6;
  constexpr std::uint64_t kEach = 500;
  SampleQueue queue(8);
  std::vector<int> seen(kTracers * kEach, 0);
  std::vector<std::jthread> tracers;
  for (std::uint64_t t = 0; t < kTracers; ++t) {
    tracers.emplace_back([&queue, t] {
      for (std::uint64_t i = 0; i < kEach; ++i) ASSERT_TRUE(queue.push(batchOf(t * kEach + i)));
    });
  }
  std::vector<std::uint64_t> last(kTracers, 0);
  for (std::uint64_t i = 0; i < kTracers * kEach; ++i) {
    const std::uint64_t sequence = queue.popUntil(std::chrono::steady_clock::now() + 1h)->sequence;
    ++seen[sequence];
    // One tracer's batches stay in order.
    EXPECT_GE(sequence, last[sequence / kEach]);
    last[sequence / kEach] = sequence;
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(seen.size()));
}

}  // namespace
}  // namespace saccade::core
