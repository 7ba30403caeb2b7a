// A Radiance picture in memory.
#include "core/hdr_file.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  saccade::fuzz::mayRefuse([&] {
    saccade::core::LoadBudget budget({}, "image");
    saccade::core::decodeHdr({data, size}, "image", budget);
  });
  return 0;
}
