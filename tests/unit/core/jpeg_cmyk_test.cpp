// CMYK and YCCK JPEGs, as printers' tools write them, become RGB.
// The next two in this order: jpeglib.h needs FILE and size_t declared.
// clang-format off
#include <cstdio>
#include <jpeglib.h>
// clang-format on

#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include "core/image_io.h"

namespace saccade::core {
namespace {

/// An image of one colour in four inks, 255 = full ink; with Adobe's marker the inks are stored inverted.
std::vector<std::uint8_t> inkJpeg(const std::uint8_t (&inks)[4], bool adobe, J_COLOR_SPACE space) {
  jpeg_error_mgr errors;
  jpeg_compress_struct codec;
  codec.err = jpeg_std_error(&errors);
  jpeg_create_compress(&codec);
  unsigned char* out = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&codec, &out, &size);
  codec.image_width = codec.image_height = 16;
  codec.input_components = 4;
  codec.in_color_space = JCS_CMYK;
  jpeg_set_defaults(&codec);
  jpeg_set_colorspace(&codec, space);
  jpeg_set_quality(&codec, 100, TRUE);
  codec.write_Adobe_marker = adobe ? TRUE : FALSE;
  jpeg_start_compress(&codec, TRUE);
  std::vector<std::uint8_t> line;
  for (int x = 0; x < 16; ++x)
    for (const std::uint8_t ink : inks) line.push_back(static_cast<std::uint8_t>(adobe ? 255 - ink : ink));
  for (int y = 0; y < 16; ++y) {
    JSAMPROW row = line.data();
    jpeg_write_scanlines(&codec, &row, 1);
  }
  jpeg_finish_compress(&codec);
  jpeg_destroy_compress(&codec);
  std::vector<std::uint8_t> bytes(out, out + size);
  std::free(out);
  return bytes;
}

void expectColor(const std::vector<std::uint8_t>& jpeg, int r, int g, int b) {
  const Rgba8 p = decodeImage(jpeg, "inks").at(7, 7);
  EXPECT_NEAR(p.r, r, 2);
  EXPECT_NEAR(p.g, g, 2);
  EXPECT_NEAR(p.b, b, 2);
  EXPECT_EQ(p.a, 255);
}

TEST(Jpeg, FourInksBecomeLight) {
  // light = (1 - ink)(1 - black): 0.8 x 0.6, 1 x 0.6, 0 x 0.6.
  for (const bool adobe : {false, true})
    expectColor(inkJpeg({51, 0, 255, 102}, adobe, JCS_CMYK), 122, 153, 0);
  expectColor(inkJpeg({51, 0, 255, 102}, true, JCS_YCCK), 122, 153, 0);
  expectColor(inkJpeg({0, 0, 0, 0}, true, JCS_YCCK), 255, 255, 255);
}

}  // namespace
}  // namespace saccade::core
