// An OpenEXR file.
#include "core/image_io.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = saccade::fuzz::scratch().write("image.exr", {data, size});
  saccade::fuzz::mayRefuse([&] { saccade::core::readExr(file); });
  return 0;
}
