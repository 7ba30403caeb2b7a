#include "raytrace/bake/light_variation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/math/random.h"
#include "raytrace/bake/charts.h"
#include "raytrace/bake/parallel.h"
#include "raytrace/bsdf.h"
#include "raytrace/lights.h"
#include "raytrace/surface.h"

namespace saccade::raytrace {
namespace {

constexpr std::uint32_t kStream = 0x76617279u;  // keeps the random numbers apart from others'
constexpr std::uint32_t kLightSamples = 2;      // of a set

/// Triangles that show irradiance, item by item, with their areas summed up.
struct ItemSurface {
  struct Entry {
    double upTo;  ///< m^2 of the item's surface until here
    std::uint32_t object, triangle;
    bool doubleSided;
  };
  std::vector<Entry> entries;
  double area() const { return entries.empty() ? 0 : entries.back().upTo; }
};

std::vector<ItemSurface> surfaceOfItems(const World& world, const ChartLayout& layout) {
  std::vector<ItemSurface> items(layout.items().size());
  const core::Scene& scene = world.scene();
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    const core::Material& material = scene.materials[static_cast<std::size_t>(scene.objects[o].material)];
    if (!showsIrradiance(material)) continue;
    const glm::dmat3 meshToWorld(scene.objects[o].meshToWorld);
    for (std::uint32_t t = 0; t < world.triangleCountOf(o); ++t) {
      const Vec3* corner = world.shape(world.firstTriangle(o) + t).position;
      const double area = (material.doubleSided ? 1.0 : 0.5) *
                          glm::length(glm::cross(meshToWorld * glm::dvec3(corner[1] - corner[0]),
                                                 meshToWorld * glm::dvec3(corner[2] - corner[0])));
      if (!(area > 0) || !std::isfinite(area)) continue;
      ItemSurface& item = items[layout.itemOf(o, t)];
      item.entries.push_back({item.area() + area, o, t, material.doubleSided});
    }
  }
  return items;
}

/// The luminance of direct light at points, with few samples: set `key`'s.
class DirectProbe {
 public:
  DirectProbe(const World& world, std::uint32_t key, bool front) : world_(world), key_(key), front_(front) {}

  double at(const MeshPoint& p) {
    const Surface surface =
        surfaceOn(world_, p.object, world_.firstTriangle(p.object) + p.triangle, p.b1, p.b2, front_);
    const LightChoice choice = world_.lights().choose(surface.position);
    double sum = 0;
    for (std::uint32_t s = 0; s < kLightSamples; ++s) {
      core::PixelSampler random(kStream, key_, s, front_);
      const float uLight = random.next1D();
      const Vec2 u = random.next2D();
      sum += byLight(surface, choice, uLight, u) + byCosine(surface, choice, random.next2D());
    }
    return sum / kLightSamples;
  }

 private:
  /// Power heuristic of two (Veach 1997).
  static double weight(double pdf, double other) { return pdf * pdf / (pdf * pdf + other * other); }

  double byLight(const Surface& at, const LightChoice& choice, float uLight, const Vec2& u) {
    LightSample light;
    if (!world_.lights().sample(choice, uLight, u, light) || !(light.pdf > 0)) return 0;
    const float cosine = glm::dot(light.direction, at.ng);
    if (!(cosine > 0)) return 0;
    const double free = world_.transmittance(shadowRay(at, light), counters_);
    const double share = light.delta ? 1 : weight(light.pdf, cosine / core::kPi);
    return core::luminance(light.radiance) * cosine * free * share / light.pdf;
  }

  double byCosine(const Surface& at, const LightChoice& choice, const Vec2& u) {
    const float sine = std::sqrt(u.x), angle = 2 * core::kPi * u.y, up = std::sqrt(std::max(0.0f, 1 - u.x));
    const Vec3 direction = Frame(at.ng).toWorld({sine * std::cos(angle), sine * std::sin(angle), up});
    Hit hit;
    if (!(up > 0) || !world_.intersect(at.leave(direction), hit, counters_)) return 0;
    if (world_.record(hit.triangle).light < 0) return 0;
    const Surface met = makeSurface(world_, hit, direction);
    const float pdf =
        world_.lights().pdf(choice, hit.triangle, direction, glm::length(met.position - at.position));
    return core::luminance(met.emitted()) * core::kPi * weight(up / core::kPi, pdf);
  }

  const World& world_;
  std::uint32_t key_;
  bool front_;
  RayCounters counters_;
};

Vec2 uvOf(const World& world, const MeshPoint& p) {
  const TriangleRecord& r = world.record(world.firstTriangle(p.object) + p.triangle);
  const Vec2 uv = r.lightmapUv[0] * (1 - p.b1 - p.b2) + r.lightmapUv[1] * p.b1 + r.lightmapUv[2] * p.b2;
  const Instance* place = world.instanceOf(p.object);
  return place ? place->lightmapUv(uv) : uv;
}

/// The point of the same chart at `uv`; none where the chart has no surface there.
std::optional<MeshPoint> pointAt(const TexelMap& texels, const Vec2& uv) {
  if (!(uv.x > 0 && uv.x < 1 && uv.y > 0 && uv.y < 1)) return std::nullopt;
  return texels.pointAt(texels.texelAt(uv), Plane2(uv) * static_cast<double>(texels.size()));
}

/// What one metre along a direction of a triangle's plane is in the atlas; the direction turned by `angle`.
Vec2 uvPerMetre(const World& world, const MeshPoint& p, float angle) {
  const glm::dmat3 meshToWorld(world.scene().objects[p.object].meshToWorld);
  const Vec3* corner = world.shape(world.firstTriangle(p.object) + p.triangle).position;
  const glm::dvec3 e = meshToWorld * glm::dvec3(corner[1] - corner[0]),
                   g = meshToWorld * glm::dvec3(corner[2] - corner[0]);
  const glm::dvec3 x = glm::normalize(e), y = glm::normalize(g - x * glm::dot(g, x));
  // direction = s e + t g
  const double t = std::sin(angle) / glm::dot(g, y);
  const double s = (std::cos(angle) - t * glm::dot(g, x)) / glm::length(e);
  const Vec2 a = uvOf(world, {p.object, p.triangle, 0, 0});
  return (uvOf(world, {p.object, p.triangle, 1, 0}) - a) * static_cast<float>(s) +
         (uvOf(world, {p.object, p.triangle, 0, 1}) - a) * static_cast<float>(t);
}

struct Probe {
  double irradiance = 0;
  std::array<double, kVariationDistances> square{};  ///< NaN: no room
};

Probe probe(const World& world, const TexelMap& texels, const ItemSurface& item, std::uint32_t number,
            double stratum, const VariationOptions& options) {
  core::PixelSampler random(kStream, 1, number, options.seed);
  const auto found = std::upper_bound(item.entries.begin(), item.entries.end(), stratum * item.area(),
                                      [](double x, const ItemSurface::Entry& e) { return x < e.upTo; });
  const ItemSurface::Entry& e = found == item.entries.end() ? item.entries.back() : *found;
  const Vec2 b = uniformTriangle(random.next2D());
  const MeshPoint centre{e.object, e.triangle, b.x, b.y};
  const bool front = !e.doubleSided || random.next1D() < 0.5f;
  const Vec2 step = uvPerMetre(world, centre, 2 * core::kPi * random.next1D()), uv = uvOf(world, centre);
  DirectProbe sets[2] = {{world, core::hashKey(kStream, number, 0, options.seed), front},
                         {world, core::hashKey(kStream, number, 1, options.seed), front}};
  const double middle[2] = {sets[0].at(centre), sets[1].at(centre)};
  Probe out;
  out.irradiance = 0.5 * (middle[0] + middle[1]);
  if (world.vertexLit(e.object)) {  // has no texels to choose, and no way to go from one point to another
    out.square.fill(std::numeric_limits<double>::quiet_NaN());
    return out;
  }
  for (std::size_t d = 0; d < kVariationDistances; ++d) {
    const Vec2 away = step * static_cast<float>(options.metres[d]);
    const std::optional<MeshPoint> before = pointAt(texels, uv - away), behind = pointAt(texels, uv + away);
    out.square[d] = std::numeric_limits<double>::quiet_NaN();
    if (!before || !behind) continue;
    out.square[d] = 1;
    for (int s = 0; s < 2; ++s) out.square[d] *= sets[s].at(*before) - 2 * middle[s] + sets[s].at(*behind);
  }
  return out;
}

/// Sums over an item's probes.
struct ProbeSum {
  double irradiance = 0;
  std::size_t count = 0;
  std::array<double, kVariationDistances> square{};
  std::array<std::size_t, kVariationDistances> with{};

  void add(const Probe& p) {
    irradiance += p.irradiance;
    ++count;
    for (std::size_t d = 0; d < kVariationDistances; ++d) {
      if (std::isnan(p.square[d])) continue;
      square[d] += p.square[d];
      ++with[d];
    }
  }
  double mean() const { return count > 0 ? irradiance / static_cast<double>(count) : 0; }

  LightVariation average(double area) const {
    LightVariation out;
    out.area = area;
    out.irradiance = mean();
    for (std::size_t d = 0; d < kVariationDistances; ++d) {
      out.structure[d] = with[d] > 0 ? std::max(0.0, square[d] / static_cast<double>(with[d]))
                                     : std::numeric_limits<double>::quiet_NaN();
    }
    return out;
  }
};

/// Probes items, round by round.
class Survey {
 public:
  Survey(const World& world, const TexelMap& texels, std::vector<ItemSurface> items,
         const VariationOptions& options)
      : world_(world), texels_(texels), options_(options), items_(std::move(items)), sums_(items_.size()) {}

  /// options.points spread in proportion to `shares` (by item), and `each` more to every item.
  void round(const std::vector<double>& shares, std::size_t each, const core::Progress& progress) {
    double total = 0;
    for (const double share : shares) total += share;
    std::vector<std::size_t> first{0};
    std::vector<std::uint32_t> itemOf;
    for (std::size_t i = 0; i < items_.size(); ++i) {
      const double share = total > 0 ? shares[i] / total : 0;
      const std::size_t points =
          items_[i].entries.empty()
              ? 0
              : each + static_cast<std::size_t>(share * static_cast<double>(options_.points));
      itemOf.insert(itemOf.end(), points, static_cast<std::uint32_t>(i));
      first.push_back(itemOf.size());
    }
    std::vector<Probe> probes(itemOf.size());
    constexpr std::size_t kBatch = 64;
    const std::size_t batches = (probes.size() + kBatch - 1) / kBatch;
    parallelFor(options_.threads, batches, progress, {}, [&](std::size_t batch) {
      for (std::size_t i = batch * kBatch; i < std::min(probes.size(), (batch + 1) * kBatch); ++i) {
        const std::size_t item = itemOf[i], begin = first[item];
        const double stratum =
            (static_cast<double>(i - begin) + 0.5) / static_cast<double>(first[item + 1] - begin);
        probes[i] =
            probe(world_, texels_, items_[item], static_cast<std::uint32_t>(done_ + i), stratum, options_);
      }
    });
    for (std::size_t i = 0; i < probes.size(); ++i) sums_[itemOf[i]].add(probes[i]);
    done_ += probes.size();
  }

  std::vector<double> areas() const {
    std::vector<double> out;
    for (const ItemSurface& item : items_) out.push_back(item.area());
    return out;
  }
  /// Area times squared light: what the error of a step there counts.
  std::vector<double> squaredLight() const {
    std::vector<double> out;
    for (std::size_t i = 0; i < items_.size(); ++i)
      out.push_back(items_[i].area() * sums_[i].mean() * sums_[i].mean());
    return out;
  }
  std::vector<LightVariation> result() const {
    std::vector<LightVariation> out;
    for (std::size_t i = 0; i < items_.size(); ++i) out.push_back(sums_[i].average(items_[i].area()));
    return out;
  }

 private:
  const World& world_;
  const TexelMap& texels_;
  const VariationOptions& options_;
  std::vector<ItemSurface> items_;
  std::vector<ProbeSum> sums_;
  std::size_t done_ = 0;
};

}  // namespace

std::vector<LightVariation> measureVariation(const World& world, const TexelMap& texels,
                                             const ChartLayout& layout, const VariationOptions& options,
                                             const core::Progress& progress) {
  Survey survey(world, texels, surfaceOfItems(world, layout), options);
  survey.round(survey.areas(), options.pointsPerItem, progress.part(0, 0.5));
  // Small bright surfaces (bars before a window) hold much of the error and little of the area.
  survey.round(survey.squaredLight(), 0, progress.part(0.5, 1));
  return survey.result();
}

}  // namespace saccade::raytrace
