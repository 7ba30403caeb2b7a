#include "render/base/geometry.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace saccade::render {

namespace {

constexpr std::array<int, 5> kComponents{3, 2, 2, 2, 4};  // by VertexAttribute
/// Vertices, and indices, of one portion: about a millisecond.
constexpr std::size_t kPortion = 32768;

int strideFloats(std::uint32_t attributes) {
  int stride = 0;
  for (std::size_t a = 0; a < kComponents.size(); ++a) stride += attributes & (1u << a) ? kComponents[a] : 0;
  return stride;
}

std::size_t vertexBytes(std::uint32_t attributes) {
  return static_cast<std::size_t>(strideFloats(attributes)) * sizeof(float);
}

template <int n, class Vector>
void put(std::vector<float>& out, const std::vector<Vector>& values, std::size_t vertex, float missing) {
  for (int c = 0; c < n; ++c) out.push_back(values.empty() ? missing : values[vertex][c]);
}

/// A texture may name a UV set that the mesh lacks: it reads (0, 0).
std::vector<float> interleaved(const core::Mesh& mesh, std::uint32_t attributes, std::size_t begin,
                               std::size_t end) {
  std::vector<float> out;
  out.reserve((end - begin) * static_cast<std::size_t>(strideFloats(attributes)));
  for (std::size_t v = begin; v < end; ++v) {
    put<3>(out, mesh.positions, v, 0);
    if (attributes & (1u << kLightmapUv)) put<2>(out, mesh.lightmapUv, v, 0);
    if (attributes & (1u << kUv0)) put<2>(out, mesh.uv0, v, 0);
    if (attributes & (1u << kUv1)) put<2>(out, mesh.uv1, v, 0);
    if (attributes & (1u << kColor)) put<4>(out, mesh.colors, v, 1);
  }
  return out;
}

void describeLayout(const Gl& gl, std::uint32_t attributes) {
  const auto stride = static_cast<GLsizei>(vertexBytes(attributes));
  std::size_t offset = 0;
  for (std::uint32_t a = 0; a < kComponents.size(); ++a) {
    if (!(attributes & (1u << a))) continue;
    gl.EnableVertexAttribArray(a);
    gl.VertexAttribPointer(a, kComponents[a], GL_FLOAT, GL_FALSE, stride,
                           reinterpret_cast<const void*>(offset));
    offset += static_cast<std::size_t>(kComponents[a]) * sizeof(float);
  }
}

/// Into a part of a buffer, which no vertex array is changed by.
template <class T>
void copyInto(const Gl& gl, const GlBuffer& buffer, std::size_t offset, const std::vector<T>& data) {
  gl.BindBuffer(GL_COPY_WRITE_BUFFER, buffer.name());
  gl.BufferSubData(GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(offset),
                   static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data());
}

void allocate(const Gl& gl, GLenum target, std::size_t bytes) {
  gl.BufferData(target, static_cast<GLsizeiptr>(bytes), nullptr, GL_STATIC_DRAW);
}

/// Calls add(begin, end) for the portions of so many things.
template <class Add>
void inPortions(std::size_t count, Add&& add) {
  for (std::size_t begin = 0; begin < count; begin += kPortion) add(begin, std::min(count, begin + kPortion));
}

}  // namespace

void Geometry::makeBuffers(const Gl& gl, const core::Scene& scene, std::span<const MeshPart> parts) {
  std::map<std::uint32_t, std::size_t> vertices;
  std::size_t indices = 0;
  for (const MeshPart& part : parts) {
    vertices[part.attributes] += scene.meshes[part.mesh].positions.size();
    indices += scene.meshes[part.mesh].indices.size();
  }
  gl.BindVertexArray(0);
  indices_ = GlBuffer(gl);
  for (const auto& [attributes, count] : vertices) {
    Layout layout{GlVertexArray(gl), GlBuffer(gl)};
    gl.BindVertexArray(layout.vertexArray.name());
    gl.BindBuffer(GL_ARRAY_BUFFER, layout.vertices.name());
    allocate(gl, GL_ARRAY_BUFFER, count * vertexBytes(attributes));
    describeLayout(gl, attributes);
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
    if (layouts_.empty()) allocate(gl, GL_ELEMENT_ARRAY_BUFFER, indices * sizeof(std::uint32_t));
    layouts_.emplace(attributes, std::move(layout));
  }
  gl.BindVertexArray(0);
}

void Geometry::addUpload(const Gl& gl, const core::Scene& scene, std::span<const MeshPart> parts,
                         Portions& portions) {
  portions.add([this, &gl, &scene, parts] { makeBuffers(gl, scene, parts); });
  for (const MeshPart& part : parts) {
    const core::Mesh& mesh = scene.meshes[part.mesh];
    inPortions(mesh.positions.size(), [&](std::size_t begin, std::size_t end) {
      portions.add([this, &gl, &mesh, part, begin, end] {
        copyInto(gl, layouts_.at(part.attributes).vertices,
                 (part.firstVertex + begin) * vertexBytes(part.attributes),
                 interleaved(mesh, part.attributes, begin, end));
      });
    });
    inPortions(mesh.indices.size(), [&](std::size_t begin, std::size_t end) {
      portions.add([this, &gl, &mesh, part, begin, end] {
        std::vector<std::uint32_t> indices(mesh.indices.begin() + static_cast<std::ptrdiff_t>(begin),
                                           mesh.indices.begin() + static_cast<std::ptrdiff_t>(end));
        for (std::uint32_t& index : indices) index += part.firstVertex;
        copyInto(gl, indices_, (part.firstIndex + begin) * sizeof(std::uint32_t), indices);
      });
    });
  }
  portions.add([&gl] { checkGl(gl, "uploading the geometry"); });
}

}  // namespace saccade::render
