#include "raytrace/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace saccade::raytrace {
namespace {

constexpr int kBins = 12;
/// A lamp seen at a grazing angle keeps this part of its importance: the cosine is a bound of its centre.
constexpr float kLeastCosine = 0.01f;
/// A side of a split holds at least this part of the lamps.
constexpr std::size_t kLeastPart = 8;

/// v turned about the unit axis k (Rodrigues).
Vec3 turned(const Vec3& v, const Vec3& k, float angle) {
  const float c = std::cos(angle);
  return v * c + glm::cross(k, v) * std::sin(angle) + k * (glm::dot(k, v) * (1 - c));
}

/// Solid angle into which the cone of normals shines, weighted by the cosine beyond it (the paper's
/// equation 1).
float coneMeasure(const LightBounds& b) {
  const float wide = std::min(b.spread + b.emission, core::kPi);
  const float s = std::sin(b.spread), c = std::cos(b.spread);
  return 2 * core::kPi * (1 - c) +
         core::kPi / 2 * (2 * wide * s - std::cos(b.spread - 2 * wide) - 2 * b.spread * s + c);
}

float surface(const core::Bounds& box) {
  const Vec3 e = box.extent();
  return e.x * e.y + e.y * e.z + e.z * e.x;
}

float splitCost(const LightBounds& b) { return b.power * coneMeasure(b) * surface(b.box); }

LightBounds unitedWhereAny(const LightBounds& a, const LightBounds& b) {
  if (a.box.empty()) return b;
  return b.box.empty() ? a : a.unite(b);
}

struct Split {
  int axis = -1;
  int bin = 0;  ///< the last one of the first side
};

int binOf(const LightBounds& lamp, const core::Bounds& centers, int axis) {
  const float extent = centers.hi[axis] - centers.lo[axis];
  const float place = (lamp.box.center()[axis] - centers.lo[axis]) / extent * kBins;
  return std::clamp(static_cast<int>(place), 0, kBins - 1);
}

/// The cheapest of all axes and bins that leaves both sides enough lamps; axis -1 where there is none.
Split cheapest(std::span<const LightBounds> lamps, std::span<const std::uint32_t> part,
               const core::Bounds& centers) {
  Split best;
  float lowest = core::kInfinity;
  const Vec3 extent = centers.extent();
  const float longest = std::max({extent.x, extent.y, extent.z});
  for (int axis = 0; axis < 3; ++axis) {
    if (!(extent[axis] > 0)) continue;
    std::array<LightBounds, kBins> bins;
    std::array<std::size_t, kBins> counts{};
    for (const std::uint32_t i : part) {
      const auto bin = static_cast<std::size_t>(binOf(lamps[i], centers, axis));
      bins[bin] = unitedWhereAny(bins[bin], lamps[i]);
      ++counts[bin];
    }
    std::array<LightBounds, kBins> after;  // everything from a bin on
    after[kBins - 1] = bins[kBins - 1];
    for (std::size_t b = kBins - 1; b-- > 0;) after[b] = unitedWhereAny(bins[b], after[b + 1]);
    LightBounds before;
    std::size_t count = 0;
    for (std::size_t b = 0; b + 1 < kBins; ++b) {
      before = unitedWhereAny(before, bins[b]);
      count += counts[b];
      const std::size_t least = std::max<std::size_t>(1, part.size() / kLeastPart);
      if (count < least || part.size() - count < least) continue;
      const float cost = (splitCost(before) + splitCost(after[b + 1])) * longest / extent[axis];
      if (cost < lowest) lowest = cost, best = {axis, static_cast<int>(b)};
    }
  }
  return best;
}

/// Number of lamps of the first side, which come first in `part` then.
std::size_t divide(std::span<const LightBounds> lamps, std::span<std::uint32_t> part) {
  core::Bounds centers;
  for (const std::uint32_t i : part) centers.add(lamps[i].box.center());
  const Split split = cheapest(lamps, part, centers);
  if (split.axis >= 0) {
    const auto middle = std::stable_partition(part.begin(), part.end(), [&](std::uint32_t i) {
      return binOf(lamps[i], centers, split.axis) <= split.bin;
    });
    return static_cast<std::size_t>(middle - part.begin());
  }
  const Vec3 e = centers.extent();
  const int longest = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
  const std::size_t half = part.size() / 2;
  std::nth_element(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(half), part.end(),
                   [&](std::uint32_t a, std::uint32_t b) {
                     const float x = lamps[a].box.center()[longest], y = lamps[b].box.center()[longest];
                     return x != y ? x < y : a < b;
                   });
  return half;
}

}  // namespace

LightBounds LightBounds::unite(const LightBounds& other) const {
  LightBounds out = spread >= other.spread ? *this : other;
  const LightBounds& narrow = spread >= other.spread ? other : *this;
  const float between = std::acos(std::clamp(glm::dot(out.axis, narrow.axis), -1.0f, 1.0f));
  if (std::min(between + narrow.spread, core::kPi) > out.spread) {
    const float angle = 0.5f * (out.spread + between + narrow.spread);
    const Vec3 across = glm::cross(out.axis, narrow.axis);
    const float length = glm::length(across);
    if (angle < core::kPi && length > 1e-6f) {
      out.axis = glm::normalize(turned(out.axis, across / length, angle - out.spread));
      out.spread = angle;
    } else {
      out.spread = length > 1e-6f || between > 1 ? core::kPi : out.spread;
    }
  }
  out.box.add(narrow.box);
  out.emission = std::max(out.emission, narrow.emission);
  out.power += narrow.power;
  return out;
}

LightTree::LightTree(std::span<const LightBounds> lamps) {
  if (lamps.empty()) return;
  nodes_.reserve(2 * lamps.size() - 1);
  leafOf_.resize(lamps.size());
  std::vector<std::uint32_t> order(lamps.size());
  std::iota(order.begin(), order.end(), 0u);
  build(lamps, order, 0, 0);
}

std::uint32_t LightTree::build(std::span<const LightBounds> lamps, std::span<std::uint32_t> part,
                               std::uint32_t parent, int depth) {
  depth_ = std::max(depth_, depth);
  LightBounds all = lamps[part[0]];
  for (const std::uint32_t i : part.subspan(1)) all = all.unite(lamps[i]);
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  Node node;
  node.center = all.box.center();
  node.radius = 0.5f * all.box.diagonal();
  node.axis = all.axis;
  node.power = all.power;
  // Rounding of the unions must not hide a lamp that shines at grazing angles.
  constexpr float kSlack = 1e-3f;
  const float spread = std::min(all.spread + kSlack, core::kPi);
  node.cosSpread = std::cos(spread);
  node.sinSpread = std::sin(spread);
  node.cosEmission = std::cos(std::min(all.emission, core::kPi));
  node.parent = parent;
  nodes_.push_back(node);
  if (part.size() == 1) {
    nodes_[index].lamp = part[0];
    leafOf_[part[0]] = index;
    return index;
  }
  const std::size_t first = divide(lamps, part);
  build(lamps, part.first(first), index, depth + 1);
  nodes_[index].second = build(lamps, part.subspan(first), index, depth + 1);
  return index;
}

/// The paper's equation 3 without the receiver's cosine: power, cosine, inverse square. Within the sphere
/// around the box neither distance nor direction is known: the radius stands in.
float LightTree::importance(const Node& node, const Vec3& point) const {
  const Vec3 to = point - node.center;
  const float squared = glm::dot(to, to), radius2 = node.radius * node.radius;
  if (!(squared > radius2)) return node.power / std::max(radius2, 1e-30f);
  const float distance = std::sqrt(squared);
  // The angle to the axis, less the spread of the normals, less the angle that the box subtends.
  const float cosAxis = glm::dot(to, node.axis) / distance;
  const auto less = [](float cosA, float sinA, float cosB, float sinB) {
    return cosA >= cosB ? 1.0f : cosA * cosB + sinA * sinB;  // cos(max(0, a - b))
  };
  const auto sine = [](float c) { return std::sqrt(std::max(0.0f, 1 - c * c)); };
  const float cosBox = std::sqrt(std::max(0.0f, 1 - radius2 / squared));
  const float beyondSpread = less(cosAxis, sine(cosAxis), node.cosSpread, node.sinSpread);
  const float cosine = less(beyondSpread, sine(beyondSpread), cosBox, node.radius / distance);
  if (cosine <= node.cosEmission) return 0;
  return node.power * std::max(cosine, kLeastCosine) / squared;
}

bool LightTree::draw(const Vec3& point, float u, Drawn& out) const {
  out.probability = 1;
  std::uint32_t at = 0;
  if (nodes_.empty() || !(importance(nodes_[0], point) > 0)) return false;
  while (nodes_[at].second != 0) {
    const float a = importance(nodes_[at + 1], point), b = importance(nodes_[nodes_[at].second], point);
    if (!(a + b > 0)) return false;
    const float share = a / (a + b);
    const bool first = u < share;
    const float chance = first ? share : 1 - share;
    u = std::min(std::max(first ? u / share : (u - share) / chance, 0.0f), 0x1.fffffep-1f);
    out.probability *= chance;
    at = first ? at + 1 : nodes_[at].second;
  }
  out.lamp = nodes_[at].lamp;
  return out.probability > 0;
}

float LightTree::probability(const Vec3& point, std::uint32_t lamp) const {
  float product = 1;
  for (std::uint32_t at = leafOf_[lamp]; at != 0 && product > 0;) {
    const std::uint32_t parent = nodes_[at].parent;
    const float a = importance(nodes_[parent + 1], point),
                b = importance(nodes_[nodes_[parent].second], point);
    if (!(a + b > 0)) return 0;
    const float share = a / (a + b);
    product *= at == parent + 1 ? share : 1 - share;
    at = parent;
  }
  return importance(nodes_[0], point) > 0 ? product : 0;
}

float LightTree::irradiance(const Vec3& point) const {
  return nodes_.empty() ? 0 : importance(nodes_[0], point) / core::kPi;
}

}  // namespace saccade::raytrace
