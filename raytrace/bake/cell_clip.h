// Cuts a triangle of the plane into the unit cells of a grid: exact areas for texels and overlap tests.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

namespace saccade::raytrace {

using Plane2 = glm::dvec2;

/// A convex polygon with at most 7 corners: a triangle cut by the four sides of a cell.
struct CellPolygon {
  std::array<Plane2, 8> corner;
  int count = 0;

  /// Twice the signed area (counter-clockwise positive).
  double twiceArea() const {
    double sum = 0;
    for (int i = 1; i + 1 < count; ++i) {
      const Plane2 a = corner[i] - corner[0], b = corner[i + 1] - corner[0];
      sum += a.x * b.y - a.y * b.x;
    }
    return sum;
  }
};

/// The part of the polygon with sign * (p[axis] - limit) >= 0.
inline CellPolygon cutHalfPlane(const CellPolygon& in, int axis, double limit, double sign) {
  CellPolygon out;
  for (int i = 0; i < in.count; ++i) {
    const Plane2& p = in.corner[i];
    const Plane2& q = in.corner[(i + 1) % in.count];
    const double dp = sign * (p[axis] - limit), dq = sign * (q[axis] - limit);
    if (dp >= 0 && out.count < 8) out.corner[out.count++] = p;
    if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) {
      Plane2 cut = p + (q - p) * (dp / (dp - dq));
      cut[axis] = limit;
      if (out.count < 8) out.corner[out.count++] = cut;
    }
  }
  return out;
}

/// The part of the triangle inside cell [x, x + 1] x [y, y + 1].
inline CellPolygon clipToCell(const Plane2& a, const Plane2& b, const Plane2& c, int x, int y) {
  CellPolygon p{{a, b, c}, 3};
  p = cutHalfPlane(p, 1, y, 1);
  p = cutHalfPlane(p, 1, y + 1, -1);
  p = cutHalfPlane(p, 0, x, 1);
  return cutHalfPlane(p, 0, x + 1, -1);
}

/// visit(x, y, area) for each cell of [0, width) x [0, height) that the triangle covers by more than nothing,
/// row by row; area in cells, positive whatever the orientation. Coordinates must be finite.
template <class Visit>
void forEachCell(const Plane2& a, const Plane2& b, const Plane2& c, int width, int height, Visit&& visit) {
  const CellPolygon whole{{a, b, c}, 3};
  const auto cellRange = [](const CellPolygon& p, int axis, int limit, int& first, int& last) {
    double lo = p.corner[0][axis], hi = lo;
    for (int i = 1; i < p.count; ++i) {
      lo = std::min(lo, p.corner[i][axis]);
      hi = std::max(hi, p.corner[i][axis]);
    }
    first = static_cast<int>(std::clamp(std::floor(lo), 0.0, static_cast<double>(limit)));
    last = static_cast<int>(std::clamp(std::ceil(hi), 0.0, static_cast<double>(limit)));
  };
  int y0, y1;
  cellRange(whole, 1, height, y0, y1);
  for (int y = y0; y < y1; ++y) {
    const CellPolygon row = cutHalfPlane(cutHalfPlane(whole, 1, y, 1), 1, y + 1, -1);
    if (row.count < 3) continue;
    int x0, x1;
    cellRange(row, 0, width, x0, x1);
    for (int x = x0; x < x1; ++x) {
      const CellPolygon cell = cutHalfPlane(cutHalfPlane(row, 0, x, 1), 0, x + 1, -1);
      const double area = 0.5 * std::abs(cell.twiceArea());
      if (cell.count >= 3 && area > 0) visit(x, y, area);
    }
  }
}

}  // namespace saccade::raytrace
