// Lights: emissive triangles grouped by object, punctual lights, and the environment. Importance sampling in
// steps (Haber 2001, section 4.3: "importance sampling for area light sources"): the environment or the rest
// by estimated irradiance; of few lights a group by its estimated contribution at the point, then a triangle
// by power; of many a triangle (or punctual light) by a light tree; then a point by area.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/scene/scene.h"
#include "raytrace/alias_table.h"
#include "raytrace/emission_aim.h"
#include "raytrace/environment_light.h"
#include "raytrace/light_tree.h"
#include "raytrace/ray.h"

namespace saccade::raytrace {

class World;

struct LightSample {
  Vec3 direction{0};   ///< unit, towards the light
  float distance = 0;  ///< shadow rays end before it: see shadowRay; infinite for the environment
  Vec3 radiance{0};    ///< delta: already divided by distance squared (irradiance at normal incidence)
  float pdf = 0;       ///< per solid angle; for a delta light the probability of choosing it
  bool delta = false;
};

/// A photon's start. Any thread.
struct EmissionSample {
  Vec3 origin{0};
  Vec3 normal{0};  ///< of the emitter, 0 for punctual lights and the environment
  Vec3 direction{0, -1, 0};
  Vec3 flux{0};  ///< watts this photon stands for when one photon is emitted: divide by the number of photons
  float offset = 0;  ///< for offsetOrigin; 0 for punctual lights
  float range = 0;   ///< metres, of a point or spot light; 0 = unlimited: see rangeFactor
};

/// glTF's spot falloff, [0, 1]; 1 for other lights.
float spotFactor(const core::PunctualLight& light, float cosAxis);

/// What KHR_lights_punctual's range leaves of a point or spot light's inverse square at a distance: its
/// recommended window, [0, 1]; 1 where range is 0.
float rangeFactor(float range, float distance);

/// Group weights at one point, kept for the pdf of rays that leave it.
struct LightChoice {
  static constexpr int kFewGroups = 16;
  Vec3 point{0};
  float cumulative[kFewGroups] = {};  ///< not with the tree
  float environment = 0;              ///< probability of sampling the environment instead of the groups
  float parallel = 0;                 ///< with the tree: probability of a directional light instead of it
  bool byTree = false;
};

class Lights {
 public:
  static constexpr int kFewGroups = LightChoice::kFewGroups;
  /// More emissive triangles than these, or more groups than kFewGroups, are chosen by the tree.
  static constexpr std::size_t kFewTriangles = 1024;

  /// `world`'s records must be filled; sets their `light` through the span of indices returned by lightOf().
  Lights(const core::Scene& scene, const World& world);

  bool empty() const { return groups_.empty() && !environment_; }
  bool hasPunctual() const { return hasPunctual_; }
  /// Emissive triangles, the order of TriangleRecord::light.
  std::size_t emissiveCount() const { return emissive_.size(); }
  std::uint32_t emissiveTriangle(std::size_t i) const { return emissive_[i].triangle; }
  /// Luminance of the mean radiance of the i-th, > 0.
  float meanRadiance(std::size_t i) const;
  double totalPower() const { return emissionTable_.total(); }  ///< watts, luminance-weighted
  /// Null where the scene has none or a black one.
  const EnvironmentLight* environment() const { return environment_.get(); }

  bool byTree() const { return !tree_.empty() || !parallelGroups_.empty(); }
  LightChoice choose(const Vec3& point) const;
  /// False when the sample carries no light (behind, grazing, no area).
  bool sample(const LightChoice& choice, float uLight, const Vec2& u, LightSample& out) const;
  /// Density per solid angle with which sample() would have made a ray that hit this world triangle at
  /// distance t with unit direction. 0 for triangles that are no light or face away.
  float pdf(const LightChoice& choice, std::uint32_t triangle, const Vec3& direction, float t) const;
  /// The way to one of the scene's punctual lights; leaves out.pdf alone. False where it does not shine.
  bool samplePunctual(std::size_t light, const Vec3& point, LightSample& out) const;
  /// The same for a ray that left the scene: only where there is an environment.
  float environmentPdf(const LightChoice& choice, const Vec3& direction) const {
    return choice.environment * environment_->pdf(direction);
  }

  /// `aim`: null, or where some are to start instead, with the weights that keep the mean; `chance` is its.
  EmissionSample sampleEmission(float uLight, const Vec2& uPosition, const Vec2& uDirection,
                                const EmissionAim* aim = nullptr,
                                const EmissionAim::Chance& chance = {}) const;

 private:
  struct Emissive {
    std::uint32_t triangle;
    std::uint32_t group;
    float area;
    float choiceInGroup;  ///< probability
    Vec3 normal;          ///< unit
    bool doubleSided;
  };
  struct Group {
    std::uint32_t first = 0, count = 0;  ///< emissive triangles; count 0 = punctual
    std::int32_t punctual = -1;
    Vec3 center{0};
    float radius = 0;
    float power = 0;
    Vec3 normal{0};  ///< common normal when flat and single-sided, else 0
    AliasTable triangles;
  };
  struct Aiming {
    const EmissionAim* aim;  ///< null: plain emission
    const EmissionAim::Chance& chance;
  };
  void addEmissive(const core::Scene& scene);
  void addPunctual(const core::Scene& scene);
  void addEnvironment(const core::Scene& scene);
  float estimate(const Group& group, const Vec3& point) const;
  bool sampleEnvironment(const Vec2& u, LightSample& out) const;
  float groupProbability(const LightChoice& choice, std::uint32_t group) const;
  void buildTree();
  bool sampleByGroup(const LightChoice& choice, float uLight, const Vec2& u, LightSample& out) const;
  bool sampleByTree(const LightChoice& choice, float uLight, const Vec2& u, LightSample& out) const;
  /// `choice`: the probability with which this triangle was drawn.
  bool sampleTriangle(const Emissive& e, float choice, const Vec3& point, const Vec2& u,
                      LightSample& out) const;
  float environmentShare(float others) const;
  // `probability`: with which it came to be asked; the flux is divided by it.
  EmissionSample emitFromTriangle(const Group& group, float probability, float uTriangle,
                                  const Vec2& uPosition, const Vec2& uDirection, const Aiming& aiming) const;
  EmissionSample emitFromPunctual(const Group& group, float probability, const Vec2& uPosition,
                                  const Vec2& uDirection, const Aiming& aiming) const;
  EmissionSample emitFromAfar(const Vec3& direction, const Vec3& irradiance, float probability,
                              const Vec2& uPosition, const Aiming& aiming) const;

  const core::Scene& scene_;
  const World& world_;
  std::vector<Emissive> emissive_;
  std::vector<Group> groups_;
  bool hasPunctual_ = false;
  LightTree tree_;                             ///< where there are many
  std::vector<std::uint32_t> treeGroups_;      ///< groups of the tree's lamps behind the emissive triangles
  std::vector<std::uint32_t> parallelGroups_;  ///< with the tree: directional lights
  AliasTable parallelTable_;                   ///< of those, by irradiance
  std::unique_ptr<EnvironmentLight> environment_;  ///< null: none that shines
  AliasTable emissionTable_;                       ///< by power; after the groups the environment
};

/// Barycentric u, v of a point that is uniform over a triangle.
inline Vec2 uniformTriangle(const Vec2& u) {
  const float root = std::sqrt(u.x);
  return {1 - root, u.y * root};
}

/// The shadow ray from a surface point to a light sample; it ends before the light.
struct Surface;
Ray shadowRay(const Surface& from, const LightSample& light);
/// The same from where the ray starts, safe against its own surface; the light as it is seen from there.
Ray shadowRay(const Vec3& origin, const LightSample& light);

}  // namespace saccade::raytrace
