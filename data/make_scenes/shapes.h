// Basic shapes. All but panels, sheets and frames are closed.
#pragma once

#include <functional>

#include "data/make_scenes/mesh_data.h"

namespace saccade::data {

/// Parallelogram corner, corner + edgeU, corner + edgeU + edgeV, corner + edgeV; it faces
/// cross(edgeU, edgeV). uv runs from (0, uvSize.y) at the corner to (uvSize.x, 0) opposite: upright when
/// edgeV points up.
MeshData panel(const Vec3& corner, const Vec3& edgeU, const Vec3& edgeV, const Vec2& uvSize = Vec2(1));

/// Axis-aligned box with sharp edges around `center`; uv in units of `uvMetres`.
MeshData box(const Vec3& center, const Vec3& size, float uvMetres = 1);

/// Axis-aligned box with edges rounded by `radius` in `steps` segments; uv in units of `uvMetres`.
MeshData roundedBox(const Vec3& center, const Vec3& size, float radius, int steps, float uvMetres = 1);

/// f(u, v) for u, v in [0, 1] sampled on nu x nv cells; the outside is where cross(df/du, df/dv) points; the
/// uv is (u, 1 - v), upright. A closed direction uses the very same positions at 0 and 1.
struct Grid {
  int nu = 1, nv = 1;
  bool closedU = false, closedV = false;
};
MeshData parametric(const Grid& grid, const std::function<glm::dvec3(double u, double v)>& f);

/// Round tube of `radius` (which may vary) along an open curve, with rounded ends; t in [0, 1].
MeshData tube(const std::function<glm::dvec3(double t)>& curve, const std::function<double(double t)>& radius,
              int lengthSteps, int aroundSteps);

/// Picture frame around an opening of width x height in the plane z = 0, facing +z: `border` wide, `depth`
/// deep.
MeshData frame(float width, float height, float border, float depth, int profileSteps);

/// Box without bottom, walls without thickness: a vitrine. Its base is centred at the origin.
MeshData openCase(const Vec3& size);

/// Convex solid with flat facets around the origin: `sides` around, crown, girdle and pavilion like a cut
/// stone. Height from 0 to `height`.
MeshData cutStone(float radius, float height, int sides);

}  // namespace saccade::data
