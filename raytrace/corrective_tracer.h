// Corrective samples (Haber 2001, section 4.3): full radiance of a non-diffuse surface minus what the base
// layer shows there. Recursive ray tracing with importance-sampled area lights and distributed glossy rays;
// diffuse light comes from the illumination maps.
//
// A sample depends on nothing but pixel, frame (camera, id, depth), scene, maps and options: bit-identical on
// any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/corrective/messages.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

struct Surface;
class Bsdf;

struct CorrectiveOptions {
  static constexpr int kMaxGlossyRays = 4;
  std::uint32_t seed = 1;
  int samplesPerPixel = 1;  ///< sub-samples; all through the pixel's centre
  int glossyRays = 3;  ///< rays of a rough lobe at the first hit; 1 deeper. Gallery: 27,000 samples in 50 ms
                       ///< (2: 34,000; 4: 22,000)
};

class CorrectiveTracer {
 public:
  /// The world must outlive the tracer.
  CorrectiveTracer(const World& world, const CorrectiveOptions& options);

  /// The sample of pixel (x, y), whose id in the frame must not be 0. `level` is only a label. Any thread; no
  /// allocation. A correction that is not finite becomes 0 and is counted.
  core::Sample trace(const core::FrameSnapshot& frame, int x, int y, int level, RayCounters& counters) const;
  /// The samples of many pixels, appended to `samples`: each has the bits that it has alone, but they come
  /// sooner. What a pixel reads is sent for while other pixels' rays are traced.
  void trace(const core::FrameSnapshot& frame, std::span<const core::Pixel> pixels, int level,
             RayCounters& counters, std::vector<core::Sample>& samples) const;

  /// A sample's surface point as another eye sees it.
  struct Revisit {
    Vec3 correction{0};  ///< with the random numbers of the sample's pixel
    Vec3 shown{0};       ///< radiance of the base layer
  };
  /// What the correction of a sample of this tracer would be if its own point, not its pixel's, were traced
  /// for another eye: the truth that aging must foretell. Nothing where the point faces away from the eye, or
  /// where the ray does not find it again. Any thread.
  std::optional<Revisit> revisit(const core::Sample& sample, const Vec3& eye, RayCounters& counters) const;

  const World& world() const { return world_; }
  const CorrectiveOptions& options() const { return options_; }

 private:
  /// What the ray through a pixel's centre met on the pixel's object.
  struct Primary {
    Hit hit;
    Vec3 direction{0};  ///< unit
    bool found = false;
    bool fromDepth = false;
  };
  core::Sample shade(const core::FrameSnapshot& frame, int x, int y, const Primary& primary, int level,
                     RayCounters& counters) const;
  Primary aim(const core::FrameSnapshot& frame, int x, int y, RayCounters& counters) const;
  /// What the base layer shows of a point.
  Vec3 shown(const Surface& surface) const;
  /// Full radiance - base, seen along `direction` from the eye; not yet checked for being finite.
  Vec3 difference(const Surface& surface, const Bsdf& bsdf, const Vec3& eye, const Vec3& direction, int x,
                  int y, RayCounters& counters) const;
  Vec3 correction(const Surface& surface, const Bsdf& bsdf, const Vec3& direction, int x, int y,
                  RayCounters& counters) const;

  const World& world_;
  CorrectiveOptions options_;
};

}  // namespace saccade::raytrace
