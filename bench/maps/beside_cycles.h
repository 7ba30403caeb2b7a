// Cycles' bake of the same room, where Blender is installed.
#pragma once

#include <span>
#include <string>

#include "bench/harness/experiment.h"
#include "bench/maps/point_reference.h"
#include "raytrace/world.h"

namespace saccade::bench {

/// Our maps that stand beside it.
struct OurBake {
  double seconds = 0;
  std::vector<core::Vec3> found;  ///< at the reference's points
};

/// Adds record "maps/SCENE/cycles": the seconds of a diffuse bake of 64 samples a texel into one atlas of 512
/// x 512, its error and ours at the points that lie on the side it bakes (the one that normals point to), and
/// how many times sooner ours is done. Where Blender is absent the record says so. Throws core::Error.
void measureCyclesBake(Session& session, const std::string& file, const raytrace::World& world,
                       const PointReference& reference, const OurBake& ours, int threads);

}  // namespace saccade::bench
