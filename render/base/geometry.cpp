#include "render/base/geometry.h"

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "core/scene/placement.h"
#include "render/base/solid.h"

namespace saccade::render {

namespace {

constexpr std::array<int, 5> kComponents{3, 2, 2, 2, 4};  // by VertexAttribute

int strideFloats(std::uint32_t attributes) {
  int stride = 0;
  for (std::size_t a = 0; a < kComponents.size(); ++a) stride += attributes & (1u << a) ? kComponents[a] : 0;
  return stride;
}

template <int n, class Vector>
void put(std::vector<float>& out, const std::vector<Vector>& values, std::size_t vertex, float missing) {
  for (int c = 0; c < n; ++c) out.push_back(values.empty() ? missing : values[vertex][c]);
}

/// A texture may name a UV set that the mesh lacks: it reads (0, 0).
void appendVertices(std::vector<float>& out, const core::Mesh& mesh, std::uint32_t attributes) {
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    put<3>(out, mesh.positions, v, 0);
    if (attributes & (1u << kLightmapUv)) put<2>(out, mesh.lightmapUv, v, 0);
    if (attributes & (1u << kUv0)) put<2>(out, mesh.uv0, v, 0);
    if (attributes & (1u << kUv1)) put<2>(out, mesh.uv1, v, 0);
    if (attributes & (1u << kColor)) put<4>(out, mesh.colors, v, 1);
  }
}

void describeLayout(const Gl& gl, std::uint32_t attributes) {
  const int stride = strideFloats(attributes) * static_cast<int>(sizeof(float));
  std::size_t offset = 0;
  for (std::uint32_t a = 0; a < kComponents.size(); ++a) {
    if (!(attributes & (1u << a))) continue;
    gl.EnableVertexAttribArray(a);
    gl.VertexAttribPointer(a, kComponents[a], GL_FLOAT, GL_FALSE, stride,
                           reinterpret_cast<const void*>(offset));
    offset += static_cast<std::size_t>(kComponents[a]) * sizeof(float);
  }
}

/// Asked once a mesh: the answer holds in any place, mirrored ones included.
class Solids {
 public:
  explicit Solids(const core::Scene& scene) : scene_(scene), known_(scene.meshes.size(), kUnknown) {}
  bool isSolid(const core::Object& object) {
    const bool opaque = scene_.materials[object.material].alphaMode == core::AlphaMode::opaque;
    if (!opaque || !object.closed) return false;
    char& known = known_[object.mesh];
    if (known == kUnknown) known = isOutwardSolid(scene_.meshOf(object));
    return known == 1;
  }

 private:
  static constexpr char kUnknown = 2;
  const core::Scene& scene_;
  std::vector<char> known_;
};

/// As the tracer has it: what refracts is seen from inside too.
bool isOneSided(const core::Material& material) {
  return !material.doubleSided && material.transmission == 0;
}

template <class T>
void fillBuffer(const Gl& gl, GLenum target, const std::vector<T>& data) {
  gl.BufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), GL_STATIC_DRAW);
}

}  // namespace

Geometry::Geometry(const Gl& gl, const core::Scene& scene) {
  Solids solids(scene);
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const core::Object& object = scene.objects[i];
    const core::Mesh& mesh = scene.meshOf(object);
    if (mesh.indices.empty()) continue;
    DrawItem item;
    item.object = i;
    item.features = featuresOf(scene, object);
    item.attributes = attributesOf(item.features);
    item.indexCount = static_cast<std::uint32_t>(mesh.indices.size());
    item.solid = solids.isSolid(object);
    item.oneSided = isOneSided(scene.materials[object.material]);
    item.instanced = mesh.instanced;
    item.mirrored = mesh.instanced && core::Placement(object.meshToWorld).mirrored;
    items_.push_back(item);
  }
  sortItems(scene);
  upload(gl, scene);
  checkGl(gl, "uploading the geometry");
}

void Geometry::sortItems(const core::Scene& scene) {
  std::sort(items_.begin(), items_.end(), [&](const DrawItem& a, const DrawItem& b) {
    const auto key = [&](const DrawItem& item) {
      const core::Object& o = scene.objects[item.object];
      return std::tuple(item.attributes, item.features, scene.materials[o.material].baseColorTexture.texture,
                        o.material, o.id, item.object);
    };
    return key(a) < key(b);
  });
}

void Geometry::upload(const Gl& gl, const core::Scene& scene) {
  std::map<std::uint32_t, std::vector<float>> vertices;
  std::vector<std::uint32_t> indices;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> firstIndices;  // of mesh and attributes
  for (DrawItem& item : items_) {
    const core::Object& object = scene.objects[item.object];
    const auto [known, isNew] =
        firstIndices.try_emplace({object.mesh, item.attributes}, static_cast<std::uint32_t>(indices.size()));
    item.firstIndex = known->second;
    if (!isNew) continue;
    const core::Mesh& mesh = scene.meshOf(object);
    std::vector<float>& out = vertices[item.attributes];
    const auto base = static_cast<std::uint32_t>(out.size() / strideFloats(item.attributes));
    constexpr std::size_t kLimit = std::numeric_limits<std::uint32_t>::max() / sizeof(std::uint32_t);
    if (indices.size() + mesh.indices.size() > kLimit || base + mesh.positions.size() > kLimit)
      throw core::Error("the scene has too many triangles; at most " + std::to_string(kLimit / 3) +
                        " can be drawn");
    appendVertices(out, mesh, item.attributes);
    for (std::uint32_t index : mesh.indices) indices.push_back(base + index);
  }
  gl.BindVertexArray(0);
  indices_ = GlBuffer(gl);
  for (const auto& [attributes, data] : vertices) {
    Layout layout{GlVertexArray(gl), GlBuffer(gl)};
    gl.BindVertexArray(layout.vertexArray.name());
    gl.BindBuffer(GL_ARRAY_BUFFER, layout.vertices.name());
    fillBuffer(gl, GL_ARRAY_BUFFER, data);
    describeLayout(gl, attributes);
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
    if (layouts_.empty()) fillBuffer(gl, GL_ELEMENT_ARRAY_BUFFER, indices);
    layouts_.emplace(attributes, std::move(layout));
  }
  gl.BindVertexArray(0);
}

}  // namespace saccade::render
