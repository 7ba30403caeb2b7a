// JPEG by libjpeg-turbo's libjpeg interface (RGBA in and out is turbo's extension).
// The next three in this order: jpeglib.h needs FILE and size_t declared, jerror.h needs jpeglib.h.
// clang-format off
#include <cstdio>
#include <jpeglib.h>
#include <jerror.h>
// clang-format on

#include <csetjmp>
#include <cstdlib>

#include "core/error.h"
#include "core/image_codecs.h"
#include "core/image_io.h"

namespace saccade::core {
namespace {

/// A progressive file of a few kilobytes can ask for thousands of passes over a large image.
constexpr int kMaxScans = 500;

/// Every 8x8 block takes at least one bit of Huffman code, so that a byte holds at most this many pixels.
/// Arithmetic code can go below; what its files claim is checked against this many times the bound.
constexpr std::uint64_t kPixelsPerByte = 512, kArithmeticGain = 64;

/// libjpeg reports errors by longjmp. What must be freed lives in frames that longjmp does not cross.
struct JpegErrors {
  jpeg_error_mgr manager{};  // first: libjpeg's pointer to it is ours to all
  std::jmp_buf jump;
  char message[JMSG_LENGTH_MAX] = "";
  const LoadBudget* budget = nullptr;

  static void fail(j_common_ptr codec) {
    auto* errors = reinterpret_cast<JpegErrors*>(codec->err);
    codec->err->format_message(codec, errors->message);
    std::longjmp(errors->jump, 1);
  }
  /// A warning means damaged data, except for padding between segments, which some cameras write.
  static void warn(j_common_ptr codec, int level) {
    if (level < 0 && codec->err->msg_code != JWRN_EXTRANEOUS_DATA) fail(codec);
  }
  static void limitWork(j_common_ptr codec) {
    const auto* errors = reinterpret_cast<JpegErrors*>(codec->err);
    const bool tooMany = reinterpret_cast<j_decompress_ptr>(codec)->input_scan_number > kMaxScans;
    if (tooMany || (errors->budget && errors->budget->timeIsUp())) ERREXIT(codec, JERR_BAD_PROGRESSION);
  }
  jpeg_error_mgr* install() {
    jpeg_std_error(&manager);
    manager.error_exit = fail;
    manager.emit_message = warn;
    return &manager;
  }
};

struct Decompressor {
  JpegErrors errors;
  jpeg_progress_mgr progress{};
  jpeg_decompress_struct codec{};

  Decompressor() {
    codec.err = errors.install();
    progress.progress_monitor = JpegErrors::limitWork;
  }
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;
  ~Decompressor() { jpeg_destroy_decompress(&codec); }

  bool readHeader(std::span<const std::uint8_t> bytes) {
    if (setjmp(errors.jump)) return false;
    jpeg_create_decompress(&codec);
    codec.progress = &progress;
    jpeg_mem_src(&codec, bytes.data(), bytes.size());
    jpeg_read_header(&codec, TRUE);
    return true;
  }
  bool readRows(Rgba8* pixels) {
    if (setjmp(errors.jump)) return false;
    const bool cmyk = isCmyk();
    codec.out_color_space = cmyk ? JCS_CMYK : JCS_EXT_RGBA;
    jpeg_start_decompress(&codec);
    while (codec.output_scanline < codec.output_height) {
      Rgba8* const first = &pixels[std::size_t{codec.output_scanline} * codec.output_width];
      JSAMPROW row = &first->r;
      jpeg_read_scanlines(&codec, &row, 1);
      if (cmyk) inkToLight(first);
    }
    jpeg_finish_decompress(&codec);
    return true;
  }
  bool isCmyk() const { return codec.jpeg_color_space == JCS_CMYK || codec.jpeg_color_space == JCS_YCCK; }
  /// A row of C, M, Y, K in the pixels' four bytes to R, G, B: light = (1 - ink)(1 - black), without the
  /// press's profile. Adobe's files hold 1 - ink.
  void inkToLight(Rgba8* pixels) const {
    const int turn = codec.saw_Adobe_marker ? 0 : 255;
    for (JDIMENSION x = 0; x < codec.output_width; ++x) {
      Rgba8& p = pixels[x];
      const int rest = p.a ^ turn;
      const auto light = [&](int clear) {
        return static_cast<std::uint8_t>(((clear ^ turn) * rest + 127) / 255);
      };
      p = {light(p.r), light(p.g), light(p.b), 255};
    }
  }
};

struct Compressor {
  JpegErrors errors;
  jpeg_compress_struct codec{};
  unsigned char* out = nullptr;  // libjpeg's, by malloc
  unsigned long size = 0;

  Compressor() { codec.err = errors.install(); }
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;
  ~Compressor() {
    jpeg_destroy_compress(&codec);
    std::free(out);
  }
  bool write(int width, int height, const Rgba8* pixels, int quality) {
    if (setjmp(errors.jump)) return false;
    jpeg_create_compress(&codec);
    jpeg_mem_dest(&codec, &out, &size);
    codec.image_width = static_cast<JDIMENSION>(width);
    codec.image_height = static_cast<JDIMENSION>(height);
    codec.input_components = 4;
    codec.in_color_space = JCS_EXT_RGBX;
    jpeg_set_defaults(&codec);
    jpeg_set_quality(&codec, quality, TRUE);
    jpeg_start_compress(&codec, TRUE);
    while (codec.next_scanline < codec.image_height) {
      // libjpeg's rows are not const, but writing leaves them alone.
      auto* row = const_cast<JSAMPROW>(&pixels[std::size_t{codec.next_scanline} * codec.image_width].r);
      jpeg_write_scanlines(&codec, &row, 1);
    }
    jpeg_finish_compress(&codec);
    return true;
  }
};

/// Reads and checks the header.
void openJpeg(Decompressor& jpeg, std::span<const std::uint8_t> bytes, const std::string& name) {
  if (!jpeg.readHeader(bytes)) throw Error(name + ": damaged JPEG: " + jpeg.errors.message);
  codecs::checkDimensions(jpeg.codec.image_width, jpeg.codec.image_height, name);
  const J_COLOR_SPACE space = jpeg.codec.jpeg_color_space;
  if (space != JCS_GRAYSCALE && space != JCS_RGB && space != JCS_YCbCr && !jpeg.isCmyk())
    throw Error(name + ": JPEG in an unknown colour space; convert it to RGB");
  const std::uint64_t pixels = std::uint64_t{jpeg.codec.image_width} * jpeg.codec.image_height;
  if (pixels / (kPixelsPerByte * (jpeg.codec.arith_code ? kArithmeticGain : 1)) > bytes.size())
    throw Error(name + ": damaged JPEG: " + std::to_string(bytes.size()) + " bytes cannot hold " +
                std::to_string(jpeg.codec.image_width) + " x " + std::to_string(jpeg.codec.image_height) +
                " pixels");
}

}  // namespace

bool codecs::isJpeg(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

void codecs::checkJpegHeader(std::span<const std::uint8_t> bytes, const std::string& name) {
  Decompressor jpeg;
  openJpeg(jpeg, bytes, name);
}

ImageRgba8 codecs::decodeJpeg(std::span<const std::uint8_t> bytes, const std::string& name,
                              LoadBudget& budget) {
  Decompressor jpeg;
  jpeg.errors.budget = &budget;
  openJpeg(jpeg, bytes, name);
  const std::uint64_t pixels = std::uint64_t{jpeg.codec.image_width} * jpeg.codec.image_height;
  // A progressive file's coefficients (16 bits each, at most 4 components) are held beside the pixels.
  const std::uint64_t coefficients = jpeg.codec.progressive_mode ? pixels * 8 : 0;
  budget.charge(pixels * sizeof(Rgba8) + coefficients, name);
  ImageRgba8 image(static_cast<int>(jpeg.codec.image_width), static_cast<int>(jpeg.codec.image_height));
  const bool good = jpeg.readRows(image.pixels().data());
  budget.checkTime();
  budget.release(coefficients);
  if (!good) throw Error(name + ": damaged JPEG: " + jpeg.errors.message);
  return image;
}

std::vector<std::uint8_t> encodeJpeg(const ImageRgba8& image, int quality) {
  Compressor jpeg;
  if (!jpeg.write(image.width(), image.height(), image.pixels().data(), quality)) {
    throw Error(std::string("JPEG encoder: ") + jpeg.errors.message);
  }
  return {jpeg.out, jpeg.out + jpeg.size};
}

}  // namespace saccade::core
