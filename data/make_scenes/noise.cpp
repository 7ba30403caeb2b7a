#include "data/make_scenes/noise.h"

#include <cmath>

namespace saccade::data {
namespace {

using core::Vec2;

std::uint32_t mix(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  return x ^ (x >> 16);
}

std::uint32_t wrapped(int cell, int period) {
  if (period <= 0) return static_cast<std::uint32_t>(cell);
  const int rest = cell % period;
  return static_cast<std::uint32_t>(rest < 0 ? rest + period : rest);
}

}  // namespace

float hash01(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  return static_cast<float>(mix(a ^ mix(b ^ mix(c + 0x9e3779b9U))) >> 8) * 0x1p-24f;
}

float valueNoise(Vec2 p, int period, std::uint32_t seed) {
  const Vec2 cell = glm::floor(p), f = p - cell;
  const Vec2 w = f * f * (3.f - 2.f * f);
  const int x = static_cast<int>(cell.x), y = static_cast<int>(cell.y);
  const auto at = [&](int i, int j) { return hash01(wrapped(x + i, period), wrapped(y + j, period), seed); };
  return glm::mix(glm::mix(at(0, 0), at(1, 0), w.x), glm::mix(at(0, 1), at(1, 1), w.x), w.y);
}

float fbm(Vec2 p, int octaves, int period, std::uint32_t seed) {
  float sum = 0, weight = 0.5f, total = 0;
  for (int k = 0; k < octaves; ++k) {
    sum += weight * valueNoise(p, period, seed + static_cast<std::uint32_t>(k));
    total += weight;
    weight *= 0.5f;
    p *= 2.f;
    period *= 2;
  }
  return sum / total;
}

Cells cellular(Vec2 p, int period, std::uint32_t seed) {
  const int cx = static_cast<int>(std::floor(p.x)), cy = static_cast<int>(std::floor(p.y));
  Cells best{1e9f, 1e9f, 0};
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      const std::uint32_t x = wrapped(cx + i, period), y = wrapped(cy + j, period);
      const Vec2 point = Vec2(cx + i, cy + j) + Vec2(hash01(x, y, seed), hash01(x, y, seed + 1));
      const float distance = glm::distance(p, point);
      if (distance < best.nearest) {
        best = {distance, best.nearest, mix(x * 8191U + y)};
      } else if (distance < best.second) {
        best.second = distance;
      }
    }
  return best;
}

}  // namespace saccade::data
