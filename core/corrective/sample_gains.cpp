#include "core/corrective/sample_gains.h"

#include <algorithm>
#include <cmath>

namespace saccade::core {

float displayedChange(const Vec3& before, const Vec3& after) {
  const auto displayed = [](const Vec3& linear) { return glm::sqrt(glm::clamp(linear, 0.0f, 1.0f)); };
  const Vec3 change = glm::abs(displayed(after) - displayed(before));
  return (change.x + change.y + change.z) / 3;
}

void SampleGains::add(std::uint32_t id, float change) {
  if (!(change >= 0)) return;  // NaN: a radiance that no display shows
  if (id >= means_.size()) means_.resize(id + std::size_t{1});
  means_[id].sum += change;
  means_[id].weight += 1;
}

void SampleGains::beginFrame() {
  for (Mean& m : means_) m.sum *= kKept, m.weight *= kKept;
}

std::vector<float> SampleGains::byId(std::size_t entries) const {
  constexpr float kFewest = 1;  // less than one whole sample: forgotten
  std::vector<float> gains(entries, 1.0f);
  for (std::size_t id = 0; id < std::min(entries, means_.size()); ++id) {
    const Mean& m = means_[id];
    if (m.weight >= kFewest) gains[id] = std::min(m.sum / m.weight + kLeast, 1.0f);
  }
  return gains;
}

}  // namespace saccade::core
