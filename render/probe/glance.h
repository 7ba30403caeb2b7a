// What a non-diffuse object is to the approximation: a few numbers in place of its material.
#pragma once

#include <optional>

#include "core/scene/scene.h"
#include "core/scene/texture_mean.h"

namespace saccade::render {

/// Textures are averaged over the object; sheen and the directions of anisotropy are left out.
struct Glance {
  bool unlit = false;
  core::MaterialMeans means;
  std::optional<core::WardLobe> ward;
  float spread = 0;      ///< of the base's lobe, radians across; 0 = a mirror
  float coatSpread = 0;  ///< likewise
  float coverage = 1;
  float diffuseFactor = 1;  ///< core::baseDiffuseFactor
  core::Vec3 transmitted{0};
  float ior = 1;  ///< of a massive solid, which bends what is behind it; 1 = seen straight through

  /// Throws nothing; `object` is one of the scene's.
  Glance(const core::Scene& scene, const core::Object& object);
  Glance() = default;
};

}  // namespace saccade::render
