// Image files. PNG by libpng, JPEG by libjpeg-turbo, EXR by OpenEXR. Dimensions are checked before decoding.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/image.h"
#include "core/load_budget.h"

namespace saccade::core {

/// Largest image that is decoded, in pixels.
inline constexpr std::int64_t kMaxImagePixels = 16384LL * 16384LL;

/// "image/png", "image/jpeg", or "" for what decodeImage does not read; by content.
std::string imageType(std::span<const std::uint8_t> bytes);
/// Everything that decodeImage checks before it allocates pixels.
void checkImageHeader(std::span<const std::uint8_t> bytes, const std::string& name);

/// PNG (8 or 16 bit, any colour type, interlaced) or JPEG (grey, RGB, CMYK) from memory; the format is
/// recognised by content; gamma and profile chunks are ignored. `name` is for messages. The pixels' bytes
/// stay charged to `budget`. Throws core::Error, also for a truncated file and, before anything is allocated,
/// for one whose bytes cannot hold its dimensions. Any thread.
ImageRgba8 decodeImage(std::span<const std::uint8_t> bytes, const std::string& name, LoadBudget& budget);
/// Under the default limits.
ImageRgba8 decodeImage(std::span<const std::uint8_t> bytes, const std::string& name);
ImageRgba8 readImage8(const std::filesystem::path& file);

/// 8-bit sRGB PNG. All writers write a temporary name and rename, and throw core::Error.
void writePng(const std::filesystem::path& file, const ImageRgba8& image);
std::vector<std::uint8_t> encodeJpeg(const ImageRgba8& image, int quality);
std::vector<std::uint8_t> encodePng(const ImageRgba8& image);

/// Linear RGB (R, G, B channels, of the first layer that has them if the
/// image itself has none; one channel reads as grey). Flat scanline NONE/RLE/ZIP only.
ImageRgb readExr(const std::filesystem::path& file);
/// The pixels' bytes stay charged to `budget`.
ImageRgb readExr(const std::filesystem::path& file, LoadBudget& budget);
void writeExr(const std::filesystem::path& file, const ImageRgb& image);
/// Named float channels of equal size, for AOVs.
void writeExrChannels(const std::filesystem::path& file,
                      const std::vector<std::pair<std::string, const ImageGray*>>& channels);

/// The display transform: x 2^exposureEv, clamp to [0, 1] (NaN and negative give 0, +inf 1), sRGB.
float encodeSrgb(float linear);
float decodeSrgb(float encoded);
/// 8-bit codes are round(255 * encodeSrgb(x)), exactly (core/srgb8.h).
ImageRgba8 toDisplay(const ImageRgb& linear, float exposureEv);

}  // namespace saccade::core
