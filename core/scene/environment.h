// Environment maps: files to core::Environment, directions to texels. Tracer and base layer look light up by
// the one mapping stated here, bilinearly between texel centres, across the seam behind, clamped at the
// poles.
#pragma once

#include <filesystem>

#include "core/load_budget.h"
#include "core/scene/scene.h"

namespace saccade::core {

/// Largest environment that is taken, in pixels: 16384 x 8192 (1.5 GiB in memory).
inline constexpr std::int64_t kMaxEnvironmentPixels = 16384LL * 8192LL;
/// Texels above this (W/m^2/sr) are clamped to it: sums over the sphere stay finite.
inline constexpr float kLargestEnvironmentRadiance = 1e12f;

struct EnvironmentOptions {
  float rotationDegrees = 0;  ///< counter-clockwise seen from above
  float scale = 1;            ///< >= 0, multiplies every texel
};

/// Reads an equirectangular OpenEXR or Radiance .hdr image, told apart by content. Texels that are NaN or
/// negative become 0, those beyond kLargestEnvironmentRadiance are clamped; what was repaired is counted in
/// `warnings`; the pixels' bytes stay charged to `budget`. Throws core::Error naming the file and what to do,
/// UsageError for options out of range. Any thread.
Environment readEnvironment(const std::filesystem::path& file, const EnvironmentOptions& options,
                            LoadBudget& budget, Warnings& warnings);

/// Where a direction (any length but 0) falls in the picture, [0, 1]^2, v downwards. NaN gives (0, 0).
Vec2 environmentUv(const Environment& environment, const Vec3& direction);
/// The inverse: unit.
Vec3 environmentDirection(const Environment& environment, const Vec2& uv);

/// The four texels around a place in the picture and the weights of the second ones.
struct EnvironmentTexels {
  int x0, x1, y0, y1;
  float fx, fy;  ///< [0, 1]
};
EnvironmentTexels environmentTexels(const Environment& environment, const Vec2& uv);
/// Radiance at a place, W/m^2/sr. Any thread.
Vec3 environmentRadianceAt(const Environment& environment, const Vec2& uv);
/// Radiance from a direction (any length but 0), W/m^2/sr. Any thread.
inline Vec3 environmentRadiance(const Environment& environment, const Vec3& direction) {
  return environmentRadianceAt(environment, environmentUv(environment, direction));
}

}  // namespace saccade::core
