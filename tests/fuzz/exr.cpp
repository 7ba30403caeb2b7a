// An OpenEXR file.
#include "core/error.h"
#include "core/image_io.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    saccade::core::readExr(saccade::fuzz::scratch().write("image.exr", {data, size}));
  } catch (const saccade::core::Error&) {
  }
  return 0;
}
