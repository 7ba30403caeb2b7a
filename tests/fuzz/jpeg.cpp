// A JPEG in memory.
#include "core/image_io.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  saccade::fuzz::mayRefuse([&] { saccade::core::decodeImage({data, size}, "image"); });
  return 0;
}
