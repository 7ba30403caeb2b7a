#include "core/hdr_file.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "core/error.h"
#include "core/image_codecs.h"

namespace saccade::core {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

// New run-length encoding: only for scanlines of these lengths; each of the four components by itself.
constexpr int kShortestNew = 8, kLongestNew = 0x7fff;
constexpr int kNewRun = 128;  ///< a count above this is a run of count - 128
/// A black picture of 16384 pixels a scanline in the old encoding has 1365; the format would allow billions.
constexpr std::int64_t kMaxPixelsPerByte = 4096;
/// The fewest bytes that hold so many pixels: a run of the new kind covers 127 of one component.
constexpr std::int64_t kPixelsPerRun = 127, kBytesPerRun = 4 * 2;
/// Old encoding: repeat counts of consecutive markers are digits of this many bits. More than fit a scanline
/// are refused, so four digits do.
constexpr int kOldDigitBits = 8, kOldDigits = 4;

struct Header {
  double exposure = 1;
  /// The size line, e.g. -Y 512 +X 1024: the axis named first changes slowest.
  char slowAxis = 'Y', slowSign = '-', fastSign = '+';
  std::int64_t slow = 0, fast = 0;
};

class Reader {
 public:
  Reader(std::span<const std::uint8_t> bytes, const std::string& name) : rest_(bytes), name_(name) {}

  [[noreturn]] void refuse(const std::string& why) const { throw Error(name_ + ": this .hdr image " + why); }
  std::int64_t left() const { return static_cast<std::int64_t>(rest_.size()); }

  std::uint8_t byte() {
    if (rest_.empty()) refuse("is cut off");
    const std::uint8_t b = rest_.front();
    rest_ = rest_.subspan(1);
    return b;
  }
  Rgbe pixel() { return {byte(), byte(), byte(), byte()}; }
  bool startsNewScanline(std::int64_t length) const {
    return length >= kShortestNew && length <= kLongestNew && rest_.size() >= 4 && rest_[0] == 2 &&
           rest_[1] == 2 && rest_[2] < 128;
  }
  std::string_view line() {
    constexpr std::size_t kLongestLine = 4096;
    for (std::size_t n = 0; n < std::min(rest_.size(), kLongestLine); ++n) {
      if (rest_[n] != '\n') continue;
      std::string_view text(reinterpret_cast<const char*>(rest_.data()), n);
      rest_ = rest_.subspan(n + 1);
      if (text.ends_with('\r')) text.remove_suffix(1);
      return text;
    }
    refuse("has a header without an end");
  }

 private:
  std::span<const std::uint8_t> rest_;
  const std::string& name_;
};

/// "-Y 512 +X 1024"
void parseSize(Reader& in, Header& header) {
  std::string_view text = in.line();
  const auto bad = [&] { in.refuse("has no size line such as '-Y 512 +X 1024'"); };
  const auto axis = [&](char& name, char& sign, std::int64_t& count) {
    if (text.size() < 4 || (text[0] != '-' && text[0] != '+') || (text[1] != 'X' && text[1] != 'Y')) bad();
    sign = text[0];
    name = text[1];
    text.remove_prefix(std::min(text.find_first_not_of(' ', 2), text.size()));
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), count);
    if (parsed.ec != std::errc{}) bad();
    text.remove_prefix(static_cast<std::size_t>(parsed.ptr - text.data()));
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  };
  char fastAxis = 'X';
  axis(header.slowAxis, header.slowSign, header.slow);
  axis(fastAxis, header.fastSign, header.fast);
  if (fastAxis == header.slowAxis || !text.empty()) bad();
}

Header parseHeader(Reader& in, const std::string& name) {
  Header header;
  if (!in.line().starts_with("#?")) in.refuse("is none (it does not begin with #?RADIANCE)");
  for (std::string_view line = in.line(); !line.empty(); line = in.line()) {
    if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe")
      in.refuse("holds " + std::string(line.substr(7)) + "; only 32-bit_rle_rgbe is read");
    if (!line.starts_with("EXPOSURE=")) continue;
    line.remove_prefix(std::min(line.find_first_not_of(' ', 9), line.size()));
    double factor = 0;
    std::from_chars(line.data(), line.data() + line.size(), factor);
    if (!(factor > 0) || !std::isfinite(factor)) in.refuse("has an EXPOSURE that is no positive number");
    header.exposure *= factor;
  }
  parseSize(in, header);
  codecs::checkDimensions(header.fast, header.slow, name);
  // In the old encoding one marker may stand for a whole scanline.
  const std::int64_t runs = header.fast / kPixelsPerRun;
  const std::int64_t leastNew = 4 + std::max<std::int64_t>(runs, 1) * kBytesPerRun, leastOld = 4;
  const bool canBeNew = in.startsNewScanline(header.fast);
  if (in.left() / header.slow < (canBeNew ? leastNew : leastOld) ||
      header.fast * header.slow > kMaxPixelsPerByte * in.left())
    in.refuse("is cut off: its bytes cannot hold " + std::to_string(header.fast) + " x " +
              std::to_string(header.slow) + " pixels");
  return header;
}

void readNewScanline(Reader& in, std::vector<Rgbe>& line) {
  const Rgbe start = in.pixel();
  if (static_cast<std::size_t>(start[2] << 8 | start[3]) != line.size())
    in.refuse("has a scanline of another length than its size says");
  for (std::size_t component = 0; component < 4; ++component) {
    for (std::size_t x = 0; x < line.size();) {
      const int code = in.byte();
      const bool run = code > kNewRun;
      const auto count = static_cast<std::size_t>(run ? code - kNewRun : code);
      if (count == 0 || count > line.size() - x) in.refuse("has a run that leaves its scanline");
      std::uint8_t value = run ? in.byte() : std::uint8_t{0};
      for (const std::size_t end = x + count; x < end; ++x) {
        if (!run) value = in.byte();
        line[x][component] = value;
      }
    }
  }
}

/// Flat pixels, or the old encoding: (1, 1, 1, n) repeats the pixel before it.
void readOldScanline(Reader& in, std::vector<Rgbe>& line) {
  int digit = 0;
  for (std::size_t x = 0; x < line.size();) {
    const Rgbe p = in.pixel();
    if (p[0] != 1 || p[1] != 1 || p[2] != 1) {
      line[x++] = p;
      digit = 0;
      continue;
    }
    if (x == 0 || digit >= kOldDigits) in.refuse("repeats a pixel that is not there");
    const std::uint64_t count = std::uint64_t{p[3]} << (kOldDigitBits * digit++);
    if (count > line.size() - x) in.refuse("has a run that leaves its scanline");
    const Rgbe repeated = line[x - 1];
    for (const std::size_t end = x + count; x < end; ++x) line[x] = repeated;
  }
}

/// Departure from Radiance, which adds half a step to each mantissa: so that 1 is written and read as 1, as
/// the renderers do whose pictures ours are compared with.
Vec3 decode(const Rgbe& p, double scale) {
  if (p[3] == 0) return Vec3(0);
  constexpr int kBias = 128 + 8;
  const double unit = std::ldexp(scale, p[3] - kBias);
  return {static_cast<float>(p[0] * unit), static_cast<float>(p[1] * unit), static_cast<float>(p[2] * unit)};
}

}  // namespace

ImageRgb decodeHdr(std::span<const std::uint8_t> bytes, const std::string& name, LoadBudget& budget) {
  Reader in(bytes, name);
  const Header header = parseHeader(in, name);
  const bool rows = header.slowAxis == 'Y';
  const auto slow = static_cast<int>(header.slow), fast = static_cast<int>(header.fast);
  budget.charge(static_cast<std::uint64_t>(header.slow * header.fast), sizeof(Vec3), name);
  ImageRgb image(rows ? fast : slow, rows ? slow : fast);
  std::vector<Rgbe> line(static_cast<std::size_t>(fast));
  // -Y counts downwards and +X to the right: the way of our images.
  const bool slowTurned = (header.slowSign == '-') != rows, fastTurned = (header.fastSign == '-') == rows;
  for (int s = 0; s < slow; ++s) {
    if (s % codecs::kRowsPerLook == 0) budget.checkTime();
    if (in.startsNewScanline(fast)) {
      readNewScanline(in, line);
    } else {
      readOldScanline(in, line);
    }
    const int i = slowTurned ? slow - 1 - s : s;
    for (int f = 0; f < fast; ++f) {
      const int j = fastTurned ? fast - 1 - f : f;
      image.at(rows ? j : i, rows ? i : j) = decode(line[static_cast<std::size_t>(f)], 1 / header.exposure);
    }
  }
  return image;
}

}  // namespace saccade::core
