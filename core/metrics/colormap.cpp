#include "core/metrics/colormap.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace saccade::core {
namespace {

std::uint8_t toByte(float value) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0f, 1.0f)));
}

/// Hue in turns, the rest in [0, 1].
Rgba8 fromHsv(float hue, float saturation, float value) {
  const auto channel = [&](float offset) {
    const float turn = hue + offset - std::floor(hue + offset);
    const float ramp = std::clamp(std::abs(6 * turn - 3) - 1, 0.0f, 1.0f);
    return toByte(value * (1 - saturation * (1 - ramp)));
  };
  return {channel(0), channel(2 / 3.0f), channel(1 / 3.0f), 255};
}

}  // namespace

Rgba8 rampColor(float value) {
  static constexpr std::array<Vec3, 9> kKeys{{{0, 0, 4},
                                              {28, 16, 68},
                                              {79, 18, 123},
                                              {129, 37, 129},
                                              {181, 54, 122},
                                              {229, 80, 100},
                                              {251, 135, 97},
                                              {254, 194, 135},
                                              {252, 253, 191}}};
  const float place = (value > 0 ? std::min(value, 1.0f) : 0.0f) * (kKeys.size() - 1);
  const auto below = std::min<std::size_t>(static_cast<std::size_t>(place), kKeys.size() - 2);
  const Vec3 color = glm::mix(kKeys[below], kKeys[below + 1], place - static_cast<float>(below)) / 255.0f;
  return {toByte(color.x), toByte(color.y), toByte(color.z), 255};
}

ImageRgba8 rampPicture(const ImageGray& map) {
  ImageRgba8 picture(map.width(), map.height());
  for (std::size_t i = 0; i < map.pixels().size(); ++i) picture.pixels()[i] = rampColor(map.pixels()[i]);
  return picture;
}

Rgba8 paletteColor(std::uint32_t id) {
  if (id == 0) return {0, 0, 0, 255};
  // Hue steps by the golden ratio, which keeps any run of neighbours apart; brightness and saturation step by
  // the two numbers that do the same in the plane.
  const double step = id - 1;
  const auto fraction = [](double v) { return static_cast<float>(v - std::floor(v)); };
  return fromHsv(fraction(step * 0.6180339887498949),
                 0.55f + 0.4f * fraction(0.9 + step * 0.7548776662466927),
                 0.6f + 0.4f * fraction(0.9 + step * 0.5698402909980532));
}

}  // namespace saccade::core
