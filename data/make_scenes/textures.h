// Procedural surfaces. Colours are sRGB display values in [0, 1]; uv in [0, 1)^2, v downwards; patterns
// repeat seamlessly unless they say otherwise.
#pragma once

#include <cstdint>
#include <functional>

#include "core/image.h"
#include "core/math/types.h"

namespace saccade::data {

using ColorFunction = std::function<core::Vec3(core::Vec2 uv)>;
using HeightFunction = std::function<float(core::Vec2 uv)>;

/// Four samples a pixel.
core::ImageRgba8 paint(int width, int height, const ColorFunction& color);
/// Tangent-space normals (x right, y up in the image) of a height field; `strength` = height in image widths.
core::ImageRgba8 normalMap(int size, const HeightFunction& height, float strength);
/// G = roughness from the function, B = `metallic`.
core::ImageRgba8 metallicRoughnessMap(int size, float metallic, const HeightFunction& roughness);

/// Boards along u. With pieces = 0 they run through the image uncut and do not repeat along u.
struct Boards {
  int rows = 8;         ///< across v
  int pieces = 2;       ///< along u, their ends staggered from row to row
  float joint = 0.55f;  ///< brightness of the joints, 1 = invisible
};
/// `tone` is the wood's mean colour.
core::Vec3 boardColor(core::Vec2 uv, const Boards& layout, const core::Vec3& tone, std::uint32_t seed);
/// 0 in the joints, 1 on the boards, with a little grain.
float boardHeight(core::Vec2 uv, const Boards& layout, std::uint32_t seed);

/// Stone with warped veins.
core::Vec3 marbleColor(core::Vec2 uv, const core::Vec3& ground, const core::Vec3& vein, std::uint32_t seed);
/// Speckled stone: chips of three tones in a ground.
core::Vec3 terrazzoColor(core::Vec2 uv, const core::Vec3& ground, std::uint32_t seed);
/// Layered sandstone.
core::Vec3 travertineColor(core::Vec2 uv, const core::Vec3& tone, std::uint32_t seed);
/// Flat colour with faint clouds: plaster, leather, patina.
core::Vec3 mottledColor(core::Vec2 uv, const core::Vec3& tone, float contrast, std::uint32_t seed);
/// Painted glaze of a vase; `style` 0..5: bands, waves, dots, lattice, leaves, scales.
core::Vec3 glazeColor(core::Vec2 uv, int style, const core::Vec3& ground, const core::Vec3& ink);

float plasterHeight(core::Vec2 uv);
float hammeredHeight(core::Vec2 uv, int dents);
float leatherHeight(core::Vec2 uv);
float rippleHeight(core::Vec2 uv);
float carvedHeight(core::Vec2 uv, int style);  ///< picture frame mouldings; `style` 0..2

}  // namespace saccade::data
