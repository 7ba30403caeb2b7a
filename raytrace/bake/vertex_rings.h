// Density estimation where light is kept by vertex: windows are the vertices within so many edges of one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "raytrace/bake/density.h"

namespace saccade::raytrace {

/// Which vertices an edge joins, by their texels. Vertices alike in all but their normals are not joined.
class VertexGraph {
 public:
  explicit VertexGraph(const TexelMap& texels);
  /// Texels of the vertices that edges join, ascending.
  const std::vector<std::uint32_t>& vertices() const { return vertices_; }
  std::span<const std::uint32_t> neighbours(std::size_t texel) const {
    return {neighbours_.data() + first_[texel], neighbours_.data() + first_[texel + 1]};
  }
  /// Of the vertex, in the world; the normal is unit.
  const Vec3& position(std::size_t texel) const { return places_[texel].position; }
  const Vec3& normal(std::size_t texel) const { return places_[texel].normal; }

 private:
  struct Place {
    Vec3 position{0}, normal{0, 0, 1};
  };
  void addObject(const TexelMap& texels, std::size_t o,
                 std::vector<std::pair<std::uint32_t, std::uint32_t>>& edges);

  std::vector<std::uint32_t> vertices_, neighbours_;
  std::vector<std::uint32_t> first_;  ///< by texel; empty without vertices
  std::vector<Place> places_;         ///< by texel; empty without vertices
};

/// estimateDensity for the texels of vertices: the same rule, with planes fitted over the tangent plane.
void estimateByVertex(const TexelMap& texels, std::span<const float> areas, const FluxGrid& flux, int plane,
                      double watts, const DensityOptions& options, const core::Progress& progress,
                      std::span<DensityEstimate> out);

}  // namespace saccade::raytrace
