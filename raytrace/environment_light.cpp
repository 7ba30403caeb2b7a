#include "raytrace/environment_light.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace saccade::raytrace {
namespace {

/// Sums to the running sums divided by the last; an empty distribution becomes uniform (it is never chosen).
void normalise(std::span<double> sums, float* out) {
  const double total = sums.back();
  const auto n = static_cast<double>(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i)
    out[i] = static_cast<float>(total > 0 ? sums[i] / total : static_cast<double>(i + 1) / n);
  out[sums.size() - 1] = 1;
}

/// The interval of a cumulative distribution that holds u, and where in it u lies.
struct Drawn {
  int index;
  float place;  ///< [0, 1]
};
Drawn draw(const float* cumulative, int count, float u) {
  const float* at = std::upper_bound(cumulative, cumulative + count - 1, u);
  const float below = at == cumulative ? 0.0f : at[-1];
  return {static_cast<int>(at - cumulative), std::clamp((u - below) / (*at - below), 0.0f, 1.0f)};
}

float share(const float* cumulative, int i) { return cumulative[i] - (i > 0 ? cumulative[i - 1] : 0.0f); }

}  // namespace

EnvironmentLight::EnvironmentLight(std::shared_ptr<const core::Environment> environment)
    : environment_(std::move(environment)),
      width_(environment_->radiance.width()),
      height_(environment_->radiance.height()) {
  const core::ImageRgb& image = environment_->radiance;
  rows_.resize(static_cast<std::size_t>(height_));
  columns_.resize(rows_.size() * static_cast<std::size_t>(width_));
  for (int y = 0; y <= height_; ++y) cosines_.push_back(std::cos(M_PI * y / static_cast<double>(height_)));

  // The mean of the interpolation over a texel takes 1/8, 6/8, 1/8 of the texels before, at and behind it.
  std::vector<double> across(rows_.size() ? static_cast<std::size_t>(width_) : 0), sums(across.size());
  std::vector<double> rowSums;
  const auto filtered = [](double before, double at, double after) { return (before + 6 * at + after) / 8; };
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const auto texel = [&](int row) {
        return static_cast<double>(core::luminance(image.at(x, std::clamp(row, 0, height_ - 1))));
      };
      across[static_cast<std::size_t>(x)] = filtered(texel(y - 1), texel(y), texel(y + 1));
    }
    double sum = 0;
    for (std::size_t x = 0; x < across.size(); ++x)
      sums[x] = sum += filtered(across[x > 0 ? x - 1 : across.size() - 1], across[x],
                                across[x + 1 < across.size() ? x + 1 : 0]);
    normalise(sums, &columns_[static_cast<std::size_t>(y) * width_]);
    total_ += sum * solidAngle(y);
    rowSums.push_back(total_);
  }
  normalise(rowSums, rows_.data());
}

float EnvironmentLight::density(int x, int y) const {
  return share(rows_.data(), y) * share(row(y), x) / static_cast<float>(solidAngle(y));
}

EnvironmentSample EnvironmentLight::sample(const Vec2& u) const {
  const Drawn y = draw(rows_.data(), height_, u.x);
  const Drawn x = draw(row(y.index), width_, u.y);
  // In double: a float's cosine knows nothing of the last fraction of a degree before a pole.
  const double place = y.place, cosine = cosines_[y.index] * (1 - place) + cosines_[y.index + 1] * place;
  const Vec2 uv((static_cast<float>(x.index) + x.place) / static_cast<float>(width_),
                static_cast<float>(std::acos(cosine) / M_PI));
  EnvironmentSample s;
  s.direction = core::environmentDirection(*environment_, uv);
  s.radiance = radiance(s.direction);
  s.pdf = density(x.index, y.index);
  return s;
}

float EnvironmentLight::pdf(const Vec3& direction) const {
  const Vec2 uv = core::environmentUv(*environment_, direction);
  const int x = std::min(static_cast<int>(uv.x * static_cast<float>(width_)), width_ - 1);
  return density(x, std::min(static_cast<int>(uv.y * static_cast<float>(height_)), height_ - 1));
}

}  // namespace saccade::raytrace
