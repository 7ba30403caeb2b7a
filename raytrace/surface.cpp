#include "raytrace/surface.h"

#include <algorithm>
#include <cmath>

#include "core/scene/specular_albedo.h"

namespace saccade::raytrace {
namespace {

/// Also of normals, which unpack one by one.
template <class Array>
auto interpolate(const Array& v, float u, float b) {
  return v[0] * (1 - u - b) + v[1] * u + v[2] * b;
}

/// Attributes few meshes have are read from the scene's own arrays.
template <class T>
T interpolateMesh(const World& world, const Hit& hit, const std::vector<T>& values) {
  const std::uint32_t* corner =
      &world.meshOf(hit.object).indices[3 * (hit.triangle - world.firstTriangle(hit.object))];
  return values[corner[0]] * (1 - hit.u - hit.v) + values[corner[1]] * hit.u + values[corner[2]] * hit.v;
}

Vec2 textureUv(const World& world, const Hit& hit, const Vec2& uv0, const TextureView& texture) {
  if (texture.uvSet == 0) return uv0;
  const core::Mesh& mesh = world.meshOf(hit.object);
  return mesh.uv1.empty() ? uv0 : interpolateMesh(world, hit, mesh.uv1);
}

void applyTextures(const World& world, const Hit& hit, const Vec2& uv0, const CompiledMaterial& m,
                   MaterialPoint& p) {
  const auto texel = [&](const TextureView& t) { return t.sample(textureUv(world, hit, uv0, t)); };
  if (m.baseColorTexture) {
    const core::Vec4 t = texel(m.baseColorTexture);
    p.baseColor *= Vec3(t);
    p.coverage *= t.w;
  }
  if (m.metallicRoughnessTexture) {
    const core::Vec4 t = texel(m.metallicRoughnessTexture);
    p.roughness *= t.y;
    p.metallic *= t.z;
  }
  if (m.emissionTexture && m.emits()) p.emission *= Vec3(texel(m.emissionTexture));
  if (m.specularTexture || m.specularColorTexture) {
    const float specular = m.specularTexture ? texel(m.specularTexture).w : 1;
    p.dielectricF0 *= specular;
    if (m.specularColorTexture) p.dielectricF0 *= Vec3(texel(m.specularColorTexture));
    p.dielectricF90 = core::dielectricF90(p.dielectricF0, m.specular * specular);
  }
  if (m.transmissionTexture) p.transmission *= texel(m.transmissionTexture).x;
}

core::Vec4 vertexColor(const World& world, const Hit& hit) {
  return interpolateMesh(world, hit, world.meshOf(hit.object).colors);
}

float coverageOf(const CompiledMaterial& m, float alpha) {
  return m.alphaMode == core::AlphaMode::blend ? std::clamp(alpha, 0.0f, 1.0f) : 1.0f;
}

/// Fills a fresh point; its extension apart.
void evaluateMaterial(const World& world, const Hit& hit, const CompiledMaterial& m, const Vec2& uv0,
                      MaterialPoint& p) {
  p.baseColor = m.baseColor;
  p.coverage = m.alpha;
  p.emission = m.unlit ? Vec3(0) : m.emission;
  p.metallic = m.metallic;
  p.dielectricF0 = m.dielectricF0;
  p.dielectricF90 = m.dielectricF90;
  p.roughness = m.roughness;
  p.transmission = m.transmission;
  p.ior = m.ior;
  p.diffuseFactor = m.diffuseFactor;
  if (m.textured) applyTextures(world, hit, uv0, m, p);
  if (world.hasColors(hit.object)) {
    const core::Vec4 c = vertexColor(world, hit);
    p.baseColor *= Vec3(c);
    p.coverage *= c.w;
  }
  p.coverage = coverageOf(m, p.coverage);
}

/// Tangent (xyz, world) and handedness; 0 where the mesh has none.
core::Vec4 tangentAt(const World& world, const Hit& hit) {
  const core::Mesh& mesh = world.meshOf(hit.object);
  if (mesh.tangents.empty()) return core::Vec4(0);
  const core::Vec4 tangent = interpolateMesh(world, hit, mesh.tangents);
  const Instance* place = world.instanceOf(hit.object);
  return place ? place->tangent(tangent) : tangent;
}

/// Of the tangent plane under the front's normal.
Vec3 bitangent(const Vec3& ns, const core::Vec4& tangent) {
  return glm::cross(ns, Vec3(tangent)) * (tangent.w < 0 ? -1.0f : 1.0f);
}

/// Tangent-space normal, world; the interpolated one where the mesh has no tangents.
Vec3 mappedNormal(const core::Vec4& texel, float scale, const core::Vec4& tangent, const Vec3& ns) {
  if (tangent == core::Vec4(0)) return ns;
  const Vec3 local = (Vec3(texel) * 2.0f - 1.0f) * Vec3(scale, scale, 1);
  const Vec3 n = Vec3(tangent) * local.x + bitangent(ns, tangent) * local.y + ns * local.z;
  const float length = glm::length(n);
  return length > 0 && std::isfinite(length) ? n / length : ns;
}

/// Leak guard: bends ns so that it faces the eye and the mirror direction stays above the surface.
Vec3 bendNormal(const Vec3& ng, Vec3 ns, const Vec3& toEye) {
  constexpr float kLowestMirror = 0.01f;
  if (glm::dot(ns, ng) <= 0) ns = ng;
  const float lowest = std::min(0.9f * glm::dot(toEye, ng), kLowestMirror);
  const Vec3 mirror = 2 * glm::dot(ns, toEye) * ns - toEye;
  if (glm::dot(ns, toEye) > 0 && glm::dot(mirror, ng) >= lowest) return ns;
  const Vec3 lifted = glm::normalize(mirror + ng * (lowest - glm::dot(mirror, ng)));
  const Vec3 bent = toEye + lifted;
  const float length = glm::length(bent);
  return length > 1e-4f ? bent / length : ng;
}

/// The layers' parameters, with the coat's normal still on the triangle's front. `ns`: before its own map.
ExtensionPoint extensionAt(const World& world, const Hit& hit, const CompiledExtension& e, const Vec3& ns,
                           const Vec2& uv0) {
  const auto texel = [&](const TextureView& t) { return t.sample(textureUv(world, hit, uv0, t)); };
  ExtensionPoint p = evaluateExtension(e, texel);
  p.coatNormal = ns;
  const bool directed = p.anisotropy > 0 || p.ward;
  if (!directed && !e.clearcoatNormalTexture) return p;
  const core::Vec4 tangent = tangentAt(world, hit);
  if (directed) p.tangent = Vec3(tangent) * p.direction.x + bitangent(ns, tangent) * p.direction.y;
  if (e.clearcoatNormalTexture) {
    p.coatNormal = mappedNormal(texel(e.clearcoatNormalTexture), e.clearcoatNormalScale, tangent, ns);
  }
  return p;
}

Vec3 unitOr(const Vec3& v, const Vec3& fallback) {
  const float length = glm::length(v);
  return length > 0 && std::isfinite(length) ? v / length : fallback;
}

}  // namespace

void prefetchSurface(const World& world, const Hit& hit) {
  const TriangleRecord& record = world.record(hit.triangle);
  const CompiledMaterial& m = world.materialOf(hit.object);
  world.prefetch(world.mapFootprint(hit.object, hit.triangle, hit.u, hit.v, 0));
  const Vec2 uv = interpolate(record.uv0, hit.u, hit.v);
  for (const TextureView* texture : {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture}) {
    if (*texture) texture->prefetch(texture->footprint(textureUv(world, hit, uv, *texture)));
  }
}

Surface makeSurface(const World& world, const Hit& hit, const Vec3& direction) {
  const TriangleRecord& record = world.record(hit.triangle);
  const TriangleShape& shape = world.shape(hit.triangle);
  Surface s;
  s.triangle = hit.triangle;
  s.object = hit.object;
  s.offset = record.offset;
  s.material = &world.materialOf(hit.object);
  s.closed = world.closed(hit.object);
  s.position = interpolate(shape.position, hit.u, hit.v);
  s.uv0 = interpolate(record.uv0, hit.u, hit.v);
  s.barycentric = Vec2(hit.u, hit.v);
  Vec3 ns = interpolate(shape.normal, hit.u, hit.v);
  const Instance* place = world.instanceOf(hit.object);
  if (place) {
    s.position = place->point(s.position);
    s.offset = place->offset(s.offset);
    ns = place->normalToWorld * ns;
  }
  evaluateMaterial(world, hit, *s.material, s.uv0, s.point);

  s.ng = unitOr(hit.ng, -direction);
  s.ns = unitOr(ns, s.ng);
  if (const CompiledExtension* e = s.material->extension.get()) {
    s.point.extension = extensionAt(world, hit, *e, s.ns, s.uv0);
  }
  if (const TextureView& map = s.material->normalTexture) {
    s.ns = mappedNormal(map.sample(textureUv(world, hit, s.uv0, map)), s.material->normalScale,
                        tangentAt(world, hit), s.ns);
  }
  s.front = glm::dot(s.ng, direction) <= 0;
  if (!s.front) {
    s.ng = -s.ng;
    s.ns = -s.ns;
  }
  s.ns = bendNormal(s.ng, s.ns, -direction);
  if (s.point.extension) {
    Vec3& n = s.point.extension->coatNormal;
    n = bendNormal(s.ng, s.front ? n : -n, -direction);
  }
  return s;
}

Surface surfaceOn(const World& world, std::uint32_t object, std::uint32_t triangle, float u, float v,
                  bool front) {
  Hit hit;
  hit.triangle = triangle;
  hit.object = object;
  hit.u = u;
  hit.v = v;
  hit.ng = world.geometricNormal(object, triangle);
  const Vec3 n = unitOr(hit.ng, Vec3(0, 1, 0));
  return makeSurface(world, hit, front ? -n : n);
}

Vec3 mapIrradiance(const World& world, const Surface& at) {
  return world.irradiance(world.mapFootprint(at.object, at.triangle, at.barycentric.x, at.barycentric.y,
                                             at.front ? 0 : 1));
}

Vec3 smoothNormal(const World& world, std::uint32_t object, std::uint32_t triangle, float u, float v,
                  const Vec3& geometric) {
  const TriangleShape& shape = world.shape(triangle);
  Vec3 n = shape.normal[0] * (1 - u - v) + shape.normal[1] * u + shape.normal[2] * v;
  const float length = glm::length(n);
  if (!(length > 1e-6f)) return geometric;
  const Instance* place = world.instanceOf(object);
  n = place ? glm::normalize(place->normalToWorld * n) : n / length;
  // Front and back are the geometric normal's: a shading normal that leans over is bent to its side.
  const Vec3 ngFront = world.geometricNormal(object, triangle);
  return glm::dot(ngFront, geometric) >= 0 ? n : -n;
}

Vec2 emissionUv(const World& world, std::uint32_t triangle, float u, float v) {
  const TriangleRecord& record = world.record(triangle);
  Hit hit;
  hit.triangle = triangle;
  hit.object = record.object;  // meshes that emit are never instanced
  hit.u = u;
  hit.v = v;
  return textureUv(world, hit, interpolate(record.uv0, u, v),
                   world.materialOf(record.object).emissionTexture);
}

Vec3 emissionAt(const World& world, std::uint32_t triangle, float u, float v) {
  const CompiledMaterial& m = world.materialOf(world.record(triangle).object);
  if (!m.emissionTexture) return m.emission;
  return m.emission * Vec3(m.emissionTexture.sample(emissionUv(world, triangle, u, v)));
}

BaseLight baseLight(const World& world, const Hit& hit, const Vec3& direction) {
  return BaseLookup(world, hit, direction).read();
}

BaseLookup::BaseLookup(const World& world, const Hit& hit, const Vec3& direction)
    : world_(world),
      hit_(hit),
      material_(world.materialOf(hit.object)),
      front_(glm::dot(hit.ng, direction) <= 0) {
  const TriangleRecord& record = world.record(hit.triangle);
  map_ = world.mapFootprint(hit.object, hit.triangle, hit.u, hit.v, front_ ? 0 : 1);
  world.prefetch(map_);
  if (!material_.textured) return;
  uv0_ = interpolate(record.uv0, hit.u, hit.v);
  if (const TextureView& texture = material_.baseColorTexture) {
    color_ = texture.footprint(textureUv(world, hit, uv0_, texture));
    texture.prefetch(color_);
  }
}

core::Vec4 BaseLookup::texel(const TextureView& texture) const {
  return texture.sample(textureUv(world_, hit_, uv0_, texture));
}

/// baseAlbedo, with no more texels than it needs.
Vec3 BaseLookup::albedo(const Vec3& color) const {
  const CompiledMaterial& m = material_;
  float metallic = m.metallic, transmission = m.transmission;
  if (metallic > 0 && m.metallicRoughnessTexture) metallic *= texel(m.metallicRoughnessTexture).z;
  if (transmission > 0 && m.transmissionTexture) transmission *= texel(m.transmissionTexture).x;
  return color * ((1 - metallic) * (1 - transmission) * m.diffuseFactor);
}

BaseLight BaseLookup::read() const {
  const CompiledMaterial& m = material_;
  core::Vec4 color(m.baseColor, m.alpha);
  if (m.baseColorTexture) color *= m.baseColorTexture.mix(color_);
  if (world_.hasColors(hit_.object)) color *= vertexColor(world_, hit_);
  BaseLight light;
  light.coverage = coverageOf(m, color.w);
  if (!front_ && !m.scattersBehind()) return light;
  if (m.unlit) {
    light.reflected = Vec3(color);
    return light;
  }
  if (m.emits() && (front_ || m.doubleSided)) {
    light.emitted = m.emission;
    if (m.emissionTexture) light.emitted *= Vec3(texel(m.emissionTexture));
  }
  const Vec3 reflectance = albedo(Vec3(color));
  if (reflectance.x + reflectance.y + reflectance.z > 0) {
    light.reflected = reflectance * (1 / core::kPi) * world_.irradiance(map_);
  }
  return light;
}

}  // namespace saccade::raytrace
