// One corrective sub-sample's way through the scene.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <type_traits>

#include "core/math/random.h"
#include "raytrace/bsdf.h"
#include "raytrace/corrective_tracer.h"
#include "raytrace/lights.h"
#include "raytrace/medium.h"
#include "raytrace/surface.h"

namespace saccade::raytrace {

/// How a rough ray was made, for the weight of the light it may hit.
struct RoughRay {
  const LightChoice* choice = nullptr;
  float density = 0;  ///< rays times pdf
};

/// One pixel's one sub-sample.
class Walk {
 public:
  Walk(const World& world, const CorrectiveOptions& options, core::PixelSampler sampler,
       RayCounters& counters)
      : world_(world), options_(options), sampler_(sampler), counters_(counters) {}

  /// Radiance that the lobes other than Lambert send back along the ray. `weight`: of this branch in the
  /// pixel.
  Vec3 specular(const Surface& surface, const Bsdf& bsdf, int depth, float weight);
  /// Radiance along a ray of a delta.
  Vec3 incoming(const Ray& ray, int depth, float weight) {
    Leg leg(ray);
    send(leg);
    locate(leg, depth);
    return received(leg, depth, weight, nullptr);
  }

 private:
  /// The solids that the walk is in while it follows one ray: only kept where a solid attenuates.
  class Following {
   public:
    Following(Walk& walk, const Surface& surface, const Vec3& direction) : walk_(walk) {
      if (!walk.world_.attenuates()) return;
      before_ = walk.inside_;
      walk.inside_.leave(surface, direction);
    }
    ~Following() {
      if (before_) walk_.inside_ = *before_;
    }
    Following(const Following&) = delete;
    Following& operator=(const Following&) = delete;

   private:
    Walk& walk_;
    std::optional<Inside> before_;
  };

  /// A ray and what it met.
  struct Leg {
    explicit Leg(const Ray& r, float d = 0, const Vec3& f = Vec3(1)) : ray(r), density(d), factor(f) {}
    Ray ray;
    float density;  ///< rays times pdf; 0 when the lights were not sampled as well
    Vec3 factor;    ///< of what it brings back
    bool met = false;
    Hit hit;
    std::optional<BaseLookup> base;  ///< where the maps' light is all that is wanted
  };
  /// The legs of one lobe. Nothing is written that is not used: std::optional clears its storage.
  class Legs {
   public:
    void add(const Ray& ray, float density, const Vec3& factor) {
      std::construct_at(at(size_++), ray, density, factor);
    }
    int size() const { return size_; }
    Leg& operator[](int i) { return *at(i); }

   private:
    Leg* at(int i) { return reinterpret_cast<Leg*>(bytes_) + i; }
    static_assert(std::is_trivially_destructible_v<Leg>);
    alignas(Leg) std::byte bytes_[CorrectiveOptions::kMaxGlossyRays * sizeof(Leg)];
    int size_ = 0;
  };
  void send(Leg& leg) {
    leg.met = world_.intersect(leg.ray, leg.hit, counters_);
    if (leg.met) world_.prefetch(leg.hit);
  }
  /// The texels that received() will read set out. Best a while after send() and a while before received().
  void locate(Leg& leg, int depth) const {
    if (leg.met && showsBase(leg.hit, depth)) leg.base.emplace(world_, leg.hit, leg.ray.direction);
  }
  /// A diffuse hit, or the end of the specular chain.
  bool showsBase(const Hit& hit, int depth) const {
    return world_.diffuse(hit.object) || depth >= world_.recursionDepth();
  }
  /// Radiance that comes back along a leg, which is sent and located. `rough` is null for rays of deltas.
  Vec3 received(const Leg& leg, int depth, float weight, const RoughRay* rough);
  Vec3 scattered(const Surface& surface, const Vec3& direction, int depth, float weight);
  Vec3 deltaBranches(const Surface& surface, const Bsdf& bsdf, int depth, float weight);
  Vec3 branches(const Surface& surface, const Bsdf& bsdf, int depth, float weight);
  Vec3 dispersed(const Surface& surface, const Bsdf& bsdf, int depth, float weight);
  Vec3 layeredBranches(const Surface& surface, const Bsdf& bsdf, int depth, float weight);
  Vec3 branch(const Surface& surface, const BsdfSample& sample, float chance, int depth, float weight);
  void drawEach(const Surface& surface, const Bsdf& bsdf, unsigned lobes, int count, bool lights, Legs& legs);
  void drawTogether(const Surface& surface, const Bsdf& bsdf, int count, bool lights, Legs& legs);
  Vec3 roughRays(const Surface& surface, const Bsdf& bsdf, unsigned lobes, int depth, float weight);
  Vec3 lightSample(const Surface& surface, const Bsdf& bsdf, unsigned lobes, const LightChoice& choice,
                   float rays, float weight);
  float emissionWeight(const Hit& hit, const Vec3& direction, float distance, const RoughRay* rough) const;
  Vec3 environment(const Vec3& direction, const RoughRay* rough) const;

  const World& world_;
  const CorrectiveOptions& options_;
  core::PixelSampler sampler_;
  RayCounters& counters_;
  Inside inside_;
  int channel_ = -1;  ///< the only one followed; -1: all
};

}  // namespace saccade::raytrace
