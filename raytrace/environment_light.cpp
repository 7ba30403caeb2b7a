#include "raytrace/environment_light.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace saccade::raytrace {
namespace {

/// Sines of the colatitude below this (a fifth of an arc second from a pole) count as this.
constexpr float kLeastSine = 1e-6f;

/// Running sums divided by the last; all zero becomes uniform (such a row is never drawn).
void normalise(std::span<const double> sums, float* out) {
  const double total = sums.back();
  const auto n = static_cast<double>(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i)
    out[i] = static_cast<float>(total > 0 ? sums[i] / total : static_cast<double>(i + 1) / n);
  out[sums.size() - 1] = 1;
}

struct Drawn {
  int index;
  float place;  ///< under the tent around the interval's middle, in intervals: [-0.5, count + 0.5]
};
/// An interval of a cumulative distribution.
Drawn draw(const float* cumulative, int count, float u) {
  const float* at = std::upper_bound(cumulative, cumulative + count - 1, u);
  const float below = at == cumulative ? 0.0f : at[-1];
  const float rest = std::clamp((u - below) / (*at - below), 0.0f, 1.0f);
  const float offset = rest < 0.5f ? std::sqrt(2 * rest) - 1 : 1 - std::sqrt(2 * (1 - rest));
  const auto index = static_cast<int>(at - cumulative);
  return {index, static_cast<float>(index) + 0.5f + offset};
}

}  // namespace

EnvironmentLight::EnvironmentLight(std::shared_ptr<const core::Environment> environment)
    : environment_(std::move(environment)),
      width_(environment_->radiance.width()),
      height_(environment_->radiance.height()) {
  const auto width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  rows_.resize(height);
  columns_.resize(height * width);
  std::vector<double> sums(width), rowSums;
  for (std::size_t y = 0; y < height; ++y) {
    const double upper = M_PI * static_cast<double>(y) / height_, lower = upper + M_PI / height_;
    const double solidAngle = 2 * M_PI / width_ * (std::cos(upper) - std::cos(lower));
    solidAngle_.push_back(static_cast<float>(solidAngle));
    double sum = 0;
    for (std::size_t x = 0; x < width; ++x) {
      const Vec3& texel = environment_->radiance.pixels()[y * width + x];
      sums[x] = sum += static_cast<double>(core::luminance(texel));
    }
    normalise(sums, &columns_[y * width]);
    rowSums.push_back(total_ += sum * solidAngle);
  }
  normalise(rowSums, rows_.data());
  if (shines()) perUv_ = static_cast<float>(static_cast<double>(width * height) / (2 * M_PI * M_PI * total_));
}

float EnvironmentLight::density(const Vec2& uv) const {
  const core::EnvironmentTexels t = core::environmentTexels(*environment_, uv);
  const core::ImageRgb& image = environment_->radiance;
  const auto row = [&](int y) {
    const float left = core::luminance(image.at(t.x0, y)), right = core::luminance(image.at(t.x1, y));
    return (left * (1 - t.fx) + right * t.fx) * solidAngle_[static_cast<std::size_t>(y)];
  };
  const float weight = row(t.y0) * (1 - t.fy) + row(t.y1) * t.fy;
  return weight * perUv_ / std::max(std::sin(uv.y * core::kPi), kLeastSine);
}

EnvironmentSample EnvironmentLight::sample(const Vec2& u) const {
  const Drawn row = draw(rows_.data(), height_, u.x);
  const Drawn column = draw(&columns_[static_cast<std::size_t>(row.index) * width_], width_, u.y);
  const float v = row.place / static_cast<float>(height_), x = column.place / static_cast<float>(width_);
  // Beyond a pole the first and last rows' tents are folded back, where the interpolation holds its value.
  const Vec2 uv(x - std::floor(x), v < 0 ? -v : v > 1 ? 2 - v : v);
  EnvironmentSample s;
  s.direction = core::environmentDirection(*environment_, uv);
  s.pdf = density(uv);
  s.radiance = core::environmentRadianceAt(*environment_, uv);
  return s;
}

}  // namespace saccade::raytrace
