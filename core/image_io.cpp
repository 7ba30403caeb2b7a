#include "core/image_io.h"

#include <cmath>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/image_codecs.h"
#include "core/srgb8.h"

namespace saccade::core {

void codecs::checkDimensions(std::int64_t width, std::int64_t height, const std::string& name) {
  // Each side alone first, so that the product cannot overflow.
  if (width <= 0 || height <= 0 || width > kMaxImagePixels || height > kMaxImagePixels / width) {
    throw Error(name + ": image of " + std::to_string(width) + " x " + std::to_string(height) +
                " pixels; between 1 and " + std::to_string(kMaxImagePixels) + " pixels are supported");
  }
}

std::string imageType(std::span<const std::uint8_t> bytes) {
  return codecs::isPng(bytes) ? "image/png" : codecs::isJpeg(bytes) ? "image/jpeg" : "";
}

void checkImageHeader(std::span<const std::uint8_t> bytes, const std::string& name) {
  if (codecs::isPng(bytes)) return codecs::checkPngHeader(bytes, name);
  if (codecs::isJpeg(bytes)) return codecs::checkJpegHeader(bytes, name);
  throw Error(name + ": neither a PNG nor a JPEG image");
}

ImageRgba8 decodeImage(std::span<const std::uint8_t> bytes, const std::string& name, LoadBudget& budget) {
  if (codecs::isPng(bytes)) return codecs::decodePng(bytes, name, budget);
  if (codecs::isJpeg(bytes)) return codecs::decodeJpeg(bytes, name, budget);
  throw Error(name + ": neither a PNG nor a JPEG image");
}

ImageRgba8 decodeImage(std::span<const std::uint8_t> bytes, const std::string& name) {
  LoadBudget budget(LoadLimits{}, name);
  return decodeImage(bytes, name, budget);
}

ImageRgba8 readImage8(const std::filesystem::path& file) {
  return decodeImage(readWholeFile(file), file.string());
}

void writePng(const std::filesystem::path& file, const ImageRgba8& image) {
  writeFileAtomically(file, encodePng(image));
}

ImageRgba8 toDisplay(const ImageRgb& linear, float exposureEv) {
  const Srgb8& encode = Srgb8::table();
  const float scale = std::exp2(exposureEv);
  ImageRgba8 display(linear.width(), linear.height());
  for (std::size_t i = 0; i < linear.pixels().size(); ++i) {
    const Vec3 c = linear.pixels()[i] * scale;
    display.pixels()[i] = {encode(c.x), encode(c.y), encode(c.z), 255};
  }
  return display;
}

}  // namespace saccade::core
