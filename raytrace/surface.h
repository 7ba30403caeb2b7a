// A hit, interpolated: what shading reads.
#pragma once

#include "raytrace/material.h"
#include "raytrace/ray.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

struct Surface {
  Vec3 position{0};
  Vec3 ng{0};  ///< geometric normal, unit, on the side the ray came from
  Vec3 ns{0};  ///< shading normal, unit, same side; bent so that mirror directions stay above the surface
  Vec2 uv0{0};
  Vec2 barycentric{0};  ///< as in Hit
  std::uint32_t triangle = 0, object = 0;
  float offset = 0;     ///< for offsetOrigin
  bool front = true;    ///< the ray came from the triangle's front
  bool closed = false;  ///< transmission is that of a solid
  const CompiledMaterial* material = nullptr;
  MaterialPoint point;

  /// A ray from here, safe against its own surface.
  Ray leave(const Vec3& direction) const {
    return {offsetOrigin(position, ng, direction, offset), direction, 0, core::kInfinity};
  }
  /// The side seen scatters light (a single-sided opaque surface is black from behind).
  bool scatters() const { return front || material->scattersBehind(); }
  /// A solid that splits light into colours.
  bool disperses() const { return closed && material->dispersion > 0; }
  /// The index that one channel of light sees (KHR_materials_dispersion).
  float iorOf(int channel) const { return dispersedIor(point.ior, material->dispersion, channel); }
  /// The side seen emits.
  Vec3 emitted() const { return front || material->doubleSided ? point.emission : Vec3(0); }
};

/// Sends for the texels that makeSurface and its light from the maps will read. Any thread.
void prefetchSurface(const World& world, const Hit& hit);

/// All of it. `direction` is the ray's, unit. Any thread.
Surface makeSurface(const World& world, const Hit& hit, const Vec3& direction);

/// The barycentric point of an object's triangle (World::record), seen from its front (or back) along its
/// normal: for map baking.
Surface surfaceOn(const World& world, std::uint32_t object, std::uint32_t triangle, float u, float v,
                  bool front);

/// What the maps hold for the side seen, W/m^2. Any thread.
Vec3 mapIrradiance(const World& world, const Surface& at);

/// The interpolated vertex normal at a hit, on the side of the unit vector `geometric`: what irradiance is
/// measured against (normal maps are left to shading).
Vec3 smoothNormal(const World& world, std::uint32_t object, std::uint32_t triangle, float u, float v,
                  const Vec3& geometric);

/// Where the emission texture is read at a triangle's barycentric point.
Vec2 emissionUv(const World& world, std::uint32_t triangle, float u, float v);
/// Radiance that the triangle emits there.
Vec3 emissionAt(const World& world, std::uint32_t triangle, float u, float v);

/// Emission + base formula (core/scene/specular_albedo.h) under the illumination maps, times coverage for
/// blend: the radiance that the base layer shows at this hit. Cheap: reads one record and its textures.
struct BaseLight {
  Vec3 reflected{0};  ///< from the maps (or baseColor for unlit)
  Vec3 emitted{0};
  float coverage = 1;  ///< both are not yet multiplied by it
};
BaseLight baseLight(const World& world, const Hit& hit, const Vec3& direction);

/// baseLight in two steps: the constructor finds the texels and sends for them, read() reads them. Between
/// the two other rays may be traced. Refers to world and hit.
class BaseLookup {
 public:
  BaseLookup(const World& world, const Hit& hit, const Vec3& direction);
  BaseLight read() const;

 private:
  Vec3 albedo(const Vec3& color) const;
  core::Vec4 texel(const TextureView& texture) const;

  const World& world_;
  const Hit& hit_;
  const CompiledMaterial& material_;
  Vec2 uv0_{0};
  bool front_ = true;
  TexelFootprint color_;  ///< of the material's base colour texture, if any
  MapFootprint map_;
};

/// Diffuse reflectance that maps and base layer use: baseColor (1 - metallic) (1 - transmission)
/// diffuseFactor.
inline Vec3 baseAlbedo(const MaterialPoint& m) {
  return m.baseColor * ((1 - m.metallic) * (1 - m.transmission) * m.diffuseFactor);
}

}  // namespace saccade::raytrace
