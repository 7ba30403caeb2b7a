#include "render/base/frustum.h"

#include <array>
#include <cmath>

namespace saccade::render {

namespace {

constexpr int kPlanes = 5;  // left, right, top, bottom, near; the far plane lies behind the scene's bounds
using Planes = std::array<core::Vec4, kPlanes>;
constexpr unsigned kAllPlanes = (1u << kPlanes) - 1;

/// Inside where dot(plane, (p, 1)) >= 0 (Gribb and Hartmann's rows of the matrix).
Planes frustumPlanes(const core::Mat4& viewProjection) {
  const core::Mat4 rows = glm::transpose(viewProjection);
  return {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1], rows[3] - rows[2]};
}

enum class Side { outside, crossing, inside };

Side classify(const core::Vec4& plane, const core::Bounds& b) {
  const core::Vec3 normal(plane);
  const core::Vec3 center = b.center(), half = 0.5f * b.extent();
  const float distance = glm::dot(normal, center) + plane.w;
  const float radius = glm::dot(glm::abs(normal), half);
  // Rounding of the sums above, generously: a box that touches a plane counts as crossing.
  const float slack = 1e-5f * (glm::dot(glm::abs(normal), glm::abs(center)) + std::abs(plane.w) + radius);
  if (distance < -radius - slack) return Side::outside;
  return distance > radius + slack ? Side::inside : Side::crossing;
}

struct Walk {
  const core::Scene& scene;
  const Planes& planes;
  std::vector<char>& visible;

  /// `open`: bits of the planes that the parent's box crosses.
  void visit(int index, unsigned open) {
    const core::HierarchyNode& node = scene.hierarchy[static_cast<std::size_t>(index)];
    for (int p = 0; p < kPlanes; ++p) {
      if (!(open & (1u << p))) continue;
      const Side side = classify(planes[static_cast<std::size_t>(p)], node.bounds);
      if (side == Side::outside) return;
      if (side == Side::inside) open &= ~(1u << p);
    }
    if (node.object >= 0) visible[static_cast<std::size_t>(node.object)] = 1;
    for (int child : node.child) {
      if (child >= 0) visit(child, open);
    }
  }
};

}  // namespace

void findVisible(const core::Scene& scene, const core::View& view, std::vector<char>& visible) {
  visible.assign(scene.objects.size(), scene.hierarchy.empty() ? 1 : 0);
  if (scene.hierarchy.empty()) return;
  const Planes planes = frustumPlanes(view.viewProjection());
  Walk{scene, planes, visible}.visit(0, kAllPlanes);
}

}  // namespace saccade::render
