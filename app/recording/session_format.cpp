#include "app/recording/session_format.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>

#include "core/content_hash.h"

namespace saccade::app {

const char* const kSessionTables = R"(
CREATE TABLE session(name TEXT PRIMARY KEY, value) WITHOUT ROWID;
CREATE TABLE settings(frame INTEGER NOT NULL, name TEXT NOT NULL, value, PRIMARY KEY(frame, name)) WITHOUT ROWID;
CREATE TABLE frames(
  frame INTEGER PRIMARY KEY,
  seconds REAL NOT NULL,
  new_view INTEGER NOT NULL,
  eye_x REAL NOT NULL, eye_y REAL NOT NULL, eye_z REAL NOT NULL,
  at_x REAL NOT NULL, at_y REAL NOT NULL, at_z REAL NOT NULL,
  up_x REAL NOT NULL, up_y REAL NOT NULL, up_z REAL NOT NULL,
  fov REAL NOT NULL,
  width INTEGER NOT NULL, height INTEGER NOT NULL,
  epoch INTEGER NOT NULL,
  hash INTEGER NOT NULL,
  tiles BLOB NOT NULL);
CREATE TABLE batches(
  batch INTEGER PRIMARY KEY,
  frame INTEGER NOT NULL,
  epoch INTEGER NOT NULL,
  samples INTEGER NOT NULL,
  data BLOB NOT NULL);
)";

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie in memory");

/// Calls visit(number) for each number of a sample, in the file's order; x, y, level and flags go through the
/// narrower types of the file.
template <class SampleT, class Visit>
void forEachNumber(SampleT& s, Visit&& visit) {
  visit(s.correction.x), visit(s.correction.y), visit(s.correction.z);
  visit(s.position.x), visit(s.position.y), visit(s.position.z);
  visit(s.normal.x), visit(s.normal.y), visit(s.normal.z);
  visit(s.cosView), visit(s.viewDepth);
  visit(s.toEye.x), visit(s.toEye.y), visit(s.toEye.z);
  visit(s.changeRate);
}

template <class T>
std::uint8_t* put(std::uint8_t* to, T value) {
  std::memcpy(to, &value, sizeof value);
  return to + sizeof value;
}

template <class T>
const std::uint8_t* get(const std::uint8_t* from, T& value) {
  std::memcpy(&value, from, sizeof value);
  return from + sizeof value;
}

void encode(const core::Sample& s, std::uint8_t* to) {
  to = put(to, static_cast<std::uint16_t>(s.x));
  to = put(to, static_cast<std::uint16_t>(s.y));
  to = put(to, s.id);
  to = put(to, s.level);
  to = put(to, s.thread);
  to = put(to, static_cast<std::uint16_t>(s.fromDepth ? 1 : 0));
  forEachNumber(s, [&](float value) { to = put(to, value); });
}

core::Sample decode(const std::uint8_t* from, const std::uint8_t* end) {
  core::Sample s;
  std::uint16_t x = 0, y = 0, flags = 0;
  from = get(from, x);
  from = get(from, y);
  from = get(from, s.id);
  from = get(from, s.level);
  from = get(from, s.thread);
  from = get(from, flags);
  s.x = x, s.y = y;
  s.fromDepth = (flags & 1) != 0;
  forEachNumber(s, [&](float& value) {
    if (end - from >= static_cast<std::ptrdiff_t>(sizeof value)) from = get(from, value);
  });
  return s;
}

int tilesAlong(int side) { return std::min(side, kTiles); }

}  // namespace

std::vector<std::uint8_t> encodeSamples(std::span<const core::Sample> samples) {
  std::vector<std::uint8_t> out(samples.size() * kSampleBytes);
  for (std::size_t i = 0; i < samples.size(); ++i) encode(samples[i], out.data() + i * kSampleBytes);
  return out;
}

std::vector<core::Sample> decodeSamples(std::span<const std::uint8_t> data, std::size_t sampleBytes) {
  assert(sampleBytes >= kSmallestSampleBytes && data.size() % sampleBytes == 0);
  std::vector<core::Sample> out;
  out.reserve(data.size() / sampleBytes);
  for (std::size_t at = 0; at < data.size(); at += sampleBytes)
    out.push_back(decode(data.data() + at, data.data() + at + sampleBytes));
  return out;
}

std::vector<std::uint8_t> tileMeans(const core::ImageRgba8& image) {
  const int columns = tilesAlong(image.width()), rows = tilesAlong(image.height());
  std::vector<std::uint8_t> means;
  means.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) * 3);
  const auto border = [](int tile, int tiles, int side) {
    return static_cast<int>(static_cast<std::int64_t>(tile) * side / tiles);
  };
  for (int row = 0; row < rows; ++row) {
    const int y0 = border(row, rows, image.height()), y1 = border(row + 1, rows, image.height());
    for (int column = 0; column < columns; ++column) {
      const int x0 = border(column, columns, image.width()), x1 = border(column + 1, columns, image.width());
      std::uint64_t r = 0, g = 0, b = 0;
      for (int y = y0; y < y1; ++y) {
        const core::Rgba8* pixel = &image.at(x0, y);
        for (int x = x0; x < x1; ++x, ++pixel) r += pixel->r, g += pixel->g, b += pixel->b;
      }
      const auto pixels = static_cast<std::uint64_t>(x1 - x0) * static_cast<std::uint64_t>(y1 - y0);
      for (const std::uint64_t sum : {r, g, b})
        means.push_back(static_cast<std::uint8_t>((sum + pixels / 2) / pixels));
    }
  }
  return means;
}

std::uint64_t frameHash(const core::ImageRgba8& image) {
  static_assert(sizeof(core::Rgba8) == 4);
  core::ContentHash hash;
  hash.add(image.width());
  hash.add(image.height());
  hash.addArray(image.pixels());
  return hash.value();
}

}  // namespace saccade::app
