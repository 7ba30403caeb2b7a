#include "bench/reference/sums.h"

#include <cassert>
#include <cmath>
#include <cstring>
#include <span>

#include "core/atomic_file.h"
#include "core/content_hash.h"
#include "core/error.h"
#include "core/metrics/comparison.h"

namespace saccade::bench {
namespace {

/// The file: this, half 0, half 1 (three doubles a pixel), a ContentHash of all before. Native byte order.
struct Header {
  char magic[8] = {'S', 'A', 'C', 'S', 'U', 'M', 'S', '1'};
  std::uint64_t key = 0;
  std::int32_t width = 0, height = 0;
  std::uint64_t samplesPerHalf = 0;
  double seconds = 0;
};
static_assert(sizeof(Header) == 40 && sizeof(glm::dvec3) == 24, "no padding in the file");

std::size_t bytesOfHalf(int width, int height) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * sizeof(glm::dvec3);
}

std::uint64_t checksum(std::span<const std::uint8_t> bytes) {
  core::ContentHash hash;
  hash.add(bytes);
  return hash.value();
}

bool finite(const ReferenceSums& sums) {
  for (const auto& half : sums.halves) {
    for (const glm::dvec3& v : half) {
      if (!std::isfinite(v.x + v.y + v.z)) return false;
    }
  }
  return true;
}

}  // namespace

ReferenceSums::ReferenceSums(int imageWidth, int imageHeight) : width(imageWidth), height(imageHeight) {
  for (auto& half : halves)
    half.assign(static_cast<std::size_t>(imageWidth) * static_cast<std::size_t>(imageHeight), glm::dvec3(0));
}

void ReferenceSums::add(int half, const core::ImageRgb& mean, int samples) {
  assert(mean.pixels().size() == halves[half].size());
  for (std::size_t i = 0; i < halves[half].size(); ++i)
    halves[half][i] += glm::dvec3(mean.pixels()[i]) * static_cast<double>(samples);
}

core::ImageRgb ReferenceSums::mean() const {
  core::ImageRgb image(width, height);
  for (std::size_t i = 0; i < halves[0].size(); ++i)
    image.pixels()[i] = core::Vec3((halves[0][i] + halves[1][i]) / static_cast<double>(samplesPerPixel()));
  return image;
}

core::ImageRgb ReferenceSums::half(int which) const {
  core::ImageRgb image(width, height);
  for (std::size_t i = 0; i < halves[which].size(); ++i)
    image.pixels()[i] = core::Vec3(halves[which][i] / static_cast<double>(samplesPerHalf));
  return image;
}

double ReferenceSums::relmse() const {
  const auto n = static_cast<double>(samplesPerPixel());
  double sum = 0;
  for (std::size_t i = 0; i < halves[0].size(); ++i) {
    const glm::dvec3 mean = (halves[0][i] + halves[1][i]) / n, error = (halves[0][i] - halves[1][i]) / n;
    for (int c = 0; c < 3; ++c) sum += error[c] * error[c] / (mean[c] * mean[c] + core::kRelativeEpsilon);
  }
  return sum / (3 * static_cast<double>(halves[0].size()));
}

void writeSums(const std::filesystem::path& file, std::uint64_t key, const ReferenceSums& sums) {
  Header header;
  header.key = key;
  header.width = sums.width;
  header.height = sums.height;
  header.samplesPerHalf = sums.samplesPerHalf;
  header.seconds = sums.seconds;
  const std::size_t half = bytesOfHalf(sums.width, sums.height);
  std::vector<std::uint8_t> bytes(sizeof header + 2 * half);
  std::memcpy(bytes.data(), &header, sizeof header);
  for (int h = 0; h < 2; ++h)
    std::memcpy(bytes.data() + sizeof header + static_cast<std::size_t>(h) * half, sums.halves[h].data(),
                half);
  const std::uint64_t sum = checksum(bytes);
  const auto* tail = reinterpret_cast<const std::uint8_t*>(&sum);
  bytes.insert(bytes.end(), tail, tail + sizeof sum);
  core::writeFileAtomically(file, bytes);
}

ReferenceSums readSums(const std::filesystem::path& file, std::uint64_t key, int width, int height) {
  const auto refuse = [&](const char* why) -> core::Error {
    return core::Error(file.string() + ": not the sums of this reference: " + why);
  };
  const std::size_t half = bytesOfHalf(width, height);
  std::error_code unknown;
  if (std::filesystem::is_regular_file(file, unknown) &&
      std::filesystem::file_size(file, unknown) != sizeof(Header) + 2 * half + sizeof(std::uint64_t))
    throw refuse("its length is wrong");
  const std::vector<std::uint8_t> bytes = core::readWholeFile(file);
  if (bytes.size() != sizeof(Header) + 2 * half + sizeof(std::uint64_t)) throw refuse("its length is wrong");
  std::uint64_t stored = 0;
  const std::size_t content = bytes.size() - sizeof stored;
  std::memcpy(&stored, bytes.data() + content, sizeof stored);
  if (stored != checksum(std::span(bytes).first(content))) throw refuse("its checksum does not match");
  Header header;
  std::memcpy(&header, bytes.data(), sizeof header);
  if (std::memcmp(header.magic, Header{}.magic, sizeof header.magic) != 0)
    throw refuse("it is of another kind");
  if (header.key != key || header.width != width || header.height != height) throw refuse("its key differs");
  ReferenceSums sums(width, height);
  sums.samplesPerHalf = header.samplesPerHalf;
  sums.seconds = header.seconds;
  for (int h = 0; h < 2; ++h)
    std::memcpy(sums.halves[h].data(), bytes.data() + sizeof header + static_cast<std::size_t>(h) * half,
                half);
  if (!finite(sums) || !(sums.seconds >= 0)) throw refuse("it holds what is no number");
  return sums;
}

}  // namespace saccade::bench
