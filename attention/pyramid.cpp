#include "attention/pyramid.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>

namespace saccade::attention {
namespace {

using core::ImageGray;
using core::ImageRgba8;

constexpr int kLevels = 9;
constexpr int kTaps = 5;      // the longer filter
constexpr int kRingRows = 8;  // at least kTaps, a power of two
constexpr int kPad = 2;       // pixels by which a filter reaches over a border

struct Rgb {
  int r, g, b;
};

inline Rgb unpack(std::uint32_t rgba) {
  static_assert(std::endian::native == std::endian::little);
  return {static_cast<int>(rgba & 255), static_cast<int>(rgba >> 8 & 255),
          static_cast<int>(rgba >> 16 & 255)};
}

int brightestSum(std::span<const std::uint32_t> pixels) {
  int brightest = 0;
  for (const std::uint32_t pixel : pixels) {
    const Rgb c = unpack(pixel);
    brightest = std::max(brightest, c.r + c.g + c.b);
  }
  return brightest;
}

// To the nearest integer; the bias makes truncation round down for the negative values too.
inline float quantise(float hue) {
  constexpr float kBias = 4 * kHueUnit;
  return static_cast<float>(static_cast<int>(hue + (kBias + 0.5f))) - kBias;
}

// Itti et al. 1998: r, g, b over I where I > 1/10 of its maximum over the image, else 0; broad-tuned channels
// R = r - (g + b)/2, G, B alike, Y = (r + g)/2 - |r - g|/2 - b, negative values set to 0. In integers, and
// divided by I last: choices between floats would keep the loop from becoming vector code.
void convertRow(std::span<const std::uint32_t> pixels, int brightest, float* intensity, float* redGreen,
                float* blueYellow) {
  for (std::size_t x = 0; x < pixels.size(); ++x) {
    const auto [r, g, b] = unpack(pixels[x]);
    const int sum = r + g + b;
    const int red = std::max(2 * r - g - b, 0);
    const int green = std::max(2 * g - r - b, 0);
    const int blue = std::max(2 * b - r - g, 0);
    const int yellow = 2 * std::max(std::min(r, g) - b, 0);  // (r + g)/2 - |r - g|/2 = min(r, g)
    const int hasHue = 10 * sum > brightest ? 1 : 0;
    const float perIntensity =
        1.5f * kHueUnit / static_cast<float>(std::max(sum, 1));  // 1.5 = 1/2 over I = sum/3
    intensity[x] = static_cast<float>(sum);
    redGreen[x] = quantise(static_cast<float>((red - green) * hasHue) * perIntensity);
    blueYellow[x] = quantise(static_cast<float>((blue - yellow) * hasHue) * perIntensity);
  }
}

// Vertical filter: `rows` are the taps' rows from the top; an even side uses the first four.
void combineRows(const std::array<const float*, kTaps>& rows, bool even, int width, float* out) {
  const auto [a, b, c, d, e] = rows;
  if (even) {
    for (int x = 0; x < width; ++x) out[x] = ((a[x] + d[x]) + 3 * (b[x] + c[x])) * 0.125f;
  } else {
    for (int x = 0; x < width; ++x) out[x] = ((a[x] + e[x]) + 4 * (b[x] + d[x]) + 6 * c[x]) * 0.0625f;
  }
}

// Horizontal filter on a row that has kPad pixels of room at either end.
void combineColumns(float* row, int width, float* out) {
  for (int i = 1; i <= kPad; ++i) {
    row[-i] = row[0];
    row[width - 1 + i] = row[width - 1];
  }
  const int half = (width + 1) / 2;
  if (width % 2 == 0) {
    for (int i = 0; i < half; ++i) {
      const float* p = row + 2 * i;
      out[i] = ((p[-1] + p[2]) + 3 * (p[0] + p[1])) * 0.125f;
    }
  } else {
    for (int i = 0; i < half; ++i) {
      const float* p = row + 2 * i;
      out[i] = ((p[-2] + p[2]) + 4 * (p[-1] + p[1]) + 6 * p[0]) * 0.0625f;
    }
  }
}

// First tap's row for row y of the next level.
int firstTap(int y, bool even) { return 2 * y - (even ? 1 : 2); }

// rowAt(y) gives row y of the finer level; called with 0 <= y < height only.
template <class RowAt>
void halveRow(RowAt&& rowAt, int width, int height, int y, float* padded, float* out) {
  const bool even = height % 2 == 0;
  std::array<const float*, kTaps> rows;
  for (int i = 0; i < kTaps; ++i) rows[i] = rowAt(std::clamp(firstTap(y, even) + i, 0, height - 1));
  combineRows(rows, even, width, padded + kPad);
  combineColumns(padded + kPad, width, out);
}

}  // namespace

std::vector<LevelGeometry> pyramidGeometry(int width, int height) {
  assert(width > 0 && height > 0);
  std::vector<LevelGeometry> levels{{width, height, 1, 0, 0}};
  while (levels.size() < kLevels && (levels.back().width > 1 || levels.back().height > 1)) {
    const LevelGeometry& l = levels.back();
    const auto halfwayBetweenPixels = [&](int side) { return side % 2 == 0 ? 0.5f * l.scale : 0.0f; };
    levels.push_back({(l.width + 1) / 2, (l.height + 1) / 2, 2 * l.scale,
                      l.offsetX + halfwayBetweenPixels(l.width), l.offsetY + halfwayBetweenPixels(l.height)});
  }
  return levels;
}

void halve(const ImageGray& in, ImageGray& out, std::vector<float>& padded) {
  assert(out.width() == (in.width() + 1) / 2 && out.height() == (in.height() + 1) / 2);
  padded.resize(std::max(padded.size(), static_cast<std::size_t>(in.width()) + 2 * kPad));
  for (int y = 0; y < out.height(); ++y) {
    halveRow([&](int row) { return &in.at(0, row); }, in.width(), in.height(), y, padded.data(),
             &out.at(0, y));
  }
}

void OpponentPyramid::resize(const std::vector<LevelGeometry>& levels, bool storeLevel0) {
  storeLevel0_ = storeLevel0;
  planes_.clear();
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const bool stored = l > 0 || storeLevel0;
    const int width = stored ? levels[l].width : 0, height = stored ? levels[l].height : 0;
    Planes& planes = planes_.emplace_back();
    for (ImageGray& plane : planes) plane = ImageGray(width, height);
  }
  packed_.assign(levels[0].width, 0);
  padded_.assign(static_cast<std::size_t>(levels[0].width) + 2 * kPad, 0);
  ring_.assign(storeLevel0 ? 0 : static_cast<std::size_t>(kRingRows) * kChannels * levels[0].width, 0);
}

// Bytes copied to 32-bit words, a row at a time: whole words are what the compiler makes vector code of.
std::span<const std::uint32_t> OpponentPyramid::packedRow(const ImageRgba8& displayed, int y) {
  std::memcpy(packed_.data(), &displayed.at(0, y), packed_.size() * sizeof(std::uint32_t));
  return packed_;
}

void OpponentPyramid::build(const ImageRgba8& displayed) {
  assert(displayed.width() == static_cast<int>(packed_.size()));
  int brightest = 0;
  for (int y = 0; y < displayed.height(); ++y) {
    brightest = std::max(brightest, brightestSum(packedRow(displayed, y)));
  }
  if (storeLevel0_) {
    Planes& p = planes_[0];
    for (int y = 0; y < displayed.height(); ++y) {
      convertRow(packedRow(displayed, y), brightest, &p[kIntensity].at(0, y), &p[kRedGreen].at(0, y),
                 &p[kBlueYellow].at(0, y));
    }
  } else {
    buildLevel1(displayed, brightest);
  }
  for (std::size_t l = storeLevel0_ ? 1 : 2; l < planes_.size(); ++l) {
    for (int c = 0; c < kChannels; ++c) halve(planes_[l - 1][c], planes_[l][c], padded_);
  }
}

void OpponentPyramid::buildLevel1(const ImageRgba8& displayed, int brightest) {
  const int width = displayed.width(), height = displayed.height();
  const auto ringRow = [&](int y, int channel) {
    return ring_.data() + (static_cast<std::size_t>(y % kRingRows) * kChannels + channel) * width;
  };
  int converted = 0;
  for (int y = 0; y < (height + 1) / 2; ++y) {
    const int lastTap = std::min(firstTap(y, height % 2 == 0) + kTaps - 1, height - 1);
    for (; converted <= lastTap; ++converted) {
      convertRow(packedRow(displayed, converted), brightest, ringRow(converted, kIntensity),
                 ringRow(converted, kRedGreen), ringRow(converted, kBlueYellow));
    }
    for (int c = 0; c < kChannels; ++c) {
      halveRow([&](int row) { return ringRow(row, c); }, width, height, y, padded_.data(),
               &planes_[1][c].at(0, y));
    }
  }
}

}  // namespace saccade::attention
