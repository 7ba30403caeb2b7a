// What the layered KHR_materials extensions and Ward's lobe add to a material: few materials have them, so
// they stand apart.
#pragma once

#include <cmath>
#include <memory>
#include <optional>

#include "core/scene/scene.h"
#include "core/scene/thin_film.h"
#include "raytrace/ray.h"
#include "raytrace/texture_store.h"
#include "raytrace/ward.h"

namespace saccade::raytrace {

struct CompiledExtension {
  float clearcoat = 0, clearcoatRoughness = 0, clearcoatNormalScale = 1;
  float anisotropy = 0;
  Vec2 anisotropyDirection{1, 0};  ///< in (tangent, bitangent)
  Vec3 sheenColor{0};
  float sheenRoughness = 0;
  float iridescence = 0, iridescenceIor = 1.3f, thicknessMin = 0, thicknessMax = 0;  ///< nm
  std::optional<Ward> ward;
  TextureView clearcoatTexture, clearcoatRoughnessTexture, clearcoatNormalTexture, anisotropyTexture,
      sheenColorTexture, sheenRoughnessTexture, iridescenceTexture, iridescenceThicknessTexture;
};

/// Null for a material with none of it.
std::shared_ptr<const CompiledExtension> compileExtension(const core::Material& material,
                                                          const TextureStore& textures);

/// The same at one point.
struct ExtensionPoint {
  float clearcoat = 0;
  float clearcoatRoughness = 0;  ///< perceptual
  Vec3 coatNormal{0, 0, 1};      ///< world, unit, on the side seen
  float anisotropy = 0;          ///< strength [0, 1]
  Vec2 direction{1, 0};          ///< of anisotropy and of Ward's x, in (tangent, bitangent)
  Vec3 tangent{0};               ///< the same in the world; 0 where the mesh has no tangents
  Vec3 sheenColor{0};
  float sheenRoughness = 0;  ///< perceptual
  core::ThinFilm film;
  std::optional<Ward> ward;
};

/// `texel(view)`: the texture's value at the point. Leaves normal and tangent alone.
template <class Texel>
ExtensionPoint evaluateExtension(const CompiledExtension& e, const Texel& texel) {
  ExtensionPoint p;
  p.clearcoat = e.clearcoat;
  p.clearcoatRoughness = e.clearcoatRoughness;
  p.anisotropy = e.anisotropy;
  p.direction = e.anisotropyDirection;
  p.sheenColor = e.sheenColor;
  p.sheenRoughness = e.sheenRoughness;
  p.ward = e.ward;
  p.film = {e.iridescence, e.iridescenceIor, e.thicknessMax};
  if (e.iridescenceTexture) p.film.weight *= texel(e.iridescenceTexture).x;
  if (e.iridescenceThicknessTexture) {
    p.film.thickness =
        e.thicknessMin + (e.thicknessMax - e.thicknessMin) * texel(e.iridescenceThicknessTexture).y;
  }
  if (e.clearcoatTexture) p.clearcoat *= texel(e.clearcoatTexture).x;
  if (e.clearcoatRoughnessTexture) p.clearcoatRoughness *= texel(e.clearcoatRoughnessTexture).y;
  if (e.anisotropyTexture) {
    const core::Vec4 t = texel(e.anisotropyTexture);
    const Vec2 d = Vec2(t) * 2.0f - 1.0f, r = e.anisotropyDirection;
    p.direction = {r.x * d.x - r.y * d.y, r.y * d.x + r.x * d.y};
    p.anisotropy *= t.z;
  }
  if (e.sheenColorTexture) p.sheenColor *= Vec3(texel(e.sheenColorTexture));
  if (e.sheenRoughnessTexture) p.sheenRoughness *= texel(e.sheenRoughnessTexture).w;
  return p;
}

}  // namespace saccade::raytrace
