// The frame as seen: base + correction, one fp32 addition a channel (design fact 6), and its display
// transform. Departure from Haber 2001, section 4.1, steps 4 and 7: base and corrections meet in main memory,
// not in a blend of two textures. ID mask and depth must be read back for splatting and for the tracers
// anyway, and without a GPU a core adds and encodes a frame several times faster than a full-screen GL pass
// does.
#pragma once

#include <span>

#include "core/corrective/lattice.h"
#include "core/image.h"
#include "core/math/types.h"

namespace saccade::core {

/// linear[i] = baseAndId[i].rgb + correction[i]; both width * height, row 0 = top. An empty `correction`
/// means zero.
ImageRgb compositeLinear(int width, int height, std::span<const Vec4> baseAndId,
                         std::span<const Vec4> correction);

/// The same sum through the display transform of core/image_io.h, straight to 8 bits. `out` is resized to
/// fit.
void compositeDisplay(int width, int height, std::span<const Vec4> baseAndId,
                      std::span<const Vec4> correction, float exposureEv, ImageRgba8& out);

/// Some pixels of `out` anew: corrections[i] at pixels[i] instead of what was added there.
void compositeDisplayAt(std::span<const Pixel> pixels, std::span<const Vec4> baseAndId,
                        std::span<const Vec3> corrections, float exposureEv, ImageRgba8& out);

}  // namespace saccade::core
