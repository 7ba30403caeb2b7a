// The saliency model keeps its memory.
#include <gtest/gtest.h>

#include <utility>

#include "attention/saliency.h"
#include "tests/unit/attention/allocation_count.h"
#include "tests/unit/attention/pictures.h"

namespace saccade::attention {
namespace {

TEST(SaliencyMemory, NoAllocationAfterTheFirstImageOfASize) {
  for (const SaliencyOptions& options : {SaliencyOptions{},
                                         {Normalisation::dog, false},
                                         {Normalisation::max, true},
                                         {Normalisation::dog, true}}) {
    for (const auto& [width, height] : {std::pair{512, 512}, {333, 257}, {40, 30}}) {
      const core::ImageRgba8 first = tests::randomDiscs(width, height, 8, 1),
                             second = tests::randomDiscs(width, height, 8, 2);
      SaliencyModel model(options);
      const long before = tests::allocationCount();
      model.compute(first);
      const long afterFirst = tests::allocationCount();
      EXPECT_GT(afterFirst, before) << "the counter counts";
      model.compute(second);
      EXPECT_EQ(tests::allocationCount(), afterFirst)
          << width << " x " << height << (options.normalise == Normalisation::dog ? ", dog" : ", max")
          << (options.orientation ? ", orientation" : "");
    }
  }
}

}  // namespace
}  // namespace saccade::attention
