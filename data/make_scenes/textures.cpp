#include "data/make_scenes/textures.h"

#include <algorithm>
#include <cmath>

#include "data/make_scenes/noise.h"

namespace saccade::data {
namespace {

using core::ImageRgba8;
using core::kPi;
using core::Vec2;
using core::Vec3;

std::uint8_t toByte(float x) { return static_cast<std::uint8_t>(std::lround(255 * glm::clamp(x, 0.f, 1.f))); }

core::Rgba8 toRgba(const Vec3& c) { return {toByte(c.x), toByte(c.y), toByte(c.z), 255}; }

/// Which board a point lies on, and where on it: across and along in [0, 1).
struct Board {
  std::uint32_t id = 0;
  Vec2 at{0};
};
Board boardAt(Vec2 uv, const Boards& layout, std::uint32_t seed) {
  const float row = std::floor(uv.y * static_cast<float>(layout.rows));
  const auto rowId = static_cast<std::uint32_t>(row);
  const float onRow = uv.y * static_cast<float>(layout.rows) - row;
  if (layout.pieces == 0) return {rowId, {uv.x, onRow}};
  const auto pieces = static_cast<float>(layout.pieces);
  const float along = uv.x * pieces + hash01(rowId, seed, 11) * pieces, piece = std::floor(along);
  const auto pieceId = static_cast<std::uint32_t>(piece) % static_cast<std::uint32_t>(layout.pieces);
  return {rowId * 7919U + pieceId, {along - piece, onRow}};
}

}  // namespace

ImageRgba8 paint(int width, int height, const ColorFunction& color) {
  ImageRgba8 image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      Vec3 sum(0);
      for (int k = 0; k < 4; ++k) {
        const Vec2 at(static_cast<float>(x) + 0.25f + 0.5f * static_cast<float>(k % 2),
                      static_cast<float>(y) + 0.25f + 0.5f * static_cast<float>(k / 2));
        sum += glm::clamp(color(at / Vec2(width, height)), Vec3(0), Vec3(1));
      }
      image.at(x, y) = toRgba(0.25f * sum);
    }
  return image;
}

ImageRgba8 normalMap(int size, const HeightFunction& height, float strength) {
  ImageRgba8 image(size, size);
  const float step = 1 / static_cast<float>(size);
  const auto at = [&](int x, int y) {
    return height((Vec2((x + size) % size, (y + size) % size) + 0.5f) * step);
  };
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const float slope = strength * static_cast<float>(size) / 2;
      const Vec3 normal = glm::normalize(
          Vec3(-slope * (at(x + 1, y) - at(x - 1, y)), slope * (at(x, y + 1) - at(x, y - 1)), 1));
      image.at(x, y) = toRgba(0.5f * normal + 0.5f);
    }
  return image;
}

ImageRgba8 metallicRoughnessMap(int size, float metallic, const HeightFunction& roughness) {
  return paint(size, size, [&](Vec2 uv) { return Vec3(0, roughness(uv), metallic); });
}

Vec3 boardColor(Vec2 uv, const Boards& layout, const Vec3& tone, std::uint32_t seed) {
  const Board board = boardAt(uv, layout, seed);
  const float shade = 0.82f + 0.36f * hash01(board.id, seed, 1);
  const float warmth = 0.06f * (hash01(board.id, seed, 2) - 0.5f);
  // Rings cut lengthwise: noise stretched along the board, shifted from board to board.
  const Vec2 grainAt(board.at.x * 3 + 17 * hash01(board.id, seed, 3),
                     board.at.y * 7 + 31 * hash01(board.id, seed, 4));
  const float rings = std::sin(20 * fbm(grainAt * Vec2(0.5f, 0.6f), 3, 0, seed + 5));
  const float fibres = fbm(grainAt * Vec2(4, 14), 3, 0, seed + 9);
  const float grain = 1 + 0.09f * rings + 0.22f * (fibres - 0.5f);
  const float joint = glm::mix(layout.joint, 1.f, glm::smoothstep(0.2f, 0.8f, boardHeight(uv, layout, seed)));
  return tone * (shade * grain * joint) + Vec3(warmth, 0, -warmth);
}

float boardHeight(Vec2 uv, const Boards& layout, std::uint32_t seed) {
  const Board board = boardAt(uv, layout, seed);
  const float across = std::min(board.at.y, 1 - board.at.y) * 8,
              end = std::min(board.at.x, 1 - board.at.x) * 60;
  const float edge = layout.pieces == 0 ? across : std::min(across, end);
  const float fibres = fbm(Vec2(uv.x * 8, uv.y * 128), 2, 8, seed + 9);
  return glm::smoothstep(0.f, 0.35f, edge) * (0.92f + 0.08f * fibres);
}

Vec3 marbleColor(Vec2 uv, const Vec3& ground, const Vec3& vein, std::uint32_t seed) {
  const Vec2 warp(fbm(uv * 4.f, 4, 4, seed), fbm(uv * 4.f, 4, 4, seed + 20));
  const Vec2 at = uv + 0.35f * warp;
  const float clouds = fbm(uv * 3.f, 4, 3, seed + 40);
  const float ridge1 = std::abs(fbm(at * 3.f, 5, 0, seed + 60) - 0.5f) * 2;
  const float ridge2 = std::abs(fbm(at * 7.f, 4, 0, seed + 80) - 0.5f) * 2;
  // Veins fade towards the border, where the warped noise would not meet itself.
  const Vec2 inset = glm::min(uv, 1.f - uv);
  const float fade = glm::smoothstep(0.f, 0.08f, std::min(inset.x, inset.y));
  const float strength = fade * std::min(1.f, std::exp(-ridge1 * 28) + 0.4f * std::exp(-ridge2 * 30));
  return glm::mix(ground * (0.8f + 0.4f * clouds), vein, strength);
}

Vec3 terrazzoColor(Vec2 uv, const Vec3& ground, std::uint32_t seed) {
  const Cells chips = cellular(uv * 14.f, 14, seed);
  const float pick = hash01(chips.id, seed, 3);
  const bool isChip = chips.second - chips.nearest > 0.12f + 0.3f * hash01(chips.id, seed, 4);
  const Vec3 tones[3] = {ground * 0.55f, ground * 1.25f + 0.08f, ground * Vec3(1.1f, 0.82f, 0.68f)};
  const float speckle = 0.92f + 0.16f * valueNoise(uv * 128.f, 128, seed + 7);
  return (isChip ? tones[static_cast<int>(pick * 3)] : ground) * speckle;
}

Vec3 travertineColor(Vec2 uv, const Vec3& tone, std::uint32_t seed) {
  const float bend = 0.12f * fbm(uv * 4.f, 3, 4, seed);
  const float layers = fbm(Vec2(uv.x * 2, (uv.y + bend) * 16), 4, 2, seed + 10);
  const float pores = glm::smoothstep(0.70f, 0.78f, fbm(Vec2(uv.x * 12, uv.y * 48), 2, 12, seed + 30));
  return tone * (0.84f + 0.3f * layers) * (1 - 0.3f * pores);
}

Vec3 mottledColor(Vec2 uv, const Vec3& tone, float contrast, std::uint32_t seed) {
  return tone * (1 + contrast * (fbm(uv * 6.f, 5, 6, seed) - 0.5f) * 2.f);
}

Vec3 glazeColor(Vec2 uv, int style, const Vec3& ground, const Vec3& ink) {
  const float u = uv.x, v = uv.y;
  float pattern = 0;
  switch (style) {
    case 0:
      pattern = std::sin(v * 40) * std::sin(v * 13) > 0.35f ? 1.f : 0.f;
      break;
    case 1:
      pattern = std::abs(std::sin(2 * kPi * (v * 7 + 0.09f * std::sin(2 * kPi * u * 8)))) < 0.3f ? 1.f : 0.f;
      break;
    case 2:
      pattern = glm::length(glm::fract(Vec2(u * 16, v * 9)) - 0.5f) < 0.27f ? 1.f : 0.f;
      break;
    case 3: {
      const Vec2 diamond = glm::abs(glm::fract(Vec2(u * 12 + v * 8, u * 12 - v * 8)) - 0.5f);
      pattern = std::max(diamond.x, diamond.y) > 0.42f || diamond.x + diamond.y < 0.2f ? 1.f : 0.f;
      break;
    }
    case 4: {
      const Vec2 leaf = glm::fract(Vec2(u * 10 + 0.5f * std::floor(v * 6), v * 6)) - 0.5f;
      pattern = std::abs(leaf.x) < 0.32f * std::cos(leaf.y * 3) && std::abs(leaf.x) > 0.03f ? 1.f : 0.f;
      break;
    }
    default: {
      const Vec2 scale = glm::fract(Vec2(u * 14 + 0.5f * std::floor(v * 9), v * 9)) - Vec2(0.5f, 0);
      pattern = std::abs(glm::length(scale) - 0.5f) < 0.09f ? 1.f : 0.f;
    }
  }
  const bool rim = v < 0.04f || v > 0.97f || std::abs(v - 0.12f) < 0.008f || std::abs(v - 0.88f) < 0.008f;
  const float firing = 0.93f + 0.14f * fbm(uv * 8.f, 3, 8, 77);
  return glm::mix(ground, ink, rim ? 1.f : 0.9f * pattern) * firing;
}

float plasterHeight(Vec2 uv) { return fbm(uv * 12.f, 5, 12, 501); }

float hammeredHeight(Vec2 uv, int dents) {
  const float d = cellular(uv * static_cast<float>(dents), dents, 601).nearest;
  return std::min(1.f, d * d * 1.6f);
}

float leatherHeight(Vec2 uv) {
  const Cells cells = cellular(uv * 20.f, 20, 701);
  return glm::smoothstep(0.f, 0.35f, cells.second - cells.nearest);
}

float rippleHeight(Vec2 uv) {
  return 0.5f + 0.25f * std::sin(2 * kPi * (3 * uv.x + uv.y)) +
         0.25f * std::sin(2 * kPi * (2 * uv.y - 2 * uv.x)) + 0.2f * fbm(uv * 5.f, 3, 5, 801);
}

float carvedHeight(Vec2 uv, int style) {
  const float u = 2 * kPi * uv.x, v = 2 * kPi * uv.y;
  switch (style) {
    case 0:
      return 0.5f + 0.5f * std::sin(4 * u) * std::sin(v);  // beads
    case 1:
      return 0.5f + 0.5f * std::sin(3 * u + 2 * std::sin(v)) * (0.5f - 0.5f * std::cos(v));  // rope
    default:
      return std::pow(std::abs(std::sin(2 * u + std::cos(v))), 0.6f) * (0.5f - 0.5f * std::cos(v));  // leaves
  }
}

}  // namespace saccade::data
