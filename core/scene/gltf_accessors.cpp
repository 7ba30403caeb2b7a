#include "core/scene/gltf_accessors.h"

#include <algorithm>
#include <cstring>

namespace saccade::core {
namespace {

template <class T>
T load(const unsigned char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

float component(const unsigned char* at, int type, bool normalized) {
  const auto scaled = [&](double value, double largest) {
    return static_cast<float>(normalized ? std::max(value / largest, -1.0) : value);
  };
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return scaled(load<std::int8_t>(at), 127);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return scaled(load<std::uint8_t>(at), 255);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return scaled(load<std::int16_t>(at), 32767);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return scaled(load<std::uint16_t>(at), 65535);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return static_cast<float>(load<std::uint32_t>(at));
    default:
      return load<float>(at);
  }
}

std::uint32_t unsignedAt(const unsigned char* at, int type) {
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return load<std::uint8_t>(at);
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return load<std::uint16_t>(at);
  return load<std::uint32_t>(at);
}

const unsigned char* viewData(const tinygltf::Model& model, int view) {
  const tinygltf::BufferView& v = model.bufferViews[static_cast<std::size_t>(view)];
  return model.buffers[static_cast<std::size_t>(v.buffer)].data.data() + v.byteOffset;
}

struct Layout {
  int components;
  int componentBytes;
  std::size_t elementBytes() const { return static_cast<std::size_t>(components) * componentBytes; }
};
Layout layoutOf(const tinygltf::Accessor& a) {
  return {tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(a.type)),
          tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(a.componentType))};
}

/// Calls visit(element, pointer to its first component) for every element the accessor defines, sparse ones
/// last.
template <class Visit>
void visitElements(const tinygltf::Model& model, const tinygltf::Accessor& a, Visit&& visit) {
  const Layout layout = layoutOf(a);
  if (a.bufferView >= 0) {
    const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(a.bufferView)];
    const std::size_t stride = view.byteStride ? view.byteStride : layout.elementBytes();
    const unsigned char* data = viewData(model, a.bufferView) + a.byteOffset;
    for (std::size_t i = 0; i < a.count; ++i) visit(i, data + i * stride);
  }
  if (!a.sparse.isSparse) return;
  const unsigned char* indices = viewData(model, a.sparse.indices.bufferView) + a.sparse.indices.byteOffset;
  const unsigned char* values = viewData(model, a.sparse.values.bufferView) + a.sparse.values.byteOffset;
  const int type = a.sparse.indices.componentType;
  const int bytes = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type));
  for (int i = 0; i < a.sparse.count; ++i)
    visit(unsignedAt(indices + i * bytes, type),
          values + static_cast<std::size_t>(i) * layout.elementBytes());
}

template <class T>
std::vector<T> readVectors(const tinygltf::Model& model, int accessor, int wanted) {
  const std::vector<float> flat = readFloats(model, accessor);
  const int components = layoutOf(model.accessors[static_cast<std::size_t>(accessor)]).components;
  std::vector<T> out(flat.size() / static_cast<std::size_t>(components), T(1));
  for (std::size_t i = 0; i < out.size(); ++i)
    for (int c = 0; c < std::min(wanted, components); ++c)
      out[i][c] = flat[i * static_cast<std::size_t>(components) + static_cast<std::size_t>(c)];
  return out;
}

}  // namespace

std::vector<float> readFloats(const tinygltf::Model& model, int accessor) {
  const tinygltf::Accessor& a = model.accessors[static_cast<std::size_t>(accessor)];
  const Layout layout = layoutOf(a);
  std::vector<float> out(a.count * static_cast<std::size_t>(layout.components), 0.0f);
  visitElements(model, a, [&](std::size_t element, const unsigned char* at) {
    float* to = out.data() + element * static_cast<std::size_t>(layout.components);
    for (int c = 0; c < layout.components; ++c)
      to[c] = component(at + c * layout.componentBytes, a.componentType, a.normalized);
  });
  return out;
}

std::vector<Vec2> readVec2(const tinygltf::Model& model, int a) { return readVectors<Vec2>(model, a, 2); }
std::vector<Vec3> readVec3(const tinygltf::Model& model, int a) { return readVectors<Vec3>(model, a, 3); }
std::vector<Vec4> readVec4(const tinygltf::Model& model, int a) { return readVectors<Vec4>(model, a, 4); }

std::vector<std::uint32_t> readIndices(const tinygltf::Model& model, int accessor) {
  const tinygltf::Accessor& a = model.accessors[static_cast<std::size_t>(accessor)];
  std::vector<std::uint32_t> out(a.count, 0);
  visitElements(model, a, [&](std::size_t element, const unsigned char* at) {
    out[element] = unsignedAt(at, a.componentType);
  });
  return out;
}

std::vector<std::uint32_t> asTriangles(const std::vector<std::uint32_t>& indices, int mode) {
  const std::size_t n = indices.size();
  if (n < 3) return {};
  if (mode == TINYGLTF_MODE_TRIANGLES)
    return {indices.begin(), indices.end() - static_cast<std::ptrdiff_t>(n % 3)};
  std::vector<std::uint32_t> out;
  out.reserve((n - 2) * 3);
  for (std::size_t i = 0; i + 2 < n; ++i) {
    const bool fan = mode == TINYGLTF_MODE_TRIANGLE_FAN;
    // A strip's odd triangles are turned so that all face the same way.
    const std::uint32_t a = fan ? indices[i + 1] : indices[i];
    const std::uint32_t b = fan ? indices[i + 2] : indices[i + 1 + i % 2];
    const std::uint32_t c = fan ? indices[0] : indices[i + 2 - i % 2];
    out.insert(out.end(), {a, b, c});
  }
  return out;
}

}  // namespace saccade::core
