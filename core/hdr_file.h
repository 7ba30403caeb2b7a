// Radiance pictures (.hdr, .pic): Greg Ward, "Real Pixels", Graphics Gems II, 1991; the file format as in
// Radiance's "Picture files" (filefmts.pdf).
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/image.h"
#include "core/load_budget.h"

namespace saccade::core {

/// Decodes 32-bit RGBE, flat or run-length encoded in the old or the new way, stored in any of the eight
/// orders of its axes; row 0 of the result is the top. EXPOSURE lines are divided out: the result is what was
/// photographed, W/m^2/sr. Throws core::Error naming `name`: wrong magic, XYZE, a size of 0, one beyond
/// kMaxImagePixels or one that the bytes cannot hold (checked before anything is allocated), truncated or
/// overrunning scanlines. The pixels' bytes stay charged to `budget`. Bytes behind the picture are ignored.
/// Any thread.
ImageRgb decodeHdr(std::span<const std::uint8_t> bytes, const std::string& name, LoadBudget& budget);

}  // namespace saccade::core
