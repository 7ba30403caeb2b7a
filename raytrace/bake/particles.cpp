#include "raytrace/bake/particles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/random.h"
#include "raytrace/bake/duplicates.h"
#include "raytrace/bsdf.h"
#include "raytrace/emission_aim.h"
#include "raytrace/lights.h"
#include "raytrace/medium.h"
#include "raytrace/surface.h"

namespace saccade::raytrace {
namespace {

constexpr std::uint64_t kBatch = 4096;              // particles per piece of work
constexpr int kMaxEvents = 256;                     // surfaces met; a mirror box would not end otherwise
constexpr std::uint32_t kParticleStream = 0x7061u;  // keeps particles' random numbers apart from texels'
constexpr float kMaxNormalRatio = 4;  // bound on cos(shading) / cos(geometric) at grazing angles

/// Follows one particle at a time; one per thread.
class Tracer {
 public:
  Tracer(const World& world, const TexelMap& texels, const Duplicates& duplicates, const EmissionAim& aim,
         ParticleState& state, RayCounters& counters)
      : world_(world),
        texels_(texels),
        duplicates_(duplicates),
        aim_(aim),
        state_(state),
        perWatt_(static_cast<float>(1 / world.lights().totalPower())),
        counters_(counters) {}

  /// `whole`: beyond the first diffuse surface; others are aimed.
  void follow(std::uint64_t index, std::uint32_t seed, bool whole) {
    core::PixelSampler random(kParticleStream, 0, index, seed);
    const float uLight = random.next1D();
    const Vec2 uPosition = random.next2D();
    const Vec2 uDirection = random.next2D();
    EmissionAim::Chance chance;
    if (!whole) chance = {random.next1D(), random.next1D(), random.next2D()};
    const EmissionSample start =
        world_.lights().sampleEmission(uLight, uPosition, uDirection, whole ? nullptr : &aim_, chance);
    Vec3 weight = start.flux * perWatt_;
    Ray ray{offsetOrigin(start.origin, start.normal, start.direction, start.offset), start.direction, 0,
            core::kInfinity};
    Inside inside;
    bool direct = true;  // has met nothing but see-through surfaces: what shadow rays account for
    channel_ = -1;
    diffuse_ = false;
    for (int event = 0; event < kMaxEvents && core::luminance(weight) > 0; ++event) {
      Hit hit;
      if (!world_.intersect(ray, hit, counters_)) return;
      const Surface surface = makeSurface(world_, hit, ray.direction);
      if (world_.attenuates()) weight *= inside.transmittance(world_, hit.object, surface.front, hit.t);
      if (!direct) deposit(surface, hit, ray.direction, weight);
      const float uCoverage = random.next1D();
      if (uCoverage >= surface.point.coverage) {
        ray = surface.leave(ray.direction);
        continue;
      }
      if (direct) weight *= rangeFactor(start.range, glm::length(surface.position - start.origin));
      direct = false;
      if (!surface.scatters() || !scatter(surface, random, whole, ray, weight)) return;
      if (world_.attenuates()) inside.leave(surface, ray.direction);
    }
  }

 private:
  /// Records the flux at the hit, on the triangles that coincide with the one hit too.
  void deposit(const Surface& surface, const Hit& hit, const Vec3& direction, const Vec3& weight) {
    const float cosGeometric = -glm::dot(direction, surface.ng);
    const float cosShading =
        -glm::dot(direction, smoothNormal(world_, hit.object, hit.triangle, hit.u, hit.v, surface.ng));
    const float ratio = std::clamp(cosShading / std::max(cosGeometric, 1e-6f), 0.0f, kMaxNormalRatio);
    const Vec2 b(hit.u, hit.v);
    add(hit.object, hit.triangle, b, surface.front, weight * ratio);
    addToDuplicates(hit.object, hit, surface.front, weight * ratio);
    for (const Twin& twin : world_.twinsOf(hit.object)) {
      add(twin.object, hit.triangle, b, surface.front, weight * ratio);
      addToDuplicates(twin.object, hit, surface.front, weight * ratio);
    }
  }

  /// `object`: of the hit, or its twin.
  void addToDuplicates(std::uint32_t object, const Hit& hit, bool front, const Vec3& weight) {
    const float b[3] = {1 - hit.u - hit.v, hit.u, hit.v};
    for (const Duplicate& d : duplicates_.of(hit.triangle)) {
      float of[3];
      for (std::size_t k = 0; k < 3; ++k) of[d.corner[k]] = b[k];
      const bool instanced = world_.instanceOf(object) != nullptr;
      add(instanced ? object : world_.record(d.triangle).object, d.triangle, Vec2(of[1], of[2]),
          front != d.flipped, weight);
    }
  }

  /// `b`: barycentric weights of the triangle's corners 1 and 2.
  void add(std::uint32_t objectIndex, std::uint32_t triangle, const Vec2& b, bool front, const Vec3& weight) {
    const core::Scene& scene = world_.scene();
    const core::Object& object = scene.objects[objectIndex];
    if (!front && !scene.materials[static_cast<std::size_t>(object.material)].doubleSided) return;
    const std::size_t texel = texels_.texelAt(world_.lightmapUv(objectIndex, triangle, b.x, b.y));
    if (texels_.chartOf(texel) < 0) return;  // shows no irradiance
    const int layer = front ? 0 : 1;
    state_.flux.add(texel, diffuse_ ? ParticleState::indirectPlane(layer) : state_.causticPlane(layer),
                    weight);
  }

  /// The next ray; false when the particle is absorbed, or is not to be followed beyond a diffuse surface.
  bool scatter(const Surface& surface, core::PixelSampler& random, bool whole, Ray& ray, Vec3& weight) {
    Bsdf bsdf(surface, -ray.direction);
    if (surface.disperses()) {
      if (channel_ < 0) {
        channel_ = std::min(2, static_cast<int>(3 * random.next1D()));
        weight = heroOf(weight, channel_);
      }
      bsdf.setIor(surface.iorOf(channel_));
    }
    const float uLobe = random.next1D();
    const float chance = bsdf.diffuseChance();
    const bool diffuse = uLobe < chance;
    if (diffuse && !whole) return false;
    const float drawn = diffuse ? chance : 1 - chance;
    const float uRest = std::min((diffuse ? uLobe : uLobe - chance) / drawn, 0x1.fffffep-1f);
    const std::optional<BsdfSample> sample =
        bsdf.sample(uRest, random.next2D(), diffuse ? kLobeDiffuse : kLobeSpecular);
    const float uSurvive = random.next1D();
    if (!sample) return false;
    const Vec3 next = weight * sample->weight / drawn;
    // Weights stay near that of the mean particle: survive with the share of luminance that is left.
    const float survival = std::min(1.0f, core::luminance(next) / core::luminance(weight));
    if (!(uSurvive < survival)) return false;
    weight = next / survival;
    ray = surface.leave(sample->direction);
    diffuse_ |= diffuse;
    return true;
  }

  const World& world_;
  const TexelMap& texels_;
  const Duplicates& duplicates_;
  const EmissionAim& aim_;
  ParticleState& state_;
  float perWatt_;
  bool diffuse_ = false;  ///< the present particle has met a diffuse lobe
  int channel_ = -1;      ///< the only one that it still has, from the first solid that splits light
  RayCounters& counters_;
};

}  // namespace

void FluxGrid::add(std::size_t texel, int layer, const Vec3& weight) {
  const auto units = [](float w) {
    return static_cast<std::uint64_t>(std::llround(std::clamp(w, 0.0f, kMaxWeight) * kUnitsPerWeight));
  };
  Cell& cell = cells_[static_cast<std::size_t>(layer) * texels_ + texel];
  const auto accumulate = [](std::uint64_t& sum, std::uint64_t x) {
    std::atomic_ref<std::uint64_t>(sum).fetch_add(x, std::memory_order_relaxed);
  };
  for (int c = 0; c < 3; ++c) accumulate(cell.rgb[c], units(weight[c]));
  const float y = core::luminance(weight);
  accumulate(cell.squared, units(y * y));
}

bool castsCaustics(const World& world) {
  for (std::uint32_t o = 0; o < world.scene().objects.size(); ++o) {
    const CompiledMaterial& m = world.materialOf(o);
    if (m.metallic > 0 || m.transmission > 0 || m.extension || m.dielectricF90 > 0) return true;
  }
  return false;
}

void traceParticles(const World& world, const TexelMap& texels, const ParticleOptions& options,
                    std::uint64_t last, const core::Progress& progress, ParticleState& state) {
  const std::uint64_t first = state.emitted;
  if (world.lights().empty() || !(world.lights().totalPower() > 0) || last <= first) return;
  const auto batches = static_cast<int>(
      std::min<std::uint64_t>((last - first + kBatch - 1) / kBatch, std::numeric_limits<int>::max()));
  const Duplicates duplicates(world);
  const EmissionAim aim = state.caustics && last > options.whole
                              ? EmissionAim(world)
                              : EmissionAim(std::vector<EmissionAim::Target>());
  const int done = rowsUntilStopped(batches, options.threads, progress, [&](int batch, int) {
    RayCounters own;
    Tracer tracer(world, texels, duplicates, aim, state, options.counters ? *options.counters : own);
    const std::uint64_t begin = first + static_cast<std::uint64_t>(batch) * kBatch;
    for (std::uint64_t i = begin; i < std::min(begin + kBatch, last); ++i) {
      tracer.follow(i, options.seed, i < options.whole);
    }
  });
  state.emitted = std::min(last, first + static_cast<std::uint64_t>(done) * kBatch);
}

double wattsPerWeight(const World& world, std::uint64_t emitted) {
  return emitted ? world.lights().totalPower() / static_cast<double>(emitted) : 0.0;
}

}  // namespace saccade::raytrace
