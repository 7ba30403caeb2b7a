#include "data/make_scenes/mesh_data.h"

#include <cmath>

namespace saccade::data {

std::uint32_t MeshData::addVertex(const Vec3& position, const Vec3& normal, const Vec2& uv) {
  positions.push_back(position);
  normals.push_back(glm::normalize(normal));
  uvs.push_back(uv);
  return static_cast<std::uint32_t>(positions.size() - 1);
}

void MeshData::addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (positions[a] == positions[b] || positions[b] == positions[c] || positions[c] == positions[a]) return;
  indices.insert(indices.end(), {a, b, c});
}

void MeshData::addQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  addTriangle(a, b, c);
  addTriangle(a, c, d);
}

void MeshData::append(const MeshData& other, const Mat4& transform) {
  const auto first = static_cast<std::uint32_t>(positions.size());
  const core::Mat3 rotation(transform);
  for (std::size_t i = 0; i < other.positions.size(); ++i)
    addVertex(Vec3(transform * Vec4(other.positions[i], 1)), rotation * other.normals[i], other.uvs[i]);
  for (const std::uint32_t index : other.indices) indices.push_back(first + index);
}

namespace {

/// Any unit vector at right angles to n, for vertices whose uvs span nothing (poles).
Vec3 anyTangent(const Vec3& n) {
  return glm::normalize(std::abs(n.x) < 0.9f ? glm::cross(n, Vec3(1, 0, 0)) : glm::cross(n, Vec3(0, 1, 0)));
}

struct UvFrame {
  Vec3 alongU{0};
  Vec3 alongV{0};
};

UvFrame frameOfTriangle(const MeshData& mesh, const std::uint32_t* corner) {
  const Vec3 edge1 = mesh.positions[corner[1]] - mesh.positions[corner[0]];
  const Vec3 edge2 = mesh.positions[corner[2]] - mesh.positions[corner[0]];
  const Vec2 uv1 = mesh.uvs[corner[1]] - mesh.uvs[corner[0]];
  const Vec2 uv2 = mesh.uvs[corner[2]] - mesh.uvs[corner[0]];
  const float area = uv1.x * uv2.y - uv2.x * uv1.y;
  if (std::abs(area) < 1e-12f) return {};
  const float sign = area > 0 ? 1.f : -1.f;
  return {sign * (uv2.y * edge1 - uv1.y * edge2), sign * (uv1.x * edge2 - uv2.x * edge1)};
}

}  // namespace

std::vector<Vec4> tangentsOf(const MeshData& mesh) {
  std::vector<UvFrame> sums(mesh.positions.size());
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const UvFrame frame = frameOfTriangle(mesh, &mesh.indices[t]);
    for (std::size_t k = 0; k < 3; ++k) {
      sums[mesh.indices[t + k]].alongU += frame.alongU;
      sums[mesh.indices[t + k]].alongV += frame.alongV;
    }
  }
  std::vector<Vec4> tangents;
  tangents.reserve(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const Vec3 n = mesh.normals[i];
    const Vec3 flat = sums[i].alongU - n * glm::dot(n, sums[i].alongU);
    const Vec3 tangent = glm::dot(flat, flat) > 0 ? glm::normalize(flat) : anyTangent(n);
    const float handedness = glm::dot(glm::cross(n, tangent), sums[i].alongV) > 0 ? -1.f : 1.f;
    tangents.emplace_back(tangent, handedness);
  }
  return tangents;
}

}  // namespace saccade::data
