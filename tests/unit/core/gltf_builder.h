// Writes small glTF files for the tests.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace saccade::tests {

/// A one-triangle scene whose JSON the test may bend; buffers are written as data URIs or as a GLB.
struct GltfBuilder {
  nlohmann::json json;
  std::vector<std::uint8_t> bytes;

  GltfBuilder() {
    json = {{"asset", {{"version", "2.0"}}},
            {"scene", 0},
            {"scenes", {{{"nodes", {0}}}}},
            {"nodes", {{{"mesh", 0}, {"name", "thing"}}}}};
    const int p = floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
    json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", p}}}}}}}};
  }

  /// Appends data as a view of its own (aligned to 4) and an accessor; returns the accessor's index.
  template <class T>
  int accessor(const char* type, int componentType, const std::vector<T>& values, bool normalized = false) {
    const int components = std::string(type) == "SCALAR" ? 1 : type[3] - '0';
    json["accessors"].push_back({{"bufferView", view(values.data(), values.size() * sizeof(T))},
                                 {"componentType", componentType},
                                 {"count", values.size() / static_cast<std::size_t>(components)},
                                 {"type", type}});
    if (normalized) json["accessors"].back()["normalized"] = true;
    return static_cast<int>(json["accessors"].size()) - 1;
  }
  int floats(const char* type, const std::vector<float>& values) { return accessor(type, 5126, values); }

  int view(const void* data, std::size_t size) {
    while (bytes.size() % 4 != 0) bytes.push_back(0);
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", size}});
    const auto* from = static_cast<const std::uint8_t*>(data);
    bytes.insert(bytes.end(), from, from + size);
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }

  nlohmann::json& primitive() { return json["meshes"][0]["primitives"][0]; }
  nlohmann::json& material() {
    if (!json.contains("materials")) {
      json["materials"] = nlohmann::json::array({nlohmann::json::object()});
      primitive()["material"] = 0;
    }
    return json["materials"][0];
  }

  std::string glb() {
    while (bytes.size() % 4 != 0) bytes.push_back(0);
    nlohmann::json whole = json;
    if (!whole.contains("buffers")) whole["buffers"] = {{{"byteLength", bytes.size()}}};
    std::string text = whole.dump();
    while (text.size() % 4 != 0) text += ' ';
    std::string out = "glTF";
    const auto word = [&](std::uint32_t w) { out.append(reinterpret_cast<const char*>(&w), 4); };
    word(2);
    word(static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + bytes.size()));
    word(static_cast<std::uint32_t>(text.size()));
    word(0x4E4F534A);
    out += text;
    word(static_cast<std::uint32_t>(bytes.size()));
    word(0x004E4942);
    out.append(bytes.begin(), bytes.end());
    return out;
  }

  std::filesystem::path write(const std::filesystem::path& file) {
    std::ofstream(file, std::ios::binary) << glb();
    return file;
  }
};

}  // namespace saccade::tests
