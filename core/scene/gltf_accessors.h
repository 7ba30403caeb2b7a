// Accessor contents as floats and indices. Ranges were checked by the gate.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math/types.h"
#include "core/scene/tinygltf.h"

namespace saccade::core {

/// All components of all elements, element after element; normalised integers as in glTF 2.0, 3.6.2.2; sparse
/// substitution done.
std::vector<float> readFloats(const tinygltf::Model& model, int accessor);
std::vector<Vec2> readVec2(const tinygltf::Model& model, int accessor);
std::vector<Vec3> readVec3(const tinygltf::Model& model, int accessor);
/// VEC3 gets w = 1.
std::vector<Vec4> readVec4(const tinygltf::Model& model, int accessor);
std::vector<std::uint32_t> readIndices(const tinygltf::Model& model, int accessor);

/// Triangle list from glTF mode 4 (list), 5 (strip) or 6 (fan); an incomplete last triangle is dropped.
std::vector<std::uint32_t> asTriangles(const std::vector<std::uint32_t>& indices, int mode);

}  // namespace saccade::core
