// A camera path; one that is taken must give finite cameras at every time.
#include "app/session/camera_path.h"

#include <cmath>
#include <cstdlib>

#include "tests/fuzz/fuzz_file.h"

namespace {

bool finite(const saccade::core::Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void walk(const saccade::app::CameraPath& path) {
  for (int i = 0; i <= 16; ++i) {
    const saccade::core::Camera c = path.at(path.lengthSeconds() * i / 16);
    if (!finite(c.eye) || !finite(c.at) || !finite(c.up) || !(c.fovYDegrees > 0 && c.fovYDegrees < 180))
      std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = saccade::fuzz::scratch().write("path.json", {data, size});
  saccade::fuzz::mayRefuse([&] { walk(saccade::app::CameraPath::read(file)); });
  return 0;
}
