// PNG by libpng. Samples are taken as they are: gamma, chromaticity and profile chunks are ignored, as glTF
// asks.
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <utility>

#include "core/error.h"
#include "core/image_codecs.h"
#include "core/image_io.h"

namespace saccade::core {
namespace {

/// Deflate cannot expand by more than 1032; a header that claims more lies.
constexpr std::uint64_t kMaxExpansion = 1040;

/// libpng reports errors by longjmp. What must be freed lives here, in frames that longjmp does not cross.
struct PngState {
  png_structp png = nullptr;
  png_infop info = nullptr;
  bool writing = false;
  std::string message;
  LoadBudget* budget = nullptr;
  std::span<const std::uint8_t> in;
  std::vector<std::uint8_t> out;

  static void fail(png_structp png, png_const_charp text) {
    static_cast<PngState*>(png_get_error_ptr(png))->message = text;
    png_longjmp(png, 1);
  }
  static void ignore(png_structp, png_const_charp) {}

  explicit PngState(bool forWriting) : writing(forWriting) {
    png = writing ? png_create_write_struct(PNG_LIBPNG_VER_STRING, this, fail, ignore)
                  : png_create_read_struct(PNG_LIBPNG_VER_STRING, this, fail, ignore);
    if (png) info = png_create_info_struct(png);
    if (!info) throw Error("libpng cannot be initialised");
  }
  PngState(const PngState&) = delete;
  PngState& operator=(const PngState&) = delete;
  ~PngState() {
    if (writing) {
      png_destroy_write_struct(&png, &info);
    } else {
      png_destroy_read_struct(&png, &info, nullptr);
    }
  }
};

void readBytes(png_structp png, png_bytep to, std::size_t count) {
  auto& state = *static_cast<PngState*>(png_get_io_ptr(png));
  if (count > state.in.size()) png_error(png, "the file ends too early");
  std::memcpy(to, state.in.data(), count);
  state.in = state.in.subspan(count);
}

void writeBytes(png_structp png, png_bytep from, std::size_t count) {
  auto& state = *static_cast<PngState*>(png_get_io_ptr(png));
  state.out.insert(state.out.end(), from, from + count);
}

bool readHeader(PngState& state) {
  if (setjmp(png_jmpbuf(state.png))) return false;
  png_set_read_fn(state.png, &state, readBytes);
  // The limits of ours come after; libpng's own default of a million per side would come before.
  png_set_user_limits(state.png, 0x7fffffff, 0x7fffffff);
  png_set_chunk_malloc_max(state.png, 8u << 20);
  png_read_info(state.png, state.info);
  return true;
}

/// Row by row, so that the clock can stop it: an interlaced image takes seven passes.
bool readRows(PngState& state, png_bytepp rows) {
  if (setjmp(png_jmpbuf(state.png))) return false;
  png_set_expand(state.png);
  png_set_scale_16(state.png);
  png_set_gray_to_rgb(state.png);
  png_set_add_alpha(state.png, 0xff, PNG_FILLER_AFTER);
  const int passes = png_set_interlace_handling(state.png);
  png_read_update_info(state.png, state.info);
  if (png_get_rowbytes(state.png, state.info) !=
      4 * std::size_t{png_get_image_width(state.png, state.info)}) {
    png_error(state.png, "unexpected row size");
  }
  const png_uint_32 height = png_get_image_height(state.png, state.info);
  for (int pass = 0; pass < passes; ++pass) {
    for (png_uint_32 y = 0; y < height; ++y) {
      if (y % codecs::kRowsPerLook == 0) state.budget->checkTime();
      png_read_row(state.png, rows[y], nullptr);
    }
  }
  png_read_end(state.png, nullptr);
  return true;
}

std::vector<png_bytep> rowPointers(ImageRgba8& image) {
  std::vector<png_bytep> rows(static_cast<std::size_t>(image.height()));
  for (int y = 0; y < image.height(); ++y) rows[y] = &image.at(0, y).r;
  return rows;
}

/// Every chunk must end within the file: libpng allocates and clears what a text chunk's length claims, up to
/// 2 GiB, before it reads it.
void checkChunks(std::span<const std::uint8_t> bytes, const std::string& name) {
  constexpr std::size_t kSignature = 8, kLengthAndType = 8, kCrc = 4;
  std::size_t at = kSignature;
  while (bytes.size() - at >= kLengthAndType + kCrc) {
    const std::uint32_t length = png_get_uint_32(&bytes[at]);
    if (length > bytes.size() - at - kLengthAndType - kCrc)
      throw Error(name + ": damaged PNG: the file ends within a chunk");
    if (std::memcmp(&bytes[at + 4], "IEND", 4) == 0) return;
    at += kLengthAndType + length + kCrc;
  }
}

/// Reads and checks the header; returns width and height.
std::pair<int, int> openPng(PngState& state, std::span<const std::uint8_t> bytes, const std::string& name) {
  checkChunks(bytes, name);
  state.in = bytes;
  if (!readHeader(state)) throw Error(name + ": damaged PNG: " + state.message);
  const std::int64_t width = png_get_image_width(state.png, state.info);
  const std::int64_t height = png_get_image_height(state.png, state.info);
  codecs::checkDimensions(width, height, name);
  const std::uint64_t claimed = png_get_rowbytes(state.png, state.info) * static_cast<std::uint64_t>(height);
  if (claimed > kMaxExpansion * bytes.size()) {
    throw Error(name + ": damaged PNG: " + std::to_string(bytes.size()) + " bytes cannot hold " +
                std::to_string(width) + " x " + std::to_string(height) + " pixels");
  }
  return {static_cast<int>(width), static_cast<int>(height)};
}

bool writeRows(PngState& state, int width, int height, bool opaque, png_bytepp rows) {
  if (setjmp(png_jmpbuf(state.png))) return false;
  png_set_write_fn(state.png, &state, writeBytes, nullptr);
  // Frames are written by the hundred: a low level costs a few per cent of size and saves most of the time.
  png_set_compression_level(state.png, 3);
  png_set_IHDR(state.png, state.info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
               opaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(state.png, state.info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(state.png, state.info);
  if (opaque) png_set_filler(state.png, 0, PNG_FILLER_AFTER);
  png_write_image(state.png, rows);
  png_write_end(state.png, nullptr);
  return true;
}

}  // namespace

bool codecs::isPng(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 8 && png_sig_cmp(bytes.data(), 0, 8) == 0;
}

void codecs::checkPngHeader(std::span<const std::uint8_t> bytes, const std::string& name) {
  PngState state(false);
  openPng(state, bytes, name);
}

ImageRgba8 codecs::decodePng(std::span<const std::uint8_t> bytes, const std::string& name,
                             LoadBudget& budget) {
  PngState state(false);
  state.budget = &budget;
  const auto [width, height] = openPng(state, bytes, name);
  budget.charge(static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height), sizeof(Rgba8), name);
  ImageRgba8 image(width, height);
  std::vector<png_bytep> rows = rowPointers(image);
  if (!readRows(state, rows.data())) throw Error(name + ": damaged PNG: " + state.message);
  return image;
}

std::vector<std::uint8_t> encodePng(const ImageRgba8& image) {
  PngState state(true);
  const bool opaque =
      std::all_of(image.pixels().begin(), image.pixels().end(), [](const Rgba8& p) { return p.a == 255; });
  // libpng's rows are not const, but writing leaves them alone.
  std::vector<png_bytep> rows = rowPointers(const_cast<ImageRgba8&>(image));
  if (!writeRows(state, image.width(), image.height(), opaque, rows.data())) {
    throw Error("PNG encoder: " + state.message);
  }
  return std::move(state.out);
}

}  // namespace saccade::core
