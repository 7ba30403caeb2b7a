// What is inside a recorded session: an SQLite file. docs/session-format.md is its description for users.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/corrective/messages.h"
#include "core/image.h"

namespace saccade::app {

/// PRAGMA application_id, "Sacc": tells recordings from other databases.
inline constexpr std::uint32_t kSessionApplicationId = 0x53616363;
/// PRAGMA user_version. Raised when a reader of the last version would get something wrong.
/// 2: the setting `approximation`. 3: warped samples rank by their effective level, so that pictures of older
/// files are replayed almost as they were.
inline constexpr int kSessionVersion = 3;

extern const char* const kSessionTables;  ///< CREATE TABLE statements

/// Bytes of a sample as this version writes it. A sample grows only at its end: what an older file lacks is
/// 0.
inline constexpr std::size_t kSampleBytes = 72;
inline constexpr std::size_t kSmallestSampleBytes = 56;  ///< of any version

/// Samples one after another, little-endian, kSampleBytes each.
std::vector<std::uint8_t> encodeSamples(std::span<const core::Sample> samples);
/// `data` holds whole samples of `sampleBytes` each, at least kSmallestSampleBytes. Any bits are taken as
/// they are.
std::vector<core::Sample> decodeSamples(std::span<const std::uint8_t> data, std::size_t sampleBytes);

/// Columns and rows of a picture's tiles, at most.
inline constexpr int kTiles = 32;
/// On another machine a tile's mean may differ by so much of 255 and the picture still counts as the same: a
/// pixel of another object along an edge weighs less than 1 in a tile of 256 pixels.
inline constexpr int kTileTolerance = 8;

/// Mean R, G and B of each tile, rounded, row by row: min(width, kTiles) columns, min(height, kTiles) rows.
std::vector<std::uint8_t> tileMeans(const core::ImageRgba8& image);
/// Size and all pixels of a picture.
std::uint64_t frameHash(const core::ImageRgba8& image);

}  // namespace saccade::app
