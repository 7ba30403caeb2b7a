#include "raytrace/bake/own_atlas.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <vector>

#include "raytrace/bake/cell_clip.h"
#include "raytrace/bake/texel_map.h"

namespace saccade::raytrace {
namespace {

constexpr float kOutside = 1e-4f;
constexpr double kDensityBound = 4, kAnisotropyBound = 8;  // away from the mean; of one triangle
constexpr double kStretchedShare = 1e-3;                   // of the area: slivers may be stretched more
constexpr double kLeastFill = 0.25;                        // of the bounds
constexpr double kNeedle = 1e-6;                           // as in chart_clusters.cpp
constexpr float kCreaseCosine = 0.906f;                    // 25 degrees, as in chart_clusters.cpp
constexpr double kFewestCells = 1 << 8, kMostCells = 1 << 18;
constexpr double kMostAside = 1 << 16;  // cells along one side
constexpr float kFull = 1.01f;          // of a cell
constexpr double kSliver = 1e-3;        // of a cell: rounding at a chart's border

/// A triangle in space, flattened, and in uv1.
struct FlatTriangle {
  glm::dmat2 space{0};  ///< edges from corner 0, as columns
  glm::dmat2 uv{0};
  double area = 0, uvArea = 0;  ///< 0 where it has none
};

FlatTriangle flatten(const core::Mesh& mesh, std::size_t t) {
  const std::uint32_t* corner = &mesh.indices[3 * t];
  const glm::dvec3 a = mesh.positions[corner[0]], e = glm::dvec3(mesh.positions[corner[1]]) - a,
                   f = glm::dvec3(mesh.positions[corner[2]]) - a;
  FlatTriangle out;
  const double longest = std::max({glm::dot(e, e), glm::dot(f, f), glm::dot(e - f, e - f)});
  const double twice = glm::length(glm::cross(e, f));
  if (!std::isfinite(twice) || !(twice > kNeedle * longest)) return out;
  const glm::dvec2 uv0 = mesh.uv1[corner[0]];
  out.uv = {glm::dvec2(mesh.uv1[corner[1]]) - uv0, glm::dvec2(mesh.uv1[corner[2]]) - uv0};
  const double length = glm::length(e);
  out.space = {{length, 0}, {glm::dot(e, f) / length, twice / length}};
  out.area = 0.5 * twice;
  const double uvTwice = std::abs(glm::determinant(out.uv)),
               uvLongest = std::max({glm::dot(out.uv[0], out.uv[0]), glm::dot(out.uv[1], out.uv[1])});
  if (uvTwice > kNeedle * uvLongest) out.uvArea = 0.5 * uvTwice;
  return out;
}

AtlasFault checkPlaces(const core::Mesh& mesh) {
  if (mesh.uv1.size() != mesh.positions.size() || mesh.indices.empty()) return AtlasFault::missing;
  for (const core::Vec2& uv : mesh.uv1) {
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return AtlasFault::notFinite;
    if (std::min(uv.x, uv.y) < -kOutside || std::max(uv.x, uv.y) > 1 + kOutside) return AtlasFault::outside;
  }
  return AtlasFault::none;
}

/// Bounds, and metres along u and v: their root mean squares over the surface, scaled to keep its area.
AtlasFault measure(const core::Mesh& mesh, OwnAtlas& out) {
  out.lo = glm::dvec2(core::kInfinity);
  out.hi = -out.lo;
  glm::dvec2 square(0);
  double area = 0, uvArea = 0;
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const FlatTriangle flat = flatten(mesh, t);
    if (!(flat.area > 0)) continue;
    if (!(flat.uvArea > 0)) return AtlasFault::flat;
    const glm::dmat2 spacePerUv = flat.space * glm::inverse(flat.uv);
    square += flat.area *
              glm::dvec2(glm::dot(spacePerUv[0], spacePerUv[0]), glm::dot(spacePerUv[1], spacePerUv[1]));
    area += flat.area;
    uvArea += flat.uvArea;
  }
  if (!(area > 0)) return AtlasFault::flat;
  for (const core::Vec2& uv : mesh.uv1) {
    out.lo = glm::min(out.lo, glm::dvec2(uv));
    out.hi = glm::max(out.hi, glm::dvec2(uv));
  }
  out.metres = glm::sqrt(square);
  out.metres *= std::sqrt(area / (uvArea * out.metres.x * out.metres.y));
  return AtlasFault::none;
}

AtlasFault checkShape(const core::Mesh& mesh, const OwnAtlas& atlas) {
  double area = 0, stretched = 0;
  const glm::dmat2 metres{{atlas.metres.x, 0}, {0, atlas.metres.y}};
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const FlatTriangle flat = flatten(mesh, t);
    if (!(flat.area > 0)) continue;
    area += flat.area;
    const glm::dmat2 m = flat.space * glm::inverse(metres * flat.uv);
    const double density = std::abs(glm::determinant(m));
    // Singular values a >= b: a b = density, a^2 + b^2 = squares.
    const double squares = glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]);
    const double root = std::sqrt(std::max(squares * squares - 4 * density * density, 0.0));
    const double anisotropy = 0.5 * (squares + root) / density;
    if (density > kDensityBound || density < 1 / kDensityBound || anisotropy > kAnisotropyBound)
      stretched += flat.area;
  }
  if (stretched > kStretchedShare * area) return AtlasFault::stretched;
  const glm::dvec2 extent = (atlas.hi - atlas.lo) * atlas.metres;
  return area < kLeastFill * extent.x * extent.y ? AtlasFault::wasteful : AtlasFault::none;
}

/// Triangles that meet at a place of uv1 are of one chart (chartsOfUv): they must meet in space as well, and
/// not at a sharp edge.
AtlasFault checkMeetings(const core::Mesh& mesh) {
  std::unordered_map<std::uint64_t, std::size_t> byUv;
  byUv.reserve(mesh.uv1.size());
  for (std::size_t v = 0; v < mesh.uv1.size(); ++v) {
    const std::uint64_t key = (std::uint64_t{std::bit_cast<std::uint32_t>(mesh.uv1[v].x)} << 32) |
                              std::bit_cast<std::uint32_t>(mesh.uv1[v].y);
    const std::size_t first = byUv.try_emplace(key, v).first->second;
    if (mesh.positions[v] != mesh.positions[first]) return AtlasFault::crowded;
    if (!mesh.normals.empty() && glm::dot(mesh.normals[v], mesh.normals[first]) < kCreaseCosine)
      return AtlasFault::creased;
  }
  return AtlasFault::none;
}

/// Charts in cells, and how far they are apart.
class CellGrid {
 public:
  CellGrid(const core::Mesh& mesh, const OwnAtlas& atlas, double cells) {
    const glm::dvec2 extent = (atlas.hi - atlas.lo) * atlas.metres;
    cell_ = std::max(std::sqrt(extent.x * extent.y / cells), std::max(extent.x, extent.y) / kMostAside);
    width_ = static_cast<int>(std::ceil(extent.x / cell_));
    height_ = static_cast<int>(std::ceil(extent.y / cell_));
    filled_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0.0f);
    chart_.assign(filled_.size(), kEmpty);
    fill(mesh, atlas);
  }

  bool overlaps() const {
    return std::any_of(filled_.begin(), filled_.end(), [](float f) { return f > kFull; });
  }

  /// Metres between the two nearest charts, at most; infinite for one chart. Charts grow ring by ring until
  /// they meet. Call once.
  double narrowestGutter() {
    if (touching_) return 0;
    std::vector<std::size_t> front;
    std::vector<int> rings(chart_.size(), 0);
    for (std::size_t i = 0; i < chart_.size(); ++i) {
      if (chart_[i] != kEmpty) front.push_back(i);
    }
    int narrowest = std::numeric_limits<int>::max();
    for (std::size_t head = 0; head < front.size(); ++head) {
      const std::size_t i = front[head];
      forEachNeighbour(i, [&](std::size_t n) {
        if (chart_[n] == kEmpty) {
          chart_[n] = chart_[i];
          rings[n] = rings[i] + 1;
          front.push_back(n);
        } else if (chart_[n] != chart_[i]) {
          narrowest = std::min(narrowest, rings[n] + rings[i]);
        }
      });
    }
    return narrowest == std::numeric_limits<int>::max() ? core::kInfinity : narrowest * cell_;
  }

 private:
  static constexpr std::int32_t kEmpty = -1;

  void fill(const core::Mesh& mesh, const OwnAtlas& atlas) {
    const std::vector<std::int32_t> chartOf = chartsOfUv(mesh, mesh.uv1);
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
      Plane2 p[3];
      for (std::size_t c = 0; c < 3; ++c) p[c] = atlas.project(mesh.uv1[mesh.indices[3 * t + c]]) / cell_;
      forEachCell(p[0], p[1], p[2], width_, height_, [&](int x, int y, double area) {
        const std::size_t i =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
        filled_[i] += static_cast<float>(area);
        if (area < kSliver) return;
        touching_ |= chart_[i] != kEmpty && chart_[i] != chartOf[t];
        chart_[i] = chartOf[t];
      });
    }
  }

  template <class Visit>
  void forEachNeighbour(std::size_t i, Visit&& visit) const {
    const int x = static_cast<int>(i % static_cast<std::size_t>(width_)),
              y = static_cast<int>(i / static_cast<std::size_t>(width_));
    for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, height_ - 1); ++ny) {
      for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, width_ - 1); ++nx)
        visit(static_cast<std::size_t>(ny) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(nx));
    }
  }

  int width_ = 0, height_ = 0;
  double cell_ = 0;  ///< metres
  std::vector<float> filled_;
  std::vector<std::int32_t> chart_;
  bool touching_ = false;
};

AtlasFault checkCells(const core::Mesh& mesh, double mostTexels, OwnAtlas& atlas) {
  CellGrid grid(mesh, atlas, std::clamp(4 * mostTexels, kFewestCells, kMostCells));
  if (grid.overlaps()) return AtlasFault::overlapping;
  const AtlasFault meetings = checkMeetings(mesh);
  if (meetings != AtlasFault::none) return meetings;
  atlas.coarsestTexel = grid.narrowestGutter() / kGutterTexels;
  const glm::dvec2 extent = (atlas.hi - atlas.lo) * atlas.metres;
  const double most = mostTexels * atlas.coarsestTexel * atlas.coarsestTexel;
  return extent.x * extent.y > most ? AtlasFault::crowded : AtlasFault::none;
}

}  // namespace

const char* describe(AtlasFault fault) {
  switch (fault) {
    case AtlasFault::none:
      return "";
    case AtlasFault::missing:
      return "is missing";
    case AtlasFault::notFinite:
      return "has coordinates that are no numbers";
    case AtlasFault::outside:
      return "leaves [0, 1]";
    case AtlasFault::flat:
      return "has triangles without area";
    case AtlasFault::stretched:
      return "stretches triangles too unevenly";
    case AtlasFault::wasteful:
      return "covers less than a quarter of its bounds";
    case AtlasFault::creased:
      return "has charts that bend around sharp edges";
    case AtlasFault::overlapping:
      return "lays triangles over each other";
    case AtlasFault::crowded:
      return "has gutters too narrow for the texels there may be";
  }
  return "";
}

OwnAtlas examineAtlas(const core::Mesh& mesh, double mostTexels) {
  OwnAtlas out;
  out.fault = checkPlaces(mesh);
  if (out.fault == AtlasFault::none) out.fault = measure(mesh, out);
  if (out.fault == AtlasFault::none) out.fault = checkShape(mesh, out);
  if (out.fault == AtlasFault::none) out.fault = checkCells(mesh, mostTexels, out);
  return out;
}

}  // namespace saccade::raytrace
