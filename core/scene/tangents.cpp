#include "core/scene/tangents.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/scene/mesh_repair.h"
#include "core/scene/texture_transform.h"

namespace saccade::core {
namespace {

std::vector<Vec2> uvOf(const Mesh& mesh, const TextureSlot& slot) {
  std::vector<Vec2> uv = slot.uvSet == 1 && !mesh.uv1.empty() ? mesh.uv1 : mesh.uv0;
  if (!slot.transformed()) return uv;
  const glm::mat3x2 matrix = uvMatrix(slot);
  for (Vec2& at : uv) at = matrix * Vec3(at, 1);
  return uv;
}

/// Unit vector, or 0 for what has no direction.
Vec3 direction(const Vec3& v) {
  const float length = glm::length(v);
  return length > 0 && std::isfinite(length) ? v / length : Vec3(0);
}

Vec3 inPlane(const Vec3& v, const Vec3& normal) { return direction(v - normal * glm::dot(normal, v)); }

using Corners = std::array<std::uint32_t, 3>;
Corners cornersOf(const Mesh& m, std::size_t first) {
  return {m.indices[first], m.indices[first + 1], m.indices[first + 2]};
}

/// Twice the signed area on the picture; 0 where that is of no use.
float areaOnPicture(const std::vector<Vec2>& uv, const Corners& c) {
  const Vec2 d1 = uv[c[1]] - uv[c[0]], d2 = uv[c[2]] - uv[c[0]];
  const float area = d1.x * d2.y - d2.x * d1.y;
  return std::isfinite(area) ? area : 0;
}

/// Every vertex of triangles of both signs gets a double for those of negative sign.
void splitMirrored(Mesh& m, std::vector<Vec2>& uv) {
  constexpr char kPositive = 1, kNegative = 2, kBoth = 3;
  std::vector<char> seen(m.positions.size(), 0);
  for (std::size_t first = 0; first + 2 < m.indices.size(); first += 3) {
    const Corners corners = cornersOf(m, first);
    const float area = areaOnPicture(uv, corners);
    if (area == 0) continue;
    for (const std::uint32_t v : corners)
      seen[v] = static_cast<char>(seen[v] | (area > 0 ? kPositive : kNegative));
  }
  if (std::find(seen.begin(), seen.end(), kBoth) == seen.end()) return;
  std::vector<std::uint32_t> sources(m.positions.size()), twin(m.positions.size());
  for (std::uint32_t v = 0; v < m.positions.size(); ++v) sources[v] = v;
  for (std::uint32_t v = 0; v < twin.size(); ++v) {
    if (seen[v] != kBoth) continue;
    twin[v] = static_cast<std::uint32_t>(sources.size());
    sources.push_back(v);
  }
  for (std::size_t first = 0; first + 2 < m.indices.size(); first += 3) {
    if (areaOnPicture(uv, cornersOf(m, first)) >= 0) continue;
    for (std::size_t k = first; k < first + 3; ++k)
      if (seen[m.indices[k]] == kBoth) m.indices[k] = twin[m.indices[k]];
  }
  std::vector<std::uint32_t> indices = std::move(m.indices);
  m = gatherVertices(m, sources);
  m.indices = std::move(indices);
  for (std::size_t v = twin.size(); v < sources.size(); ++v) uv.push_back(Vec2(uv[sources[v]]));
}

/// Directions on the surface, summed over the triangles at a vertex.
struct Frame {
  Vec3 along{0};   ///< the picture's u
  Vec3 across{0};  ///< up the picture: v runs down
};

void addTriangle(const Mesh& m, const std::vector<Vec2>& uv, const Corners& c, std::vector<Frame>& frames) {
  const float area = areaOnPicture(uv, c);
  if (area == 0) return;
  const Vec3 e1 = m.positions[c[1]] - m.positions[c[0]], e2 = m.positions[c[2]] - m.positions[c[0]];
  const Vec2 d1 = uv[c[1]] - uv[c[0]], d2 = uv[c[2]] - uv[c[0]];
  const float side = area > 0 ? 1.0f : -1.0f;
  const Vec3 along = direction(side * (e1 * d2.y - e2 * d1.y));
  const Vec3 across = direction(side * (e1 * d2.x - e2 * d1.x));
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &normal = m.normals[c[k]], &here = m.positions[c[k]];
    const Vec3 next = inPlane(m.positions[c[(k + 1) % 3]] - here, normal);
    const Vec3 last = inPlane(m.positions[c[(k + 2) % 3]] - here, normal);
    const float angle = std::acos(std::clamp(glm::dot(next, last), -1.0f, 1.0f));
    frames[c[k]].along += angle * inPlane(along, normal);
    frames[c[k]].across += angle * inPlane(across, normal);
  }
}

}  // namespace

Vec3 anyPerpendicular(const Vec3& n) {
  return glm::normalize(glm::cross(n, std::abs(n.x) < 0.9f ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
}

const TextureSlot& tangentSlot(const Material& m) {
  for (const TextureSlot* slot : {&m.normalTexture, &m.clearcoatNormalTexture})
    if (*slot) return *slot;
  return m.anisotropyTexture;
}

void makeTangents(Mesh& m, const Material& material) {
  std::vector<Vec2> uv = uvOf(m, tangentSlot(material));
  if (!uv.empty()) splitMirrored(m, uv);
  std::vector<Frame> frames(m.positions.size());
  for (std::size_t first = 0; first + 2 < m.indices.size() && !uv.empty(); first += 3)
    addTriangle(m, uv, cornersOf(m, first), frames);
  m.tangents.resize(m.positions.size());
  for (std::size_t v = 0; v < m.positions.size(); ++v) {
    const Vec3 sum = direction(frames[v].along);
    const Vec3 t = sum == Vec3(0) ? anyPerpendicular(m.normals[v]) : sum;
    const bool mirrored = glm::dot(glm::cross(m.normals[v], t), frames[v].across) < 0;
    m.tangents[v] = Vec4(t, mirrored ? -1.0f : 1.0f);
  }
}

}  // namespace saccade::core
