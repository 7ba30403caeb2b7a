// A JPEG in memory.
#include "tests/fuzz/decode.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  saccade::fuzz::decodeOrRefuse({data, size});
  return 0;
}
