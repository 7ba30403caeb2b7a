// Where maps are farthest off, for whoever wants to know why.
#pragma once

#include <filesystem>
#include <span>

#include "bench/maps/point_reference.h"
#include "core/scene/scene.h"
#include "raytrace/world.h"

namespace saccade::bench {

/// Metres.
core::Vec3 positionOf(const raytrace::World& world, const raytrace::SurfacePoint& point);

/// CSV, worst first: x, y, z (metres), object, side, map, reference, deviation (one standard deviation of the
/// reference), share (of the sum of squared errors over all points); W/m^2, luminance. At most `count` lines.
/// Throws core::Error.
void writeWorstPoints(const std::filesystem::path& file, const raytrace::World& world,
                      const PointReference& reference, std::span<const core::Vec3> found, std::size_t count);

}  // namespace saccade::bench
