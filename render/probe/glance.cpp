#include "render/probe/glance.h"

#include <cmath>

namespace saccade::render {

using core::Vec3;

namespace {

/// A closed mesh that fills so much of its bounds is massive; what fills less is a vessel or a pane.
constexpr float kMassive = 0.3f;

/// Radians across that hold half of what a rough mirror sends on: a microfacet that is turned by atan(alpha),
/// the median, turns a ray by twice that, to either side.
float spreadOf(float alpha) { return 4 * std::atan(alpha); }

/// By the divergence theorem; of the object's mesh in its own space, like `box`.
float filled(const core::Mesh& mesh) {
  core::Bounds box;
  for (const Vec3& p : mesh.positions) box.add(p);
  const Vec3 from = box.center(), size = box.extent();
  double volume = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Vec3 a = mesh.positions[mesh.indices[i]] - from, b = mesh.positions[mesh.indices[i + 1]] - from,
               c = mesh.positions[mesh.indices[i + 2]] - from;
    volume += static_cast<double>(glm::dot(a, glm::cross(b, c))) / 6;
  }
  const float whole = size.x * size.y * size.z;
  return whole > 0 ? static_cast<float>(std::abs(volume)) / whole : 0;
}

}  // namespace

Glance::Glance(const core::Scene& scene, const core::Object& object) {
  const core::Material& m = scene.materials[static_cast<std::size_t>(object.material)];
  unlit = m.unlit;
  means = core::materialMeans(scene, m);
  ward = m.ward;
  // Ward's alpha is a standard deviation of slope, GGX's the median of its tangent: sqrt(2 ln 2) apart.
  constexpr float kMedianOfSlope = 1.1774f;
  spread = spreadOf(ward ? kMedianOfSlope * std::sqrt(ward->alphaX * ward->alphaY)
                         : means.roughness * means.roughness);
  coatSpread = spreadOf(means.over.coatRoughness * means.over.coatRoughness);
  coverage = m.alphaMode == core::AlphaMode::blend ? means.alpha : 1;
  diffuseFactor = core::baseDiffuseFactor(scene, m);
  transmitted = means.baseColor * ((1 - means.metallic) * means.transmission);
  const bool solid = object.closed && !m.thinWalled && means.transmission > 0;
  if (solid && m.ior > 1 && filled(scene.meshOf(object)) > kMassive) ior = m.ior;
}

}  // namespace saccade::render
