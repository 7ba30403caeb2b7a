// The gate in front of tinygltf, which trusts what it reads (tinygltf 2.7.0 reads out of bounds for wrong
// image views, overflows the stack on deep JSON, accepts cycles and opens any path). Everything that could
// lead it or us astray is checked here, on the JSON, before it sees a byte; and it sees only the checked JSON
// and buffers that were read here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/load_budget.h"

namespace saccade::core {

struct EncodedImage {
  std::string name;  ///< for messages
  std::vector<std::uint8_t> bytes;
};

struct GatedGltf {
  /// Checked glTF 2.0 JSON without images, skins, morph targets and extras (but for materials'); buffer i has
  /// the URI "buffer<i>".
  std::string json;
  std::vector<std::vector<std::uint8_t>> buffers;  ///< exactly byteLength long
  std::vector<EncodedImage> images;
  Warnings warnings;
};

inline constexpr int kMaxJsonDepth = 64;
inline constexpr std::uint64_t kMaxAccessorElements = 1u << 28;  ///< elements of one accessor

/// Reads a .gltf or .glb (told apart by content) and the buffers and images it names. Throws core::Error
/// "FILE: ELEMENT: RULE" for the first breach: version other than 2.x, an extension that is required and not
/// supported, a reference, view or accessor out of range, a node with two parents or in a cycle, a URI that
/// leaves the scene's folder; more memory or time than `budget` has. What is
/// returned stays charged. Any thread.
GatedGltf readGatedGltf(const std::filesystem::path& file, LoadBudget& budget);

}  // namespace saccade::core
