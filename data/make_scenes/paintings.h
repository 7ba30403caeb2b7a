// The gallery's pictures: fourteen manners, each with endless variations by seed.
#pragma once

#include <cstdint>

#include "core/image.h"

namespace saccade::data {

inline constexpr int kPaintingManners = 14;

/// One picture in sRGB. `manner` in [0, kPaintingManners); the same arguments give the same picture.
core::ImageRgba8 painting(int manner, std::uint32_t seed, int width, int height);

}  // namespace saccade::data
