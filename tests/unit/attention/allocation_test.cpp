// The saliency model keeps its memory: counted by replacing the program's operator new.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "attention/saliency.h"
#include "tests/unit/attention/pictures.h"

namespace {

std::atomic<long> allocations{0};

}  // namespace

void* operator new(std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  if (void* p = std::malloc(size ? size : 1)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace saccade::attention {
namespace {

TEST(SaliencyMemory, NoAllocationAfterTheFirstImageOfASize) {
  for (const auto& [width, height] : {std::pair{512, 512}, {333, 257}, {40, 30}}) {
    const core::ImageRgba8 first = tests::randomDiscs(width, height, 8, 1),
                           second = tests::randomDiscs(width, height, 8, 2);
    SaliencyModel model;
    const long before = allocations;
    model.compute(first);
    const long afterFirst = allocations;
    EXPECT_GT(afterFirst, before) << "the counter counts";
    model.compute(second);
    EXPECT_EQ(allocations, afterFirst) << width << " x " << height;
  }
}

}  // namespace
}  // namespace saccade::attention
