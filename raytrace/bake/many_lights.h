// Direct light of many lamps and of the environment: shadow rays to samples of them, and rays by the cosine.
#pragma once

#include "raytrace/bake/receiver.h"
#include "raytrace/lights.h"

namespace saccade::raytrace {

/// Every so many-th sample also sends a ray by the cosine, for lights that area sampling finds badly.
inline constexpr std::uint32_t kCosineEvery = 4;

/// Shadow rays to lamps, weighted for kCosineEvery times as many samples as of sampleCosine. uLight in [0,
/// 1), u in [0, 1)^2.
Vec3 sampleLights(const World& world, const Receiver& at, const LightChoice& choice, float uLight,
                  const Vec2& u, RayCounters& counters);

/// A shadow ray to the environment, weighted likewise.
Vec3 sampleEnvironment(const World& world, const Receiver& at, const EnvironmentLight& environment,
                       const Vec2& u, RayCounters& counters);

/// A ray by the cosine that counts where it meets the environment or, with a `choice`, a lamp: to be added
/// kCosineEvery-fold.
Vec3 sampleCosine(const World& world, const Receiver& at, const LightChoice* choice, const Vec2& u,
                  RayCounters& counters);

}  // namespace saccade::raytrace
