#include "core/scene/environment.h"

#include <algorithm>
#include <cmath>

#include "core/displayed_image.h"

namespace saccade::core {
namespace {

ImageRgb readPanorama(const std::filesystem::path& file, LoadBudget& budget) {
  if (std::optional<ImageRgb> radiance = readRadiance(file, budget)) return std::move(*radiance);
  throw Error(file.string() + ": --environment takes an OpenEXR (.exr) or Radiance (.hdr) image");
}

/// Multiplies by `scale`; returns the number of texels that were not a radiance.
std::uint64_t scaleAndRepair(ImageRgb& image, float scale) {
  std::uint64_t repaired = 0;
  for (Vec3& p : image.pixels()) {
    bool bad = false;
    for (int c = 0; c < 3; ++c) {
      const float x = p[c] * scale;
      bad = bad || !(x >= 0 && x <= kLargestEnvironmentRadiance);
      p[c] = x > 0 ? std::min(x, kLargestEnvironmentRadiance) : 0.0f;  // NaN gives 0
    }
    repaired += bad;
  }
  return repaired;
}

}  // namespace

Environment readEnvironment(const std::filesystem::path& file, const EnvironmentOptions& options,
                            LoadBudget& budget, Warnings& warnings) {
  if (!(options.scale >= 0 && options.scale < kInfinity))
    throw UsageError("--environment-scale must be a number of at least 0");
  if (!std::isfinite(options.rotationDegrees))
    throw UsageError("--environment-rotation must be a number of degrees");
  Environment environment;
  environment.name = file.string();
  environment.radiance = readPanorama(file, budget);
  const int width = environment.radiance.width(), height = environment.radiance.height();
  if (std::int64_t{width} * height > kMaxEnvironmentPixels) {
    throw Error(file.string() + ": an environment of " + std::to_string(width) + " x " +
                std::to_string(height) + " pixels; at most 16384 x 8192 are taken, scale it down");
  }
  if (width != 2 * height)
    warnings.push_back(file.string() + ": an environment of " + std::to_string(width) + " x " +
                       std::to_string(height) + " pixels is not twice as wide as high: it is stretched");
  if (const std::uint64_t n = scaleAndRepair(environment.radiance, options.scale); n > 0)
    warnings.push_back(file.string() + ": " + std::to_string(n) +
                       " texels were NaN, negative or beyond 1e12 and were clamped to [0, 1e12]");
  environment.rotation = glm::radians(std::fmod(options.rotationDegrees, 360.0f));
  return environment;
}

// From the way of looking (x to the right, y up, -z ahead) the picture is unrolled by the longitude
// atan2(x, -z). atan2 for the colatitude too: acos loses half its digits at the poles.
Vec2 environmentUv(const Environment& environment, const Vec3& direction) {
  const float longitude = std::atan2(direction.x, -direction.z) + environment.rotation;
  const float colatitude =
      std::atan2(std::sqrt(direction.x * direction.x + direction.z * direction.z), direction.y);
  if (std::isnan(longitude) || std::isnan(colatitude)) return Vec2(0);
  const float turns = 0.5f + longitude / (2 * kPi);
  return {turns - std::floor(turns), colatitude / kPi};
}

Vec3 environmentDirection(const Environment& environment, const Vec2& uv) {
  const float longitude = (uv.x - 0.5f) * 2 * kPi - environment.rotation, colatitude = uv.y * kPi;
  const float sine = std::sin(colatitude);
  return {sine * std::sin(longitude), std::cos(colatitude), -sine * std::cos(longitude)};
}

EnvironmentTexels environmentTexels(const Environment& environment, const Vec2& uv) {
  const int width = environment.radiance.width(), height = environment.radiance.height();
  const float x = uv.x * static_cast<float>(width) - 0.5f;
  const float y = std::clamp(uv.y * static_cast<float>(height) - 0.5f, 0.0f, static_cast<float>(height - 1));
  const float left = std::floor(x), top = std::floor(y);
  EnvironmentTexels t;
  t.x0 = left < 0 ? width - 1 : static_cast<int>(left);
  t.x1 = t.x0 + 1 < width ? t.x0 + 1 : 0;
  t.y0 = static_cast<int>(top);
  t.y1 = std::min(t.y0 + 1, height - 1);
  t.fx = x - left;
  t.fy = y - top;
  return t;
}

Vec3 environmentRadianceAt(const Environment& environment, const Vec2& uv) {
  const ImageRgb& image = environment.radiance;
  const EnvironmentTexels t = environmentTexels(environment, uv);
  const Vec3 upper = image.at(t.x0, t.y0) * (1 - t.fx) + image.at(t.x1, t.y0) * t.fx;
  const Vec3 lower = image.at(t.x0, t.y1) * (1 - t.fx) + image.at(t.x1, t.y1) * t.fx;
  return upper * (1 - t.fy) + lower * t.fy;
}

}  // namespace saccade::core
