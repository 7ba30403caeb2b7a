// glTF 2.0, 3.6: bufferViews and accessors against the bytes they name.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/scene/gltf_gate.h"
#include "core/scene/gltf_rules.h"

namespace saccade::core {
namespace {

constexpr std::uint64_t kUnsignedInt = 5125, kFloat = 5126;

struct ViewSpan {
  const std::uint8_t* data;
  std::uint64_t length;
  std::uint64_t offset;  ///< in its buffer
  std::uint64_t stride;
};

ViewSpan checkView(const Element& view, const std::vector<std::vector<std::uint8_t>>& buffers,
                   Repairs& repairs) {
  const auto& buffer = buffers[view.index("buffer", buffers.size(), "buffers")];
  const std::uint64_t offset = view.integerOr("byteOffset", 0, 0, buffer.size());
  const std::uint64_t length = view.integer("byteLength", 1, buffer.size());
  if (length > buffer.size() - offset)
    view.refuse("reaches byte " + std::to_string(offset + length) + " of a buffer of " +
                std::to_string(buffer.size()));
  const std::uint64_t stride = view.integerOr("byteStride", 0, 4, 252);
  if (stride % 4 != 0)
    repairs.add("byteStrides are no multiples of 4 and were taken as they are", view.path());
  if (stride > length)
    repairs.add("byteStrides are longer than their bufferView and were taken as they are", view.path());
  return {buffer.data() + offset, length, offset, stride};
}

/// `count` elements of `bytes` each (the last one without its padding), `stride` apart, from `offset`, must
/// lie within the view.
void checkRange(const Element& who, const ViewSpan& view, std::uint64_t offset, std::uint64_t count,
                std::uint64_t bytes, std::uint64_t stride) {
  // All of these are below 2^60, so the sums below cannot wrap.
  if (stride < bytes) who.refuse("byteStride is smaller than one element");
  if (offset > view.length || (count - 1) * stride + bytes > view.length - offset)
    who.refuse("reaches beyond its bufferView of " + std::to_string(view.length) + " bytes");
}

GltfAccessor::Sparse checkSparse(const Element& accessor, std::uint64_t count, std::uint64_t elementBytes,
                                 const std::vector<ViewSpan>& views) {
  const Element sparse = accessor.member("sparse");
  const std::uint64_t n = sparse.integer("count", 1, count);
  const Element indices = sparse.member("indices"), values = sparse.member("values");
  const ViewSpan& indexView = views[indices.index("bufferView", views.size(), "bufferViews")];
  const ViewSpan& valueView = views[values.index("bufferView", views.size(), "bufferViews")];
  const std::uint64_t bytes = gltfComponentBytes(indices.integer("componentType", 5121, 5125));
  const std::uint64_t offset = indices.integerOr("byteOffset", 0, 0, indexView.length);
  const std::uint64_t valueOffset = values.integerOr("byteOffset", 0, 0, valueView.length);
  checkRange(indices, indexView, offset, n, bytes, bytes);
  checkRange(values, valueView, valueOffset, n, elementBytes, elementBytes);
  std::uint64_t before = 0;
  for (std::uint64_t i = 0; i < n; ++i) {
    const std::uint64_t index = unsignedFrom(indexView.data + offset + i * bytes, bytes);
    if (index >= count)
      indices.refuse("names element " + std::to_string(index) + " of " + std::to_string(count));
    if (i > 0 && index <= before) indices.refuse("must increase strictly");
    before = index;
  }
  return {n, bytes, indexView.data + offset, valueView.data + valueOffset};
}

/// Alignment is a rule for readers that cast pointers; ours copies bytes.
void checkAlignment(const Element& accessor, const GltfAccessor& a, std::uint64_t offset,
                    std::uint64_t viewOffset, Repairs& repairs) {
  const std::uint64_t unit = a.rows == a.components ? gltfComponentBytes(a.componentType) : 4;
  if (offset % unit != 0 || (offset + viewOffset) % unit != 0)
    repairs.add("accessors are not aligned and were read as they stand", accessor.path());
}

void checkStatedBounds(const Element& accessor, const GltfAccessor& a, Repairs& repairs) {
  if (!accessor.has("min") && !accessor.has("max")) return;
  const auto stated = [&](const char* key) {
    std::vector<float> out;
    if (!accessor.has(key)) return out;
    for (const Json& x : accessor.json()[key]) out.push_back(x.get<float>());
    if (out.size() != a.components)
      repairs.add("stated bounds of accessors have the wrong length and were ignored", accessor.path());
    return out.size() == a.components ? out : std::vector<float>();
  };
  const std::vector<float> lo = stated("min"), hi = stated("max");
  if ((lo.empty() && hi.empty()) || (!a.data && a.sparse.count == 0)) return;
  constexpr float kFar = std::numeric_limits<float>::infinity();
  std::array<float, 16> least, most;
  least.fill(kFar), most.fill(-kFar);
  GltfAccessor raw = a;
  raw.normalized = false;  // bounds are stated of the integers
  forEachElement(raw, [&](std::uint64_t, const float* x) {
    for (std::size_t c = 0; c < a.components; ++c) {
      least[c] = std::min(least[c], x[c]);
      most[c] = std::max(most[c], x[c]);
    }
  });
  // Writers round: bounds that are off by less than this of the contents' extent are no fault.
  constexpr float kRounding = 1e-5f;
  bool same = true;
  for (std::size_t c = 0; c < a.components; ++c) {
    const float slack = kRounding * std::max(std::abs(least[c]), std::abs(most[c]));
    const auto near = [&](float x, float y) { return std::abs(x - y) <= slack; };
    same = same && (lo.empty() || near(lo[c], least[c])) && (hi.empty() || near(hi[c], most[c]));
  }
  // What sparse values replace is in `least` and `most`, so that a difference says nothing there.
  if (!same && a.sparse.count == 0)
    repairs.add("stated bounds of accessors do not fit their contents and were ignored", accessor.path());
}

void checkFinite(const Element& accessor, const GltfAccessor& a, Repairs& repairs) {
  if (a.componentType != kFloat) return;
  std::uint64_t bad = 0;
  forEachElement(a, [&](std::uint64_t, const float* x) {
    for (std::size_t c = 0; c < a.components; ++c) bad += !std::isfinite(x[c]);
  });
  if (bad > 0)
    repairs.add("numbers in accessors are not finite; triangles that use them are dropped", accessor.path(),
                bad);
}

GltfAccessor checkAccessor(const Element& accessor, const std::vector<ViewSpan>& views, Repairs& repairs) {
  GltfAccessor a;
  const std::string type = accessor.text("type");
  a.componentType = accessor.integer("componentType", 5120, 5126);
  a.components = gltfComponents(type);
  a.rows = type.starts_with("MAT") ? static_cast<std::uint64_t>(type[3] - '0') : a.components;
  a.count = accessor.integer("count", 1, kMaxAccessorElements);
  a.normalized = accessor.has("normalized") && accessor.json()["normalized"].get<bool>();
  if (a.normalized && a.componentType >= kUnsignedInt)
    repairs.add("accessors of 32-bit components are marked as normalised, which was ignored",
                accessor.path());
  const std::uint64_t bytes = elementBytes(a);
  // The padding behind a matrix' last column.
  const std::uint64_t unpadded =
      bytes - (bytes / (a.components / a.rows) - a.rows * gltfComponentBytes(a.componentType));
  if (accessor.has("bufferView")) {
    const ViewSpan& view = views[accessor.index("bufferView", views.size(), "bufferViews")];
    const std::uint64_t offset = accessor.integerOr("byteOffset", 0, 0, view.length);
    a.stride = view.stride == 0 ? bytes : view.stride;
    if (a.stride < bytes) accessor.refuse("byteStride is smaller than one element");
    checkRange(accessor, view, offset, a.count, unpadded, a.stride);
    checkAlignment(accessor, a, offset, view.offset, repairs);
    a.data = view.data + offset;
  } else if (accessor.has("byteOffset")) {
    repairs.add("byteOffsets of accessors without a bufferView were ignored", accessor.path());
  }
  if (accessor.has("sparse")) a.sparse = checkSparse(accessor, a.count, bytes, views);
  return a;
}

}  // namespace

std::vector<GltfAccessor> checkAccessors(const Element& root,
                                         const std::vector<std::vector<std::uint8_t>>& buffers,
                                         Repairs& repairs, LoadBudget& budget) {
  std::vector<ViewSpan> views;
  for (const Element& view : root.array("bufferViews")) views.push_back(checkView(view, buffers, repairs));
  std::vector<GltfAccessor> out;
  for (const Element& accessor : root.array("accessors")) {
    budget.checkTime();
    out.push_back(checkAccessor(accessor, views, repairs));
    checkStatedBounds(accessor, out.back(), repairs);
    checkFinite(accessor, out.back(), repairs);
  }
  return out;
}

}  // namespace saccade::core
