#include "render/window/read_pixels.h"

#include <algorithm>

namespace saccade::render {

core::ImageRgba8 readRgba8(const Gl& gl, int width, int height) {
  core::ImageRgba8 image(width, height);
  if (image.empty()) return image;
  gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
  gl.ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, image.pixels().data());
  for (core::Rgba8& p : image.pixels()) p.a = 255;
  for (int y = 0; y < height / 2; ++y) {
    core::Rgba8* row = &image.at(0, y);
    std::swap_ranges(row, row + width, &image.at(0, height - 1 - y));
  }
  return image;
}

}  // namespace saccade::render
