// The gate in front of tinyobjloader, which takes indices below zero and numbers that are none as they come
// (2.0.0rc10). It sees only lines that were checked and rewritten here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/load_budget.h"
#include "core/scene/repairs.h"

namespace saccade::core {

inline constexpr std::size_t kMaxObjLine = 1u << 20;       ///< bytes
inline constexpr std::uint64_t kMaxPolygonCorners = 4096;  ///< more are no polygon anybody models
/// Sum over the polygons of corners squared, which is what triangulating them costs.
inline constexpr std::uint64_t kMaxPolygonWork = 4'000'000'000;

/// The lines of an OBJ file that matter here (v, vt, vn, f, o, g, s, usemtl, mtllib), with all numbers
/// finite, all indices positive and in range. Faces that name a vertex that is not there, or whose vertex has
/// a coordinate that is no number, and faces of two corners are dropped and counted in `repairs`; texture and
/// normal indices out of range are taken away. Throws core::Error "FILE: line N: RULE" for a line longer than
/// kMaxObjLine, a polygon of more than kMaxPolygonCorners, more polygons than kMaxPolygonWork allows, and
/// when `budget` is used up. Any thread.
std::string readGatedObj(const std::filesystem::path& file, Repairs& repairs, LoadBudget& budget);

/// A material library, after the same rules for lines. Charges what its materials will take.
std::string readGatedMtl(const std::filesystem::path& file, LoadBudget& budget);

}  // namespace saccade::core
