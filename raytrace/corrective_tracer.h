// Corrective samples (Haber 2001, section 4.3): full radiance of a non-diffuse surface minus what the base
// layer shows there. Recursive ray tracing with importance-sampled area lights and distributed glossy rays;
// diffuse light comes from the illumination maps.
//
// A sample depends on nothing but pixel, frame (camera, id, depth), scene, maps and options: bit-identical on
// any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/corrective/messages.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

struct CorrectiveOptions {
  static constexpr int kMaxGlossyRays = 4;
  std::uint32_t seed = 1;
  int samplesPerPixel = 1;  ///< sub-samples; all through the pixel's centre
  int glossyRays = 2;       ///< rays of a rough lobe at the first hit, 1..kMaxGlossyRays; 1 deeper
};

class CorrectiveTracer {
 public:
  struct Pixel {
    std::int32_t x = 0, y = 0;
  };

  /// The world must outlive the tracer.
  CorrectiveTracer(const World& world, const CorrectiveOptions& options);

  /// The sample of pixel (x, y), whose id in the frame must not be 0. `level` is only a label. Any thread; no
  /// allocation. A correction that is not finite becomes 0 and is counted.
  core::Sample trace(const core::FrameSnapshot& frame, int x, int y, int level, RayCounters& counters) const;

  /// trace() of each pixel in order, appended to `out`: the same samples, sooner, because all the primary
  /// rays are traced before the first is shaded and what shading needs is fetched meanwhile.
  void trace(const core::FrameSnapshot& frame, std::span<const Pixel> pixels, int level,
             RayCounters& counters, std::vector<core::Sample>& out) const;

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
  Primary aim(const core::FrameSnapshot& frame, Pixel pixel, RayCounters& counters) const;
  core::Sample shade(const core::FrameSnapshot& frame, Pixel pixel, int level, const Primary& primary,
                     RayCounters& counters) const;

  const World& world_;
  CorrectiveOptions options_;
};

}  // namespace saccade::raytrace
