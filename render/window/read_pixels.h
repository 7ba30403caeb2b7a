// The framebuffer bound now, as an image. GL thread only.
#pragma once

#include "core/image.h"
#include "render/context/gl.h"

namespace saccade::render {

/// Row 0 = top, for drawings whose clip space points up; alpha is set to 255.
core::ImageRgba8 readRgba8(const Gl& gl, int width, int height);

}  // namespace saccade::render
