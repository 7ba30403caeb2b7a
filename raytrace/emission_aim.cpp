#include "raytrace/emission_aim.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/scene/instances.h"
#include "core/scene/plan.h"
#include "core/scene/texture_mean.h"
#include "raytrace/microfacet.h"
#include "raytrace/world.h"

namespace saccade::raytrace {
namespace {

/// Around a mesh's vertices, in its own space.
EmissionAim::Target sphereAround(const core::Mesh& mesh) {
  core::Bounds bounds;
  for (const std::uint32_t i : mesh.indices) bounds.add(mesh.positions[i]);
  EmissionAim::Target sphere;
  sphere.center = bounds.center();
  for (const std::uint32_t i : mesh.indices)
    sphere.radius = std::max(sphere.radius, glm::distance(mesh.positions[i], sphere.center));
  return sphere;
}

/// Exact where meshToWorld is a rotation and scale alone; else a little may stand out, which plain emission
/// finds.
EmissionAim::Target placed(const EmissionAim::Target& sphere, const core::Mat4& meshToWorld) {
  const core::Mat3 linear(meshToWorld);
  const float scale = std::max({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
  return {Vec3(meshToWorld * core::Vec4(sphere.center, 1)), sphere.radius * scale, 0};
}

/// The mean silhouette of a surface seen from all around is a quarter of its area (Cauchy), as far as it does
/// not hide itself.
float fillOf(const EmissionAim::Target& sphere, double area) {
  const double view = 4 * M_PI * sphere.radius * sphere.radius;
  return static_cast<float>(std::min(1.0, area / view));
}

/// How much the caustics of a material matter: bright ones with sharp borders are what widening windows of
/// density estimation cannot make up for.
float concentration(const core::Scene& scene, const core::Material& material) {
  if (material.unlit) return 0;
  const core::MaterialMeans means = core::materialMeans(scene, material);
  const float through =
      material.alphaMode == core::AlphaMode::blend ? 1 - std::clamp(means.alpha, 0.0f, 1.0f) : 0.0f;
  const float reflected = core::nonDiffuseAlbedo(scene, material) - through;
  const float sharp = std::max(0.0f, reflected) * (1 - std::clamp(means.roughness, 0.0f, 1.0f));
  return sharp * sharp;
}

std::vector<EmissionAim::Target> targetsOf(const World& world) {
  const core::Scene& scene = world.scene();
  std::vector<float> weights;
  for (const core::Material& m : scene.materials) weights.push_back(concentration(scene, m));
  std::vector<EmissionAim::Target> spheres(scene.meshes.size());  // radius 0: not asked for yet
  std::vector<EmissionAim::Target> targets;
  for (const core::Object& object : scene.objects) {
    const float weight = weights[static_cast<std::size_t>(object.material)];
    if (!(weight > 0)) continue;
    EmissionAim::Target& sphere = spheres[object.mesh];
    if (!(sphere.radius > 0)) sphere = sphereAround(scene.meshOf(object));
    EmissionAim::Target target = placed(sphere, object.meshToWorld);
    target.weight = weight * fillOf(target, core::surfaceArea(scene, object));
    if (target.radius > 0 && target.weight > 0 && std::isfinite(target.radius)) targets.push_back(target);
  }
  return targets;
}

/// Index of the first of some cumulative sums above `at` < the last, never one that adds nothing.
std::size_t firstAbove(const float* cumulative, std::size_t count, float at) {
  const float* last = std::lower_bound(cumulative, cumulative + count, cumulative[count - 1]);
  return static_cast<std::size_t>(std::upper_bound(cumulative, last, at) - cumulative);
}

Vec3Lanes wayTo(const Vec3Lanes& to, const Vec3& from) {
  return {to.x - from.x, to.y - from.y, to.z - from.z};
}

}  // namespace

EmissionAim::EmissionAim(const World& world) : EmissionAim(targetsOf(world)) {}

EmissionAim::EmissionAim(std::vector<Target> targets) : targets_(std::move(targets)) {
  const auto size = [](const Target& t) { return t.weight * t.radius * t.radius; };
  std::stable_sort(targets_.begin(), targets_.end(),
                   [&](const Target& a, const Target& b) { return size(a) > size(b); });
  if (targets_.size() > kMostTargets) targets_.resize(kMostTargets);
  float sum = 0;
  for (const Target& t : targets_) discs_.push_back(sum += core::kPi * size(t));
  quads_.resize((targets_.size() + kLanes - 1) / kLanes, Quad{});
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    Quad& q = quads_[i / kLanes];
    const int lane = static_cast<int>(i % kLanes);
    const Target& t = targets_[i];
    q.center.x[lane] = t.center.x, q.center.y[lane] = t.center.y, q.center.z[lane] = t.center.z;
    q.radius[lane] = t.radius;
    q.weight[lane] = t.weight;
  }
}

bool EmissionAim::see(const Vec3& origin, const Vec3& normal, Cones& cones) const {
  if (quads_.empty()) return false;
  cones.origin = origin;
  float total = 0;
  for (const Quad& q : quads_) {
    const Vec3Lanes way = wayTo(q.center, origin);
    const Lanes squared = dot(way, way), radius2 = q.radius * q.radius;
    // From within a sphere there is no cone; of those wholly behind a flat lamp nothing is lit.
    const auto seen = (squared > radius2) & (dot(way, normal) > -q.radius);
    const Lanes reach = squareRoot(atLeast(squared - radius2, 0));
    const Lanes oneLessCosine = radius2 / (squared + reach * squareRoot(squared));
    const Lanes size = seen ? q.weight * (2 * core::kPi) * oneLessCosine : Lanes{};
    cones.reach[cones.quads] = seen ? reach : Lanes{} + core::kInfinity;
    cones.size[cones.quads] = size;
    cones.cumulative[cones.quads++] = total += (size[0] + size[1]) + (size[2] + size[3]);
  }
  return total > 0;
}

Vec3 EmissionAim::drawDirection(const Cones& cones, const Chance& chance) const {
  const std::size_t quad = firstAbove(cones.cumulative.data(), cones.quads, chance.target * cones.total());
  float rest = chance.target * cones.total() - (quad > 0 ? cones.cumulative[quad - 1] : 0);
  int lane = 0, last = 0;
  for (int k = 0; k < kLanes; ++k) last = cones.size[quad][k] > 0 ? k : last;
  while (lane < last && rest >= cones.size[quad][lane]) rest -= cones.size[quad][lane++];
  const Vec3 way = quads_[quad].center[lane] - cones.origin;
  const float radius = quads_[quad].radius[lane], sine2 = radius * radius / glm::dot(way, way);
  const float less = chance.place.x * sine2 / (1 + std::sqrt(std::max(0.0f, 1 - sine2)));
  const float sine = std::sqrt(less * (2 - less)), angle = 2 * core::kPi * chance.place.y;
  return Frame(glm::normalize(way)).toWorld({sine * std::cos(angle), sine * std::sin(angle), 1 - less});
}

float EmissionAim::densityOf(const Cones& cones, const Vec3& direction) const {
  Lanes sum{};
  for (std::size_t i = 0; i < cones.quads; ++i) {
    const Quad& q = quads_[i];
    sum += dot(wayTo(q.center, cones.origin), direction) >= cones.reach[i] ? q.weight : Lanes{};
  }
  return ((sum[0] + sum[1]) + (sum[2] + sum[3])) / cones.total();
}

Vec3 EmissionAim::drawOrigin(const Vec3& direction, const Vec3& plain, const Chance& chance) const {
  const Target& t = targets_[firstAbove(discs_.data(), discs_.size(), chance.target * discs_.back())];
  const float r = t.radius * std::sqrt(chance.place.x), a = 2 * core::kPi * chance.place.y;
  const Vec3 met = t.center + Frame(direction).toWorld({r * std::cos(a), r * std::sin(a), 0});
  return met - direction * glm::dot(met - plain, direction);
}

float EmissionAim::densityOf(const Vec3& origin, const Vec3& direction) const {
  float sum = 0;
  for (const Target& t : targets_) {
    const Vec3 across = glm::cross(t.center - origin, direction);
    if (glm::dot(across, across) <= t.radius * t.radius) sum += t.weight;
  }
  return sum / discs_.back();
}

}  // namespace saccade::raytrace
