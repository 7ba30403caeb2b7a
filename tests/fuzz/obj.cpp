// An OBJ file and the material library "m.mtl" it may name: what follows the first line "#mtl".
#include <algorithm>
#include <string_view>

#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::string_view kMark = "#mtl\n";
  const std::uint8_t* end = data + size;
  const std::uint8_t* mark = std::search(data, end, kMark.begin(), kMark.end());
  const std::uint8_t* library = mark == end ? end : mark + kMark.size();
  saccade::fuzz::scratch().write("m.mtl", {library, end});
  saccade::fuzz::loadScene(saccade::fuzz::scratch().write("scene.obj", {data, mark}));
  return 0;
}
