// The formats behind core/image_io.h, one source file each. Used by image_io.cpp alone; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/load_budget.h"

namespace saccade::core::codecs {

/// Throws core::Error, naming `name`, for a side of 0 or more than kMaxImagePixels.
void checkDimensions(std::int64_t width, std::int64_t height, const std::string& name);

/// Rows between two looks at the clock.
inline constexpr int kRowsPerLook = 64;

bool isPng(std::span<const std::uint8_t> bytes);
void checkPngHeader(std::span<const std::uint8_t> bytes, const std::string& name);
ImageRgba8 decodePng(std::span<const std::uint8_t> bytes, const std::string& name, LoadBudget& budget);

bool isJpeg(std::span<const std::uint8_t> bytes);
void checkJpegHeader(std::span<const std::uint8_t> bytes, const std::string& name);
ImageRgba8 decodeJpeg(std::span<const std::uint8_t> bytes, const std::string& name, LoadBudget& budget);

}  // namespace saccade::core::codecs
