// The rules of glTF 2.0 that the gate enforces on JSON whose properties checkSchema found in order.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/load_budget.h"
#include "core/scene/gltf_contents.h"
#include "core/scene/gltf_element.h"
#include "core/scene/repairs.h"

namespace saccade::core {

/// 2.x is read. Before checkSchema: an older file fails with its version, not with what changed since.
void checkVersion(const Element& root);
/// Required extensions (known ones in `supported`); warns of optional ones that are not supported.
void checkAsset(const Element& root, std::span<const char* const> supported, Warnings& warnings,
                Repairs& repairs);
/// bufferViews and accessors against the buffers' lengths, sparse indices against their content, contents
/// against their stated bounds. The result points into the buffers.
std::vector<GltfAccessor> checkAccessors(const Element& root,
                                         const std::vector<std::vector<std::uint8_t>>& buffers,
                                         Repairs& repairs, LoadBudget& budget);
/// What accessors and bufferViews are used for: one thing each.
void checkUsage(const Element& root, Repairs& repairs);
/// Primitives: formats, counts, contents, indices, morph targets, what their materials ask for.
void checkMeshes(const Element& root, const std::vector<GltfAccessor>& accessors, Repairs& repairs,
                 LoadBudget& budget);
/// Lights, cameras, nodes (transforms, parents, cycles) and scenes.
void checkGraph(Json& root, const std::string& file, Repairs& repairs);
/// Samplers and channels. Those that this program does not play (morph targets, pointers, nodes with a
/// matrix) are taken out of `root` and counted; all that stay move a node's translation, rotation or scale
/// and have finite values at times that increase strictly.
void checkAnimations(Json& root, const std::string& file, const std::vector<GltfAccessor>& accessors,
                     Repairs& repairs, LoadBudget& budget);

}  // namespace saccade::core
