// Which lamps a scene has: groups of emissive triangles, punctual lights, and the tree over many.
#include <algorithm>
#include <cmath>

#include "core/scene/texture_mean.h"
#include "raytrace/lights.h"
#include "raytrace/surface.h"
#include "raytrace/world.h"

namespace saccade::raytrace {
namespace {

/// Sides of a triangle's grid of parts: about a texel each, within these bounds.
constexpr int kFewestParts = 4, kMostParts = 64;

int partsOf(const TextureView& texture, const Vec2 (&uv)[3]) {
  const Vec2 texels(static_cast<float>(texture.width), static_cast<float>(texture.height));
  float longest = 0;
  for (int k = 0; k < 3; ++k) {
    const Vec2 edge = (texture.place(uv[(k + 1) % 3]) - texture.place(uv[k])) * texels;
    longest = std::max({longest, std::fabs(edge.x), std::fabs(edge.y)});
  }
  return longest < kMostParts ? std::max(kFewestParts, static_cast<int>(std::ceil(longest))) : kMostParts;
}

/// Mean emission over a triangle, from the centroids of equal parts. A triangle that spans more texels than
/// there are parts may have missed a bright patch: it counts as a little brighter than black, so that it is a
/// lamp.
Vec3 meanEmission(const World& world, std::uint32_t triangle, const Vec3& textureMean) {
  const TriangleRecord& r = world.record(triangle);
  const CompiledMaterial& m = world.materialOf(r.object);
  if (!m.emissionTexture) return m.emission;
  const Vec2 uv[3] = {emissionUv(world, triangle, 0, 0), emissionUv(world, triangle, 1, 0),
                      emissionUv(world, triangle, 0, 1)};
  const int parts = partsOf(m.emissionTexture, uv);
  Vec3 sum(0);
  const auto add = [&](int i, int j, float inside) {
    const float u = (static_cast<float>(i) + inside) / static_cast<float>(parts),
                v = (static_cast<float>(j) + inside) / static_cast<float>(parts);
    sum += Vec3(m.emissionTexture.sample(uv[0] * (1 - u - v) + uv[1] * u + uv[2] * v));
  };
  for (int i = 0; i < parts; ++i) {
    for (int j = 0; j < parts - i; ++j) {
      add(i, j, 1 / 3.0f);
      if (i + j < parts - 1) add(i, j, 2 / 3.0f);
    }
  }
  const auto count = static_cast<float>(parts * parts);
  if (parts == kMostParts) sum = glm::max(sum, textureMean);  // as if one part showed the mean
  return m.emission * sum / count;
}

}  // namespace

void Lights::addEmissive(const core::Scene& scene) {
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    const CompiledMaterial& m = world_.materialOf(o);
    if (!m.emits()) continue;
    const core::TextureSlot& slot =
        scene.materials[static_cast<std::size_t>(scene.objects[o].material)].emissionTexture;
    const Vec3 textureMean =
        slot ? Vec3(core::textureMean(scene.textures[static_cast<std::size_t>(slot.texture)])) : Vec3(1);
    Group group;
    group.first = static_cast<std::uint32_t>(emissive_.size());
    std::vector<double> powers;
    core::Bounds bounds;
    for (std::uint32_t t = world_.firstTriangle(o); t < world_.firstTriangle(o) + world_.triangleCountOf(o);
         ++t) {
      const TriangleShape& s = world_.shape(t);
      const Vec3 cross = glm::cross(s.position[1] - s.position[0], s.position[2] - s.position[0]);
      const float area = 0.5f * glm::length(cross);
      if (!(area > 0) || !std::isfinite(area)) continue;
      const double sides = m.doubleSided ? 2 : 1;
      const double power = sides * core::kPi * area * core::luminance(meanEmission(world_, t, textureMean));
      if (!(power > 0) || !std::isfinite(power)) continue;
      emissive_.push_back(
          {t, static_cast<std::uint32_t>(groups_.size()), area, 0, cross / (2 * area), m.doubleSided});
      powers.push_back(power);
      for (const Vec3& p : s.position) bounds.add(p);
    }
    if (powers.empty()) continue;
    group.count = static_cast<std::uint32_t>(powers.size());
    group.center = bounds.center();
    group.radius = 0.5f * bounds.diagonal();
    group.triangles = AliasTable(powers);
    group.power = static_cast<float>(group.triangles.total());
    bool flat = !m.doubleSided;
    const Vec3 normal = emissive_[group.first].normal;
    for (std::uint32_t i = 0; i < group.count; ++i) {
      Emissive& e = emissive_[group.first + i];
      e.choiceInGroup = group.triangles.probability(i);
      for (const Vec3& p : world_.shape(e.triangle).position) {
        flat = flat && std::fabs(glm::dot(p - group.center, normal)) <= 1e-4f * group.radius &&
               glm::dot(e.normal, normal) > 0;
      }
    }
    if (flat) group.normal = normal;
    groups_.push_back(std::move(group));
  }
}

void Lights::addPunctual(const core::Scene& scene) {
  const float sceneRadius = 0.5f * scene.bounds.diagonal();
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const core::PunctualLight& light = scene.lights[i];
    Group group;
    group.punctual = static_cast<std::int32_t>(i);
    group.center = light.position;
    const float strength = core::luminance(light.intensity);
    switch (light.type) {
      case core::PunctualLight::Type::point:
        group.power = 4 * core::kPi * strength;
        break;
      case core::PunctualLight::Type::spot:
        group.power = 2 * core::kPi * (1 - light.cosOuter) * strength;
        break;
      case core::PunctualLight::Type::directional:
        group.power = core::kPi * sceneRadius * sceneRadius * strength;
        break;
    }
    if (!(group.power > 0) || !std::isfinite(group.power)) continue;
    groups_.push_back(std::move(group));
    hasPunctual_ = true;
  }
}

/// Lamps of the tree: the emissive triangles, then the points and spots. Directional lights are nowhere: they
/// are drawn beside it.
void Lights::buildTree() {
  std::vector<LightBounds> lamps;
  for (const Emissive& e : emissive_) {
    LightBounds b;
    for (const Vec3& p : world_.shape(e.triangle).position) b.box.add(p);
    b.axis = e.normal;
    b.spread = e.doubleSided ? core::kPi : 0;
    b.emission = core::kPi / 2;
    b.power = groups_[e.group].power * e.choiceInGroup / (e.doubleSided ? 2 : 1);
    lamps.push_back(b);
  }
  std::vector<double> parallel;
  for (std::uint32_t g = 0; g < groups_.size(); ++g) {
    if (groups_[g].punctual < 0) continue;
    const core::PunctualLight& light = scene_.lights[groups_[g].punctual];
    const float strength = core::luminance(light.intensity);
    if (light.type == core::PunctualLight::Type::directional) {
      parallelGroups_.push_back(g);
      parallel.push_back(strength);
      continue;
    }
    const bool spot = light.type == core::PunctualLight::Type::spot;
    LightBounds b;
    b.box.add(light.position);
    b.axis = light.direction;
    b.spread = spot ? 0 : core::kPi;
    b.emission = spot ? std::acos(light.cosOuter) : core::kPi;
    b.power = core::kPi * strength;
    lamps.push_back(b);
    treeGroups_.push_back(g);
  }
  tree_ = LightTree(lamps);
  parallelTable_ = AliasTable(parallel);
}

}  // namespace saccade::raytrace
