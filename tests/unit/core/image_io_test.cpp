// Round trips, foreign variants, and files that lie about themselves.
#include "core/image_io.h"

#include <gtest/gtest.h>
#include <png.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>
#include <thread>
#include <tuple>

#include "core/atomic_file.h"
#include "core/error.h"
#include "tests/shared_folder.h"
#include "tests/unit/core/temporary_folder.h"

namespace saccade::core {
namespace {

using tests::TemporaryFolder;
using Bytes = std::vector<std::uint8_t>;

ImageRgba8 randomImage(int width, int height, bool opaque) {
  std::mt19937 random(static_cast<unsigned>(width * 1000 + height));
  ImageRgba8 image(width, height);
  for (Rgba8& p : image.pixels()) {
    const auto v = static_cast<std::uint32_t>(random());
    p = {static_cast<std::uint8_t>(v), static_cast<std::uint8_t>(v >> 8), static_cast<std::uint8_t>(v >> 16),
         opaque ? std::uint8_t{255} : static_cast<std::uint8_t>(v >> 24)};
  }
  return image;
}

ImageRgba8 smoothImage(int width, int height) {
  ImageRgba8 image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.at(x, y) = {static_cast<std::uint8_t>(255 * x / width),
                        static_cast<std::uint8_t>(255 * y / height), 90, 255};
    }
  }
  return image;
}

/// A PNG of any colour type by libpng itself. `rows` in the file's own layout.
struct ForeignPng {
  int width, height, depth, colorType;
  bool interlaced = false;
  std::vector<png_color> palette{};
  Bytes paletteAlpha{};
};

Bytes encodeForeign(const ForeignPng& f, Bytes rows) {
  Bytes out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &out,
      [](png_structp p, png_bytep from, std::size_t n) {
        auto* to = static_cast<Bytes*>(png_get_io_ptr(p));
        to->insert(to->end(), from, from + n);
      },
      nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(f.width), static_cast<png_uint_32>(f.height), f.depth,
               f.colorType, f.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (!f.palette.empty()) png_set_PLTE(png, info, f.palette.data(), static_cast<int>(f.palette.size()));
  if (!f.paletteAlpha.empty()) {
    png_set_tRNS(png, info, f.paletteAlpha.data(), static_cast<int>(f.paletteAlpha.size()), nullptr);
  }
  // A gamma chunk that must not change the samples.
  png_set_gAMA(png, info, 1.0);
  png_write_info(png, info);
  const std::size_t stride = png_get_rowbytes(png, info);
  std::vector<png_bytep> pointers;
  for (int y = 0; y < f.height; ++y) pointers.push_back(rows.data() + stride * static_cast<std::size_t>(y));
  png_write_image(png, pointers.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return out;
}

TEST(Png, RoundTripIsExact) {
  for (bool opaque : {true, false}) {
    for (auto [w, h] : {std::pair{1, 1}, {3, 5}, {257, 31}}) {
      const ImageRgba8 image = randomImage(w, h, opaque);
      const ImageRgba8 back = decodeImage(encodePng(image), "test");
      EXPECT_EQ(back.width(), w);
      EXPECT_EQ(back.pixels(), image.pixels());
    }
  }
}

TEST(Png, GreyPaletteSixteenBitAndInterlaced) {
  const ImageRgba8 grey = decodeImage(encodeForeign({3, 1, 8, PNG_COLOR_TYPE_GRAY}, {0, 100, 255}), "grey");
  EXPECT_EQ(grey.pixels(), (std::vector<Rgba8>{{0, 0, 0, 255}, {100, 100, 100, 255}, {255, 255, 255, 255}}));

  const ImageRgba8 bits = decodeImage(encodeForeign({8, 1, 1, PNG_COLOR_TYPE_GRAY}, {0b10110000}), "bits");
  EXPECT_EQ(bits.at(0, 0).r, 255);
  EXPECT_EQ(bits.at(1, 0).r, 0);
  EXPECT_EQ(bits.at(3, 0).r, 255);

  const ImageRgba8 greyAlpha = decodeImage(encodeForeign({1, 1, 8, PNG_COLOR_TYPE_GRAY_ALPHA}, {7, 9}), "ga");
  EXPECT_EQ(greyAlpha.at(0, 0), (Rgba8{7, 7, 7, 9}));

  const ForeignPng palette{2, 1, 8, PNG_COLOR_TYPE_PALETTE, false, {{1, 2, 3}, {4, 5, 6}}, {128}};
  const ImageRgba8 indexed = decodeImage(encodeForeign(palette, {1, 0}), "palette");
  EXPECT_EQ(indexed.pixels(), (std::vector<Rgba8>{{4, 5, 6, 255}, {1, 2, 3, 128}}));

  // 16 bits are rounded to 8: 0x8000 / 257 = 127.5, 0x0101 * 9 is exactly 9.
  const ImageRgba8 deep =
      decodeImage(encodeForeign({1, 1, 16, PNG_COLOR_TYPE_RGB}, {9, 9, 0xff, 0xff, 0x12, 0x00}), "deep");
  EXPECT_EQ(deep.at(0, 0), (Rgba8{9, 255, 18, 255}));

  const ImageRgba8 image = randomImage(19, 23, false);
  Bytes rows(image.pixels().size() * 4);
  std::memcpy(rows.data(), image.pixels().data(), rows.size());
  EXPECT_EQ(decodeImage(encodeForeign({19, 23, 8, PNG_COLOR_TYPE_RGBA, true}, rows), "adam7").pixels(),
            image.pixels());
}

TEST(Png, CutAtEveryByteIsRefused) {
  const Bytes whole = encodePng(randomImage(9, 7, false));
  for (std::size_t n = 0; n < whole.size(); ++n) {
    EXPECT_THROW(decodeImage(std::span(whole).first(n), "cut"), Error) << n;
  }
}

TEST(Png, EveryFlippedBitGivesAnImageOrAnError) {
  const Bytes whole = encodePng(randomImage(5, 4, true));
  int refused = 0;
  for (std::size_t bit = 0; bit < whole.size() * 8; ++bit) {
    Bytes damaged = whole;
    damaged[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
    try {
      decodeImage(damaged, "flipped");
    } catch (const Error&) {
      ++refused;
    }
  }
  // Checksums find nearly all; flips in the length or type of ancillary chunks may pass.
  EXPECT_GT(refused, static_cast<int>(whole.size() * 8) * 9 / 10);
}

void putBigEndian(Bytes& bytes, std::size_t at, std::uint32_t v) {
  for (int i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(v >> (24 - 8 * i));
}

std::uint32_t crc32Of(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = 0xffffffffu;
  for (std::uint8_t b : bytes) {
    crc ^= b;
    for (int i = 0; i < 8; ++i) crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

/// A small file whose header claims another size, with a correct checksum.
Bytes claiming(std::uint32_t width, std::uint32_t height) {
  Bytes png = encodePng(randomImage(4, 4, true));
  putBigEndian(png, 16, width);
  putBigEndian(png, 20, height);
  putBigEndian(png, 29, crc32Of(std::span(png).subspan(12, 17)));
  return png;
}

std::string messageOf(std::span<const std::uint8_t> bytes) {
  try {
    decodeImage(bytes, "room/wall.png");
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(Png, BombsByDimensionAndEmptySidesAreRefused) {
  EXPECT_EQ(decodeImage(claiming(4, 4), "same").width(), 4);
  EXPECT_NE(messageOf(claiming(16000, 16000)).find("cannot hold"), std::string::npos);
  EXPECT_NE(messageOf(claiming(0x7fffffff, 0x7fffffff)).find("pixels are supported"), std::string::npos);
  EXPECT_NE(messageOf(claiming(0, 4)).find("room/wall.png"), std::string::npos);
  EXPECT_NE(messageOf(claiming(4, 0)).find("room/wall.png"), std::string::npos);
}

TEST(Png, AChunkBeyondTheFileIsRefusedBeforeItCosts) {
  Bytes png = encodePng(randomImage(4, 4, true));
  const Bytes text = {0x58, 0, 0, 0, 'z', 'T', 'X', 't'};  // 1.4 GiB; found by fuzzing
  png.insert(png.begin() + 33, text.begin(), text.end());
  EXPECT_EQ(messageOf(png), "room/wall.png: damaged PNG: the file ends within a chunk");
}

TEST(Jpeg, RoundTripIsClose) {
  const ImageRgba8 image = smoothImage(65, 47);
  const Bytes jpeg = encodeJpeg(image, 95);
  const ImageRgba8 back = decodeImage(jpeg, "test");
  ASSERT_EQ(back.width(), 65);
  ASSERT_EQ(back.height(), 47);
  for (std::size_t i = 0; i < image.pixels().size(); ++i) {
    EXPECT_NEAR(back.pixels()[i].r, image.pixels()[i].r, 8);
    EXPECT_NEAR(back.pixels()[i].g, image.pixels()[i].g, 8);
    EXPECT_EQ(back.pixels()[i].a, 255);
  }
}

TEST(Jpeg, TruncatedIsRefusedAndPaddingIsNot) {
  const Bytes whole = encodeJpeg(smoothImage(33, 33), 90);
  for (std::size_t n = 0; n + 2 < whole.size(); n += 3) {
    EXPECT_THROW(decodeImage(std::span(whole).first(n), "cut"), Error) << n;
  }
  Bytes padded = whole;
  const auto afterFirstSegment = 4 + padded[4] * 256 + padded[5];
  padded.insert(padded.begin() + afterFirstSegment, {0x00, 0x00});
  EXPECT_EQ(decodeImage(padded, "padded").pixels(), decodeImage(whole, "whole").pixels());
}

TEST(Jpeg, ClaimsThatTheFileCannotHoldAreRefusedBeforeDecoding) {
  // Height and width follow the frame marker, its length and the precision.
  Bytes jpeg = encodeJpeg(smoothImage(8, 8), 90);
  std::size_t frame = 2;
  while (!(jpeg[frame] == 0xff && jpeg[frame + 1] == 0xc0)) ++frame;
  for (std::size_t i = 5; i < 9; ++i) jpeg[frame + i] = 0x3e;
  LoadLimits little;
  little.memoryBytes = 1 << 20;
  LoadBudget budget(little, "wall.jpg");
  try {
    decodeImage(jpeg, "wall.jpg", budget);
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("cannot hold 15934 x 15934 pixels"), std::string::npos) << e.what();
  }
}

TEST(DecodeImage, ContentDecidesNotTheName) {
  TemporaryFolder folder;
  const ImageRgba8 image = smoothImage(20, 10);
  writeFileAtomically(folder / "photo.jpg", encodePng(image));
  EXPECT_EQ(readImage8(folder / "photo.jpg").pixels(), image.pixels());
  EXPECT_NE(messageOf(Bytes{}).find("neither"), std::string::npos);
  EXPECT_NE(messageOf(Bytes(100, 7)).find("neither"), std::string::npos);
}

ImageRgb radiance(int width, int height) {
  std::mt19937 random(4);
  std::normal_distribution<float> value(0, 100);
  ImageRgb image(width, height);
  for (Vec3& p : image.pixels()) p = Vec3(value(random), value(random), value(random));
  image.at(0, 0) = Vec3(1e30f, -0.0f, std::numeric_limits<float>::denorm_min());
  return image;
}

TEST(Exr, RoundTripIsBitExact) {
  TemporaryFolder folder;
  for (auto [w, h] : {std::pair{1, 1}, {3, 5}, {200, 150}}) {
    const ImageRgb image = radiance(w, h);
    writeExr(folder / "a.exr", image);
    const ImageRgb back = readExr(folder / "a.exr");
    ASSERT_EQ(back.width(), w);
    ASSERT_EQ(back.height(), h);
    EXPECT_EQ(std::memcmp(back.pixels().data(), image.pixels().data(), image.pixels().size() * sizeof(Vec3)),
              0);
  }
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(Exr, OneChannelReadsAsGreyAndForeignNamesAreRefused) {
  TemporaryFolder folder;
  ImageGray depth(4, 2, 0.5f);
  depth.at(3, 1) = 7;
  writeExrChannels(folder / "z.exr", {{"Z", &depth}});
  EXPECT_EQ(readExr(folder / "z.exr").at(3, 1), Vec3(7));
  writeExrChannels(folder / "rgb.exr", {{"R", &depth}, {"B", &depth}, {"G", &depth}, {"age", &depth}});
  EXPECT_EQ(readExr(folder / "rgb.exr").at(0, 0), Vec3(0.5f));
  writeExrChannels(folder / "two.exr", {{"X", &depth}, {"Y", &depth}});
  EXPECT_THROW(readExr(folder / "two.exr"), Error);
}

TEST(Exr, DamagedAndForeignFilesAreRefused) {
  TemporaryFolder folder;
  writeExr(folder / "a.exr", radiance(20, 40));
  const Bytes whole = readWholeFile(folder / "a.exr");
  for (std::size_t n = 0; n < whole.size(); n += whole.size() / 97) {
    writeFileAtomically(folder / "cut.exr", std::span(whole).first(n));
    EXPECT_THROW(readExr(folder / "cut.exr"), Error) << n;
  }
  Bytes tiled = whole;
  tiled[5] |= 2;
  writeFileAtomically(folder / "tiled.exr", tiled);
  EXPECT_THROW(readExr(folder / "tiled.exr"), Error);
  // The compression attribute's value follows its name, type and size.
  Bytes piz = whole;
  const std::string attribute("compression\0compression\0\1\0\0\0", 28);
  const auto at = std::search(piz.begin(), piz.end(), attribute.begin(), attribute.end());
  ASSERT_NE(at, piz.end());
  *(at + 28) = 4;
  writeFileAtomically(folder / "piz.exr", piz);
  EXPECT_THROW(readExr(folder / "piz.exr"), Error);
  EXPECT_THROW(readExr(folder.path()), Error);
  EXPECT_THROW(readExr(folder / "absent.exr"), Error);
}

TEST(Exr, EveryFlippedBitAndEveryCutGivesAnImageOrAnError) {
  TemporaryFolder folder;
  writeExr(folder / "a.exr", radiance(3, 2));
  const Bytes whole = readWholeFile(folder / "a.exr");
  const auto read = [&](std::span<const std::uint8_t> bytes) {
    writeFileAtomically(folder / "b.exr", bytes);
    try {
      return readExr(folder / "b.exr").pixels().size();
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("b.exr: "), std::string::npos) << e.what();
      return std::size_t{0};
    }
  };
  for (std::size_t n = 0; n < whole.size(); ++n) EXPECT_EQ(read(std::span(whole).first(n)), 0u) << n;
  std::size_t refused = 0;
  for (std::size_t bit = 0; bit < whole.size() * 8; ++bit) {
    Bytes damaged = whole;
    damaged[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
    refused += read(damaged) == 0;
  }
  EXPECT_GT(refused, whole.size());
}

/// An EXR header with the attributes as given, closed, without pixels.
Bytes exrHeader(const std::vector<std::tuple<std::string, std::string, std::string>>& attributes) {
  std::string text("\x76\x2f\x31\x01\x02\0\0\0", 8);
  for (const auto& [name, type, value] : attributes) {
    const auto size = static_cast<std::uint32_t>(value.size());
    text += name + '\0' + type + '\0' + std::string(reinterpret_cast<const char*>(&size), 4) + value;
  }
  text += '\0';
  return {text.begin(), text.end()};
}

TEST(Exr, HostileHeadersAreRefusedBeforeTheyCost) {
  const std::string channel("R\0\2\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0", 18), end(1, '\0'), zip(1, '\3');
  const auto window = [](std::int32_t right, std::int32_t bottom) {
    const std::int32_t box[4] = {0, 0, right, bottom};
    return std::string(reinterpret_cast<const char*>(box), sizeof box);
  };
  std::string many;
  for (int i = 0; i < 65; ++i) many += "c" + std::to_string(i) + channel.substr(1);
  const auto refusal = [&](const Bytes& bytes) {
    TemporaryFolder folder;
    writeFileAtomically(folder / "a.exr", bytes);
    LoadLimits little;
    little.memoryBytes = 1 << 20;
    LoadBudget budget(little, "a.exr");
    try {
      readExr(folder / "a.exr", budget);
      return std::string();
    } catch (const Error& e) {
      return std::string(e.what());
    }
  };
  const auto expect = [&](const Bytes& bytes, const char* part) {
    EXPECT_NE(refusal(bytes).find(part), std::string::npos) << refusal(bytes);
  };
  const auto header = [&](const std::string& channels, const std::string& box) {
    return exrHeader({{"channels", "chlist", channels},
                      {"compression", "compression", zip},
                      {"dataWindow", "box2i", box}});
  };
  expect(header(channel + end, window(9999, 9999)), "cannot hold 10000 x 10000 pixels");
  expect(header(channel + end, window(2147483647, 0)), "pixels are supported");
  expect(header(channel + end, window(-2, 5)), "pixels are supported");
  expect(header(many + end, window(0, 0)), "more than 64 channels");
  expect(header(channel.substr(0, 9), window(0, 0)), "list of channels is cut off");
  expect(exrHeader({{"compression", "compression", zip}}), "lacks 'channels'");
  Bytes lying = exrHeader({{"comments", "string", "abcd"}});
  lying[8 + 9 + 7 + 3] = 0x7f;
  expect(lying, "attribute 'comments' reaches beyond the file");
}

TEST(Files, FailedWritesLeaveNothingBehind) {
  TemporaryFolder folder;
  EXPECT_THROW(writePng(folder / "no/such/folder.png", smoothImage(2, 2)), Error);
  std::filesystem::create_directory(folder / "taken.png");
  EXPECT_THROW(writePng(folder / "taken.png", smoothImage(2, 2)), Error);
  EXPECT_THROW(writePng(folder / "empty.png", ImageRgba8()), Error);
  EXPECT_THROW(writeExr(folder / "empty.exr", ImageRgb()), Error);
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(Files, FoldersAndPipesAreNotRead) {
  TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe.png").c_str(), 0600), 0);
  EXPECT_THROW(readImage8(folder / "pipe.png"), Error);
  EXPECT_THROW(readExr(folder / "pipe.png"), Error);
  EXPECT_THROW(readImage8(folder.path()), Error);
  EXPECT_THROW(readImage8(folder / "absent.png"), Error);
}

TEST(Files, TwoWritersLeaveOneWholeFile) {
  TemporaryFolder folder;
  const ImageRgba8 images[2] = {randomImage(40, 40, true), smoothImage(64, 64)};
  {
    std::vector<std::jthread> writers;
    for (const ImageRgba8& image : images) {
      writers.emplace_back([&] {
        for (int i = 0; i < 20; ++i) writePng(folder / "shared.png", image);
      });
    }
  }
  const ImageRgba8 left = readImage8(folder / "shared.png");
  EXPECT_TRUE(left.pixels() == images[0].pixels() || left.pixels() == images[1].pixels());
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(SharedImages, RealPngsDecode) {
  SACCADE_SHARED_FILE(file, "references/flip/noise_reference.png");
  const ImageRgba8 image = readImage8(file);
  EXPECT_GT(image.width(), 100);
  EXPECT_EQ(decodeImage(encodePng(image), "again").pixels(), image.pixels());
}

}  // namespace
}  // namespace saccade::core
