#include "core/displayed_image.h"

#include <array>
#include <fstream>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/hdr_file.h"
#include "core/image_io.h"

namespace saccade::core {

std::optional<ImageRgb> readRadiance(const std::filesystem::path& file, LoadBudget& budget) {
  std::error_code failed;
  if (!std::filesystem::exists(file, failed)) throw Error(file.string() + ": no such file");
  if (!std::filesystem::is_regular_file(file, failed)) throw Error(file.string() + ": not a regular file");
  std::array<char, 4> head{};
  std::ifstream(file, std::ios::binary).read(head.data(), head.size());
  if (head == std::array<char, 4>{0x76, 0x2f, 0x31, 0x01}) return readExr(file, budget);
  if (head[0] == '#' && head[1] == '?') {
    const std::vector<std::uint8_t> bytes = readWholeFile(file, budget);
    ImageRgb image = decodeHdr(bytes, file.string(), budget);
    budget.release(bytes.size());
    return image;
  }
  return std::nullopt;
}

ImageRgba8 readDisplayed(const std::filesystem::path& file) {
  LoadBudget budget(LoadLimits{}, file.string());
  if (const std::optional<ImageRgb> radiance = readRadiance(file, budget)) return toDisplay(*radiance, 0);
  const std::vector<std::uint8_t> bytes = readWholeFile(file, budget);
  if (imageType(bytes).empty())
    throw Error(file.string() + ": no image that can be read; PNG, JPEG, OpenEXR and Radiance .hdr can");
  return decodeImage(bytes, file.string(), budget);
}

}  // namespace saccade::core
