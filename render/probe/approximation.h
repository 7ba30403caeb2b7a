// What stands in for a correction until there is one: light probes in place of rays. It is shown where no
// splat covers an object and is no part of anything else: neither samples nor the correction layer know of
// it, so what a picture converges to is the same with it and without.
//
// A function of scene, maps and frame alone, by means that a replay has: the base renderer, no ray.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/corrective/messages.h"
#include "core/scene/scene.h"
#include "render/base/base_renderer.h"
#include "render/probe/glance.h"
#include "render/probe/probe.h"

namespace saccade::render {

/// GL thread only. Scene and renderer must outlive it.
class Approximation {
 public:
  /// Objects near one another share a probe where there are more: each takes milliseconds and half a MiB.
  static constexpr std::size_t kMostProbes = 32;

  Approximation(const core::Scene& scene, BaseRenderer& renderer);

  /// Draws probes that at() will need and that are not there yet, those of most pixels first, as many as are
  /// allowed: 1 to 20 ms each. Throws as BaseRenderer::render.
  void prepare(const core::FrameSnapshot& frame, std::span<const core::Pixel> pixels,
               std::size_t atMost = kMostProbes);
  /// corrections[i] is about what a sample of pixels[i] would be, 0 where its probe was not drawn yet. All of
  /// them must be on the frame's mask. Pixels of one object in an aligned block of 2 x 2 that follow one
  /// another share the probe's light: a quarter of the time at hardly another error.
  void at(const core::FrameSnapshot& frame, std::span<const core::Pixel> pixels,
          std::vector<core::Vec3>& corrections) const;

  std::size_t probesMade() const;

 private:
  struct Place {
    core::Vec3 center{0};
    std::unique_ptr<Probe> probe;  ///< null until it is wanted
  };
  void assign(std::vector<std::uint32_t> ids);
  std::vector<char> hiddenFrom(const core::Vec3& center) const;

  const core::Scene& scene_;
  BaseRenderer& renderer_;
  std::uint64_t mapsNumber_ = 0;
  std::vector<const core::Object*> objects_;  ///< by id; [0] unused
  std::vector<Glance> glances_;               ///< by id; [0] unused
  std::vector<std::size_t> placeOf_;          ///< by id, into places_
  std::vector<Place> places_;
};

}  // namespace saccade::render
