#include "raytrace/bake/chart_clusters.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "core/progress.h"
#include "raytrace/bake/cell_clip.h"

namespace saccade::raytrace {
namespace {

constexpr double kConeCosine = 0.766;      // 40 degrees from the chart's axis
constexpr double kLeftoverCosine = 0.616;  // 52 degrees for what remains between charts
constexpr double kLeftoverShare = 0.125;   // of a neighbour's area: a smaller chart is a leftover
constexpr double kDihedralCosine = 0.643;  // 50 degrees: a sharper edge ends a chart
constexpr float kCreaseCosine = 0.906f;    // 25 degrees between shading normals at an edge's ends: a crease
constexpr double kNeedle = 1e-6;           // height over base below which a triangle has no normal in fp32
constexpr double kHollowFill = 0.35;       // charts that fill less of their rectangle are halved
constexpr std::uint32_t kNone = 0xffffffffu;

struct PositionHash {
  std::size_t operator()(const std::array<std::uint32_t, 3>& k) const {
    std::uint64_t h = k[0] * 0x9e3779b97f4a7c15ull;
    h = (h ^ (h >> 29) ^ k[1]) * 0xbf58476d1ce4e5b9ull;
    h = (h ^ (h >> 32) ^ k[2]) * 0x94d049bb133111ebull;
    return static_cast<std::size_t>(h ^ (h >> 31));
  }
};

/// What clustering knows of a mesh's triangles.
class Topology {
 public:
  Topology(const core::Mesh& mesh, const std::stop_token& stop) : mesh_(mesh), count_(mesh.triangleCount()) {
    weld();
    core::throwIfStopped(stop);
    measure();
    core::throwIfStopped(stop);
    connect();
    core::throwIfStopped(stop);
  }

  std::size_t count() const { return count_; }
  const core::Mesh& mesh() const { return mesh_; }
  const glm::dvec3& normal(std::uint32_t t) const { return normal_[t]; }  ///< unit, zero if degenerate
  double area(std::uint32_t t) const { return area_[t]; }                 ///< m^2, zero if degenerate
  std::uint32_t neighbour(std::uint32_t t, int edge) const { return neighbour_[3 * t + edge]; }
  const core::Vec3& position(std::uint32_t t, int corner) const {
    return mesh_.positions[mesh_.indices[3 * t + corner]];
  }
  glm::dvec3 centroid(std::uint32_t t) const {
    return (glm::dvec3(position(t, 0)) + glm::dvec3(position(t, 1)) + glm::dvec3(position(t, 2))) / 3.0;
  }

 private:
  void weld() {
    std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, PositionHash> seen;
    seen.reserve(mesh_.positions.size());
    welded_.resize(mesh_.positions.size());
    for (std::size_t i = 0; i < welded_.size(); ++i) {
      const core::Vec3 p = mesh_.positions[i] + 0.0f;  // -0 becomes +0
      const std::array<std::uint32_t, 3> key{std::bit_cast<std::uint32_t>(p.x),
                                             std::bit_cast<std::uint32_t>(p.y),
                                             std::bit_cast<std::uint32_t>(p.z)};
      welded_[i] = seen.try_emplace(key, static_cast<std::uint32_t>(i)).first->second;
    }
  }

  void measure() {
    normal_.assign(count_, glm::dvec3(0));
    area_.assign(count_, 0);
    for (std::uint32_t t = 0; t < count_; ++t) {
      const glm::dvec3 a = position(t, 0), e = glm::dvec3(position(t, 1)) - a,
                       f = glm::dvec3(position(t, 2)) - a;
      const glm::dvec3 n = glm::cross(e, f);
      const double length = glm::length(n);
      const double longest = std::max({glm::dot(e, e), glm::dot(f, f), glm::dot(e - f, e - f)});
      if (!std::isfinite(length) || !std::isfinite(glm::dot(a, a)) || !(length > kNeedle * longest)) continue;
      normal_[t] = n / length;
      area_[t] = 0.5 * length;
    }
  }

  struct Edge {
    std::uint32_t lo, hi, corner;  // corner = 3 * triangle + edge
    bool forward;                  // runs from lo to hi in its triangle
  };

  void connect() {
    std::vector<Edge> edges;
    edges.reserve(3 * count_);
    for (std::uint32_t c = 0; c < 3 * count_; ++c) {
      const std::uint32_t a = welded_[mesh_.indices[c]], b = welded_[mesh_.indices[next(c)]];
      if (area_[c / 3] > 0 && a != b) edges.push_back({std::min(a, b), std::max(a, b), c, a < b});
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& x, const Edge& y) {
      return x.lo != y.lo ? x.lo < y.lo : x.hi != y.hi ? x.hi < y.hi : x.corner < y.corner;
    });
    neighbour_.assign(3 * count_, kNone);
    for (std::size_t i = 0, j; i < edges.size(); i = j) {
      for (j = i + 1; j < edges.size() && edges[j].lo == edges[i].lo && edges[j].hi == edges[i].hi;) ++j;
      // Only an edge of exactly two triangles, wound alike, is crossed: then they lie on its two sides.
      if (j - i == 2 && edges[i].forward != edges[i + 1].forward && smooth(edges[i], edges[i + 1])) {
        neighbour_[edges[i].corner] = edges[i + 1].corner / 3;
        neighbour_[edges[i + 1].corner] = edges[i].corner / 3;
      }
    }
  }

  bool smooth(const Edge& a, const Edge& b) const {
    const std::uint32_t s = a.corner / 3, t = b.corner / 3;
    if (glm::dot(normal_[s], normal_[t]) < kDihedralCosine) return false;
    if (mesh_.normals.empty()) return true;
    const auto shading = [&](std::uint32_t corner) { return mesh_.normals[mesh_.indices[corner]]; };
    return glm::dot(shading(a.corner), shading(next(b.corner))) >= kCreaseCosine &&
           glm::dot(shading(next(a.corner)), shading(b.corner)) >= kCreaseCosine;
  }

  static std::uint32_t next(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

  const core::Mesh& mesh_;
  std::size_t count_;
  std::vector<std::uint32_t> welded_;  ///< vertex -> first vertex at the same place
  std::vector<glm::dvec3> normal_;
  std::vector<double> area_;
  std::vector<std::uint32_t> neighbour_;  ///< across edge e of triangle t: [3 t + e], kNone at borders
};

/// Splits a set of triangles into its connected parts. `mark` is scratch, one entry a triangle, all kNone
/// before and after.
std::vector<std::vector<std::uint32_t>> connectedParts(const Topology& mesh,
                                                       const std::vector<std::uint32_t>& set,
                                                       std::vector<std::uint32_t>& mark) {
  for (const std::uint32_t t : set) mark[t] = 0;  // 0 = in the set, not yet reached
  std::vector<std::vector<std::uint32_t>> parts;
  for (const std::uint32_t seed : set) {
    if (mark[seed] != 0) continue;
    std::vector<std::uint32_t> part{seed};
    mark[seed] = 1;
    for (std::size_t head = 0; head < part.size(); ++head) {
      for (int e = 0; e < 3; ++e) {
        const std::uint32_t n = mesh.neighbour(part[head], e);
        if (n == kNone || mark[n] != 0) continue;
        mark[n] = 1;
        part.push_back(n);
      }
    }
    std::sort(part.begin(), part.end());
    parts.push_back(std::move(part));
  }
  for (const std::uint32_t t : set) mark[t] = kNone;
  return parts;
}

/// Grows charts from the largest triangles outwards, then shares out the leftovers between them.
class Grower {
 public:
  explicit Grower(const Topology& mesh) : mesh_(mesh), owner_(mesh.count(), kNone) {}

  std::vector<Chart> grow(std::vector<std::uint32_t>& mark) {
    std::vector<std::uint32_t> seeds(mesh_.count());
    std::iota(seeds.begin(), seeds.end(), 0u);
    std::stable_sort(seeds.begin(), seeds.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return mesh_.area(a) > mesh_.area(b); });
    for (const std::uint32_t seed : seeds) {
      if (owner_[seed] == kNone && mesh_.area(seed) > 0) growFrom(seed);
    }
    shareLeftovers();
    return collect(mark);
  }

 private:
  void growFrom(std::uint32_t seed) {
    Chart chart;
    const glm::dvec3 axis = mesh_.normal(seed);
    const glm::dvec3 helper = std::abs(axis.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    chart.u = glm::normalize(glm::cross(helper, axis));
    chart.v = glm::cross(axis, chart.u);
    chart.origin = mesh_.centroid(seed);
    const auto self = static_cast<std::uint32_t>(charts_.size());
    std::vector<std::uint32_t> members{seed};
    owner_[seed] = self;
    double area = 0;
    for (std::size_t head = 0; head < members.size(); ++head) {
      area += mesh_.area(members[head]);
      for (int e = 0; e < 3; ++e) {
        const std::uint32_t n = mesh_.neighbour(members[head], e);
        if (n == kNone || owner_[n] != kNone) continue;
        if (glm::dot(mesh_.normal(n), axis) < kConeCosine) continue;
        owner_[n] = self;
        members.push_back(n);
      }
    }
    charts_.push_back(chart);
    axis_.push_back(axis);
    area_.push_back(area);
  }

  /// Growth leaves slivers where round charts meet: their triangles go, one by one, to the adjoining large
  /// chart that faces them best, within a wider cone.
  void shareLeftovers() {
    std::vector<char> leftover(charts_.size(), 0);
    for (std::uint32_t t = 0; t < mesh_.count(); ++t) {
      for (int e = 0; e < 3; ++e) {
        const std::uint32_t n = mesh_.neighbour(t, e);
        if (n != kNone && area_[owner_[t]] < kLeftoverShare * area_[owner_[n]]) leftover[owner_[t]] = 1;
      }
    }
    for (bool changed = true; changed;) {
      changed = false;
      for (std::uint32_t t = 0; t < mesh_.count(); ++t) {
        if (owner_[t] != kNone && leftover[owner_[t]]) changed |= joinNeighbour(t, leftover);
      }
    }
  }

  bool joinNeighbour(std::uint32_t t, const std::vector<char>& leftover) {
    std::uint32_t best = kNone;
    double bestCosine = kLeftoverCosine;
    for (int e = 0; e < 3; ++e) {
      const std::uint32_t n = mesh_.neighbour(t, e);
      if (n == kNone || leftover[owner_[n]]) continue;
      const double cosine = glm::dot(mesh_.normal(t), axis_[owner_[n]]);
      if (cosine > bestCosine) {
        bestCosine = cosine;
        best = owner_[n];
      }
    }
    if (best != kNone) owner_[t] = best;
    return best != kNone;
  }

  /// What is left of a leftover may have fallen apart: every chart is one connected part.
  std::vector<Chart> collect(std::vector<std::uint32_t>& mark) {
    Chart degenerate;
    for (std::uint32_t t = 0; t < mesh_.count(); ++t) {
      (owner_[t] == kNone ? degenerate : charts_[owner_[t]]).triangles.push_back(t);
    }
    std::vector<Chart> out;
    if (!degenerate.triangles.empty()) out.push_back(degenerate);
    for (Chart& chart : charts_) {
      for (auto& part : connectedParts(mesh_, chart.triangles, mark)) {
        Chart c = chart;
        c.triangles = std::move(part);
        out.push_back(std::move(c));
      }
    }
    return out;
  }

  const Topology& mesh_;
  std::vector<std::uint32_t> owner_;  ///< triangle -> chart
  std::vector<Chart> charts_;
  std::vector<glm::dvec3> axis_;
  std::vector<double> area_;
};

/// Directions to try as the rectangle's: those that most of the border runs along, then every 15 degrees. The
/// smallest rectangle around a shape has a side along one of the border's edges.
std::vector<double> candidateAngles(const Topology& mesh, const Chart& chart,
                                    std::vector<std::uint32_t>& mark) {
  constexpr int kBins = 90;  // of one degree; a quarter turn is the same rectangle
  struct Bin {
    double weight = 0, longest = 0, angle = 0;
  };
  std::array<Bin, kBins> bins;
  for (const std::uint32_t t : chart.triangles) mark[t] = 0;
  for (const std::uint32_t t : chart.triangles) {
    for (int e = 0; e < 3 && mesh.area(t) > 0; ++e) {
      const std::uint32_t n = mesh.neighbour(t, e);
      if (n != kNone && mark[n] != kNone) continue;
      const glm::dvec2 d = chart.project(mesh.position(t, (e + 1) % 3)) - chart.project(mesh.position(t, e));
      const double length = glm::length(d), quarter = 0.5 * core::kPi;
      const double turn = std::atan2(d.y, d.x) / quarter, angle = (turn - std::floor(turn)) * quarter;
      Bin& bin = bins[std::min(static_cast<int>(angle / quarter * kBins), kBins - 1)];
      bin.weight += length;
      if (length > bin.longest) {
        bin.longest = length;
        bin.angle = angle;
      }
    }
  }
  for (const std::uint32_t t : chart.triangles) mark[t] = kNone;
  std::stable_sort(bins.begin(), bins.end(), [](const Bin& a, const Bin& b) { return a.weight > b.weight; });
  std::vector<double> angles;
  angles.reserve(10);
  for (int i = 0; i < 4; ++i) angles.push_back(bins[i].angle);
  for (int i = 0; i < 6; ++i) angles.push_back(i * core::kPi / 12);
  return angles;
}

/// Turns the chart's plane so that its bounding rectangle is small, longer side along u.
void fitRectangle(const Topology& mesh, Chart& chart, std::vector<std::uint32_t>& mark) {
  std::vector<glm::dvec2> points;
  for (const std::uint32_t t : chart.triangles) {
    for (int c = 0; c < 3 && mesh.area(t) > 0; ++c) points.push_back(chart.project(mesh.position(t, c)));
  }
  constexpr double kWorthTurning = 0.98;  // of the area: earlier candidates win ties
  double bestArea = core::kInfinity;
  glm::dvec2 best(1, 0);
  for (const double angle : candidateAngles(mesh, chart, mark)) {
    const glm::dvec2 x(std::cos(angle), std::sin(angle)), y(-x.y, x.x);
    glm::dvec2 lo(core::kInfinity), hi(-core::kInfinity);
    for (const glm::dvec2& p : points) {
      const glm::dvec2 q(glm::dot(p, x), glm::dot(p, y));
      lo = glm::min(lo, q);
      hi = glm::max(hi, q);
    }
    const glm::dvec2 e = hi - lo;
    if (points.empty() || !(e.x * e.y < kWorthTurning * bestArea)) continue;
    bestArea = e.x * e.y;
    best = e.y > e.x ? y : x;
    chart.lo = e.y > e.x ? glm::dvec2(lo.y, -hi.x) : lo;
    chart.hi = e.y > e.x ? glm::dvec2(hi.y, -lo.x) : hi;
  }
  const glm::dvec3 u = best.x * chart.u + best.y * chart.v;
  chart.v = -best.y * chart.u + best.x * chart.v;
  chart.u = u;
}

/// Whether the projection covers some place twice (a spiral ramp): a cell of a grid is filled beyond 1.
bool overlapsItself(const Topology& mesh, const Chart& chart) {
  if (chart.triangles.size() < 4) return false;  // needs at least a fan around a point
  const glm::dvec2 extent = chart.hi - chart.lo;
  if (!(extent.x > 0) || !(extent.y > 0)) return false;
  const double side = std::clamp(2.0 * std::sqrt(static_cast<double>(chart.triangles.size())), 8.0, 256.0);
  const int width = static_cast<int>(side), height = static_cast<int>(side);
  const glm::dvec2 scale(width / extent.x, height / extent.y);
  std::vector<double> filled(static_cast<std::size_t>(width) * height, 0.0);
  constexpr double kFull = 1.01;
  bool overlap = false;
  for (const std::uint32_t t : chart.triangles) {
    glm::dvec2 p[3];
    for (int c = 0; c < 3; ++c) p[c] = (chart.project(mesh.position(t, c)) - chart.lo) * scale;
    forEachCell(p[0], p[1], p[2], width, height, [&](int x, int y, double area) {
      overlap |= (filled[static_cast<std::size_t>(y) * width + x] += area) > kFull;
    });
    if (overlap) return true;
  }
  return false;
}

double projectedArea(const Topology& mesh, const Chart& chart) {
  const glm::dvec3 axis = glm::cross(chart.u, chart.v);
  double sum = 0;
  for (const std::uint32_t t : chart.triangles) sum += mesh.area(t) * glm::dot(mesh.normal(t), axis);
  return sum;
}

/// Cuts a chart in two by the triangles' order along a direction, and each half into connected parts.
std::vector<Chart> halve(const Topology& mesh, const Chart& chart, const glm::dvec3& direction,
                         std::vector<std::uint32_t>& mark) {
  std::vector<std::uint32_t> order = chart.triangles;
  const auto key = [&](std::uint32_t t) { return glm::dot(mesh.centroid(t) - chart.origin, direction); };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(order.size() / 2);
  std::vector<Chart> out;
  for (std::vector<std::uint32_t> half :
       {std::vector<std::uint32_t>(order.begin(), middle), std::vector<std::uint32_t>(middle, order.end())}) {
    std::sort(half.begin(), half.end());
    for (auto& part : connectedParts(mesh, half, mark)) {
      Chart c = chart;
      c.triangles = std::move(part);
      out.push_back(std::move(c));
    }
  }
  return out;
}

}  // namespace

std::vector<Chart> clusterMesh(const core::Mesh& mesh, const std::stop_token& stop) {
  const Topology topology(mesh, stop);
  double total = 0;
  for (std::uint32_t t = 0; t < topology.count(); ++t) total += topology.area(t);
  const double worthHalving = total / 256;  // hollow charts smaller than this waste little
  std::vector<std::uint32_t> mark(topology.count(), kNone);
  std::vector<Chart> pending = Grower(topology).grow(mark), done;
  for (std::size_t i = 0; i < pending.size(); ++i) {
    core::throwIfStopped(stop);
    Chart chart = std::move(pending[i]);
    fitRectangle(topology, chart, mark);
    const glm::dvec2 extent = chart.hi - chart.lo;
    const double rectangle = extent.x * extent.y;
    const bool hollow = chart.triangles.size() > 1 && rectangle > worthHalving &&
                        projectedArea(topology, chart) < kHollowFill * rectangle;
    if (hollow || overlapsItself(topology, chart)) {
      // Turns of a spiral lie above one another: cut by height. A hollow chart is cut across its length.
      const glm::dvec3 direction = hollow ? chart.u : glm::cross(chart.u, chart.v);
      for (Chart& part : halve(topology, chart, direction, mark)) pending.push_back(std::move(part));
    } else {
      done.push_back(std::move(chart));
    }
  }
  return done;
}

}  // namespace saccade::raytrace
