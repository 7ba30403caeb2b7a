// A .gltf file: JSON with data URIs.
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  saccade::fuzz::loadScene(saccade::fuzz::scratch().write("scene.gltf", {data, size}));
  return 0;
}
