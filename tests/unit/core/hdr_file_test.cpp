// Radiance pictures: every way of storing them, and files that lie about themselves.
#include "core/hdr_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "core/error.h"
#include "core/image_io.h"

namespace saccade::core {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Rgbe = std::array<std::uint8_t, 4>;

Bytes header(const std::string& size, const std::string& lines = "FORMAT=32-bit_rle_rgbe\n") {
  const std::string text = "#?RADIANCE\n" + lines + "\n" + size + "\n";
  return {text.begin(), text.end()};
}

ImageRgb decodeHdr(const Bytes& bytes, const std::string& name) {
  LoadBudget budget(LoadLimits{}, name);
  return core::decodeHdr(bytes, name, budget);
}

std::string messageOf(const Bytes& bytes) {
  try {
    decodeHdr(bytes, "skies/noon.hdr");
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

void append(Bytes& to, std::initializer_list<int> bytes) {
  for (const int b : bytes) to.push_back(static_cast<std::uint8_t>(b));
}

/// Mantissas say where a pixel lies: (x, y) -> (x + 1, y + 1, 7) / 256.
Rgbe pixelAt(int x, int y) {
  return {static_cast<std::uint8_t>(x + 1), static_cast<std::uint8_t>(y + 1), 7, 128};
}
Vec3 colorAt(int x, int y) { return Vec3(static_cast<float>(x + 1), static_cast<float>(y + 1), 7) / 256.0f; }

TEST(Hdr, MantissasAndExponents) {
  Bytes file = header("-Y 1 +X 4");
  append(file, {128, 64, 0, 129, 200, 100, 50, 0, 255, 255, 255, 255, 1, 0, 0, 1});
  const ImageRgb image = decodeHdr(file, "x");
  EXPECT_EQ(image.at(0, 0), Vec3(1, 0.5f, 0));
  EXPECT_EQ(image.at(1, 0), Vec3(0));  // exponent 0 is black
  EXPECT_EQ(image.at(2, 0), Vec3(std::ldexp(255.0f, 119)));
  EXPECT_EQ(image.at(3, 0), Vec3(std::ldexp(1.0f, -135), 0, 0));
}

TEST(Hdr, EveryOrderOfTheAxesComesOutTheRightWayUp) {
  constexpr int kWidth = 3, kHeight = 5;
  for (const bool rows : {true, false}) {
    for (const bool flipY : {false, true}) {
      for (const bool flipX : {false, true}) {
        const std::string y = std::string(flipY ? "+Y " : "-Y ") + std::to_string(kHeight);
        const std::string x = std::string(flipX ? "-X " : "+X ") + std::to_string(kWidth);
        Bytes file = header(rows ? y + " " + x : x + " " + y);
        for (int s = 0; s < (rows ? kHeight : kWidth); ++s) {
          for (int f = 0; f < (rows ? kWidth : kHeight); ++f) {
            const int column = rows ? f : s, row = rows ? s : f;
            const Rgbe p = pixelAt(flipX ? kWidth - 1 - column : column, flipY ? kHeight - 1 - row : row);
            file.insert(file.end(), p.begin(), p.end());
          }
        }
        const ImageRgb image = decodeHdr(file, "x");
        ASSERT_EQ(image.width(), kWidth);
        ASSERT_EQ(image.height(), kHeight);
        for (int j = 0; j < kHeight; ++j) {
          for (int i = 0; i < kWidth; ++i) EXPECT_EQ(image.at(i, j), colorAt(i, j)) << y << " " << x;
        }
      }
    }
  }
}

/// One scanline in the new encoding, runs where two or more bytes are equal.
void encodeNew(Bytes& out, const std::vector<Rgbe>& line) {
  const auto n = static_cast<int>(line.size());
  append(out, {2, 2, n >> 8, n & 255});
  for (std::size_t c = 0; c < 4; ++c) {
    for (std::size_t x = 0; x < line.size();) {
      std::size_t run = 1;
      while (x + run < line.size() && run < 127 && line[x + run][c] == line[x][c]) ++run;
      append(out, run > 1 ? std::initializer_list<int>{static_cast<int>(128 + run), line[x][c]}
                          : std::initializer_list<int>{1, line[x][c]});
      x += run;
    }
  }
}

TEST(Hdr, NewRunLengthsEqualFlatPixels) {
  std::mt19937 random(3);
  for (const int width : {8, 127, 128, 300}) {
    constexpr int kHeight = 4;
    const std::string size = "-Y 4 +X " + std::to_string(width);
    Bytes packed = header(size), flat = header(size);
    for (int y = 0; y < kHeight; ++y) {
      std::vector<Rgbe> line;
      for (int x = 0; x < width; ++x) {
        const bool repeat = !line.empty() && random() % 4 != 0;
        // A first pixel with 2, 2 would say "new encoding" in the flat file.
        line.push_back(repeat ? line.back()
                              : Rgbe{static_cast<std::uint8_t>(3 + random() % 250),
                                     static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random()),
                                     static_cast<std::uint8_t>(random())});
      }
      encodeNew(packed, line);
      for (const Rgbe& p : line) flat.insert(flat.end(), p.begin(), p.end());
    }
    EXPECT_EQ(decodeHdr(packed, "x").pixels(), decodeHdr(flat, "x").pixels()) << width;
    for (std::size_t n = header(size).size(); n < packed.size(); n += 7) {
      const Bytes cut(packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(n));
      EXPECT_NE(messageOf(cut).find("cut off"), std::string::npos) << n;
    }
  }
}

TEST(Hdr, OldRunLengths) {
  // 1 pixel, 2 more, then 0x0102 more by two markers: 261 in all.
  Bytes file = header("-Y 1 +X 264");
  append(file,
         {10, 20, 30, 129, 1, 1, 1, 2, 9, 9, 9, 128, 1, 1, 1, 2, 1, 1, 1, 1, 5, 5, 5, 128, 5, 5, 6, 128});
  const ImageRgb image = decodeHdr(file, "x");
  EXPECT_EQ(image.at(2, 0), Vec3(10, 20, 30) / 128.0f);
  EXPECT_EQ(image.at(3, 0), Vec3(9) / 256.0f);
  EXPECT_EQ(image.at(261, 0), Vec3(9) / 256.0f);
  EXPECT_EQ(image.at(262, 0), Vec3(5) / 256.0f);
  EXPECT_EQ(image.at(263, 0), Vec3(5, 5, 6) / 256.0f);
}

TEST(Hdr, ExposureIsDividedOut) {
  Bytes file = header("-Y 1 +X 1", "EXPOSURE=2\r\n# a remark\nFORMAT=32-bit_rle_rgbe\nEXPOSURE= 4.0\n");
  append(file, {128, 64, 32, 132});
  EXPECT_EQ(decodeHdr(file, "x").at(0, 0), Vec3(1, 0.5f, 0.25f));
}

TEST(Hdr, RefusesWhatIsWrongNamingIt) {
  const auto refused = [](const Bytes& file, const char* why) {
    const std::string message = messageOf(file);
    EXPECT_NE(message.find(why), std::string::npos) << message;
    EXPECT_NE(message.find("skies/noon.hdr"), std::string::npos) << message;
  };
  const std::string magic = "RADIANCE\n\n-Y 1 +X 1\n0000";
  refused(Bytes(magic.begin(), magic.end()), "#?RADIANCE");
  refused(Bytes{}, "header without an end");
  refused(header("-Y 1 +X 1", "FORMAT=32-bit_rle_xyze\n"), "32-bit_rle_xyze");
  for (const char* size :
       {"", "-Y 4", "-Y 4 +Y 4", "-Y x +X 4", "Y 4 X 4", "-Y 4 +X 4 more", "-Y 99999999999999999999 +X 4"})
    refused(header(size), "size line");
  refused(header("-Y 1 +X 1", "EXPOSURE=0\n"), "EXPOSURE");
  refused(header("-Y 0 +X 4"), "pixels are supported");
  refused(header("-Y 4 +X -4"), "pixels are supported");
  refused(header("-Y 2000000000 +X 2000000000"), "pixels are supported");
  refused(header("-Y 16000 +X 16000"), "cannot hold");  // nothing behind it, nothing allocated

  Bytes run = header("-Y 1 +X 8");
  append(run, {2, 2, 0, 8, 128 + 9, 1, 0, 0, 0, 0, 0, 0, 0, 0});
  refused(run, "leaves its scanline");
  Bytes zero = header("-Y 1 +X 8");
  append(zero, {2, 2, 0, 8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  refused(zero, "leaves its scanline");
  Bytes length = header("-Y 1 +X 8");
  append(length, {2, 2, 0, 9, 128 + 8, 1, 128 + 8, 1, 128 + 8, 1, 128 + 8, 1});
  refused(length, "another length");
  Bytes nothing = header("-Y 1 +X 2");
  append(nothing, {1, 1, 1, 2});
  refused(nothing, "not there");
  Bytes overrun = header("-Y 1 +X 3");
  append(overrun, {5, 5, 5, 128, 1, 1, 1, 3});
  refused(overrun, "leaves its scanline");
  Bytes endless = header("-Y 1 +X 3");
  append(endless, {5, 5, 5, 128});
  for (int i = 0; i < 6; ++i) append(endless, {1, 1, 1, 0});
  refused(endless, "not there");
}

TEST(Hdr, PixelsAreChargedBeforeTheyAreAllocated) {
  Bytes file = header("-Y 1000 +X 16384");  // each scanline is one pixel and a run
  for (int y = 0; y < 1000; ++y) append(file, {5, 5, 5, 128, 1, 1, 1, 255, 1, 1, 1, 63});
  LoadBudget budget({.memoryBytes = 100 << 20}, "x");
  try {
    core::decodeHdr(file, "x", budget);
    ADD_FAILURE() << "was read";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("--max-memory"), std::string::npos) << e.what();
  }
}

TEST(Hdr, AFewBytesDoNotClaimGigabytes) {
  Bytes file = header("+X 4 -Y 55555555");  // found by fuzzing
  for (int i = 0; i < 4; ++i) append(file, {5, 5, 5, 128});
  EXPECT_NE(messageOf(file).find("cannot hold"), std::string::npos) << messageOf(file);
}

TEST(Hdr, NoBytesMakeItCrash) {
  std::mt19937 random(5);
  Bytes whole = header("-Y 6 +X 40");
  for (int y = 0; y < 6; ++y) encodeNew(whole, std::vector<Rgbe>(40, pixelAt(y, 3)));
  int read = 0;
  for (int i = 0; i < 20000; ++i) {
    Bytes file = whole;
    for (int k = 0; k < 1 + i % 4; ++k)
      file[random() % file.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
    try {
      decodeHdr(file, "x");
      ++read;
    } catch (const Error&) {
    }
  }
  EXPECT_GT(read, 100);
  EXPECT_LT(read, 19900);
}

}  // namespace
}  // namespace saccade::core
