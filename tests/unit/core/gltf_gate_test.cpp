// The gate: what is broken, hostile or unknown is refused in one line that names it.
#include "core/scene/gltf_gate.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <functional>

#include "core/scene/load.h"
#include "tests/unit/core/gltf_builder.h"
#include "tests/unit/core/temporary_folder.h"

namespace saccade::core {
namespace {

using nlohmann::json;
using saccade::tests::GltfBuilder;
using saccade::tests::TemporaryFolder;

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// The message with which a file is refused; empty when it is not.
std::string refusal(const std::filesystem::path& file) {
  try {
    loadScene(file, {});
    return "";
  } catch (const Error& e) {
    return e.what();
  }
}

std::string refusalOf(const std::function<void(GltfBuilder&)>& bend) {
  TemporaryFolder folder;
  GltfBuilder builder;
  bend(builder);
  return refusal(builder.write(folder / "a.glb"));
}

#define EXPECT_REFUSED(text, ...)                                                       \
  do {                                                                                  \
    const std::string message = refusalOf(__VA_ARGS__);                                 \
    EXPECT_NE(message.find(text), std::string::npos) << "message: '" << message << "'"; \
    EXPECT_EQ(message.find('\n'), std::string::npos);                                   \
  } while (false)

TEST(GltfGate, TheUnbentFileLoads) {
  EXPECT_EQ(refusalOf([](GltfBuilder&) {}), "");
}

TEST(GltfGate, Versions) {
  EXPECT_REFUSED("1.0", [](GltfBuilder& b) { b.json["asset"]["version"] = "1.0"; });
  EXPECT_REFUSED("lacks 'asset'", [](GltfBuilder& b) { b.json.erase("asset"); });
  EXPECT_REFUSED("2.1", [](GltfBuilder& b) { b.json["asset"]["minVersion"] = "2.1"; });
}

TEST(GltfGate, ExtensionsByName) {
  EXPECT_REFUSED("FOO_bar", [](GltfBuilder& b) { b.json["extensionsRequired"] = {"FOO_bar"}; });
  EXPECT_REFUSED("KHR_draco_mesh_compression",
                 [](GltfBuilder& b) { b.json["extensionsRequired"] = {"KHR_draco_mesh_compression"}; });
  TemporaryFolder folder;
  GltfBuilder b;
  b.json["extensionsUsed"] = {"FOO_optional", "KHR_materials_ior"};
  const Scene scene = loadScene(b.write(folder / "a.glb"), {});
  int named = 0;
  for (const std::string& w : scene.warnings) {
    named += w.find("FOO_optional") != std::string::npos;
    EXPECT_EQ(w.find("KHR_materials_ior"), std::string::npos);
  }
  EXPECT_EQ(named, 1);
}

TEST(GltfGate, DeepJson) {
  TemporaryFolder folder;
  write(folder / "deep.gltf", "{\"asset\":" + std::string(20000, '[') + std::string(20000, ']') + "}");
  EXPECT_NE(refusal(folder / "deep.gltf").find("nested deeper"), std::string::npos);
}

TEST(GltfGate, NumbersThatAreNone) {
  TemporaryFolder folder;
  write(folder / "inf.gltf", R"({"asset":{"version":"2.0"},"nodes":[{"translation":[1e999,0,0]}]})");
  EXPECT_NE(refusal(folder / "inf.gltf"), "");
  write(folder / "nan.gltf", R"({"asset":{"version":"2.0"},"nodes":[{"translation":[NaN,0,0]}]})");
  EXPECT_NE(refusal(folder / "nan.gltf"), "");
}

TEST(GltfGate, AccessorsOutOfRange) {
  EXPECT_REFUSED("beyond its bufferView", [](GltfBuilder& b) { b.json["accessors"][0]["count"] = 4; });
  EXPECT_REFUSED("'count'", [](GltfBuilder& b) { b.json["accessors"][0]["count"] = 0; });
  EXPECT_REFUSED("'count'", [](GltfBuilder& b) { b.json["accessors"][0]["count"] = 1ull << 62; });
  EXPECT_REFUSED("'count'", [](GltfBuilder& b) { b.json["accessors"][0]["count"] = -1; });
  EXPECT_REFUSED("'byteOffset'",
                 [](GltfBuilder& b) { b.json["accessors"][0]["byteOffset"] = 18446744073709551612ull; });
  EXPECT_REFUSED("beyond its bufferView", [](GltfBuilder& b) { b.json["accessors"][0]["byteOffset"] = 4; });
  EXPECT_REFUSED("bufferView", [](GltfBuilder& b) { b.json["accessors"][0]["bufferView"] = 9; });
  EXPECT_REFUSED("componentType", [](GltfBuilder& b) { b.json["accessors"][0]["componentType"] = 5124; });
  EXPECT_REFUSED("type", [](GltfBuilder& b) { b.json["accessors"][0]["type"] = "VEC5"; });
  EXPECT_REFUSED("byteStride", [](GltfBuilder& b) { b.json["bufferViews"][0]["byteStride"] = 8; });
  EXPECT_REFUSED("'byteLength'", [](GltfBuilder& b) { b.json["bufferViews"][0]["byteLength"] = 1 << 20; });
  EXPECT_REFUSED("reaches byte", [](GltfBuilder& b) { b.json["bufferViews"][0]["byteOffset"] = 8; });
  EXPECT_REFUSED("states", [](GltfBuilder& b) { b.json["buffers"] = {{{"byteLength", 400}}}; });
  EXPECT_REFUSED("'byteLength'", [](GltfBuilder& b) {
    b.json["buffers"] = {{{"byteLength", 10000000000000ull}}};
  });
}

TEST(GltfGate, SparseIndices) {
  const auto sparse = [](std::vector<std::uint16_t> indices) {
    return [indices](GltfBuilder& b) {
      const int at = b.view(indices.data(), indices.size() * 2);
      std::vector<float> values(3 * indices.size());
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i * i);
      const int with = b.view(values.data(), values.size() * 4);
      b.json["accessors"][0]["sparse"] = {{"count", indices.size()},
                                          {"indices", {{"bufferView", at}, {"componentType", 5123}}},
                                          {"values", {{"bufferView", with}}}};
    };
  };
  EXPECT_EQ(refusalOf(sparse({0, 2})), "");
  EXPECT_REFUSED("element 3", sparse({3}));
  EXPECT_REFUSED("increase", sparse({1, 1}));
}

TEST(GltfGate, ReferencesOutOfRange) {
  EXPECT_REFUSED("POSITION", [](GltfBuilder& b) { b.primitive()["attributes"]["POSITION"] = 1; });
  EXPECT_REFUSED("meshes", [](GltfBuilder& b) { b.json["nodes"][0]["mesh"] = 1; });
  EXPECT_REFUSED("materials", [](GltfBuilder& b) { b.primitive()["material"] = 0; });
  EXPECT_REFUSED("scenes", [](GltfBuilder& b) { b.json["scene"] = 99; });
  EXPECT_REFUSED("nodes", [](GltfBuilder& b) { b.json["scenes"][0]["nodes"] = {5}; });
  EXPECT_REFUSED("textures", [](GltfBuilder& b) { b.material()["normalTexture"] = {{"index", 0}}; });
  EXPECT_REFUSED("images", [](GltfBuilder& b) { b.json["textures"] = {{{"source", 2}}}; });
  EXPECT_REFUSED(
      "lights", [](GltfBuilder& b) { b.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0; });
  EXPECT_REFUSED("must be VEC3", [](GltfBuilder& b) {
    b.primitive()["attributes"]["NORMAL"] = b.floats("VEC2", {0, 0, 0, 0, 0, 0});
  });
  EXPECT_REFUSED("another count", [](GltfBuilder& b) {
    b.primitive()["attributes"]["NORMAL"] = b.floats("VEC3", {0, 0, 1});
  });
}

TEST(GltfGate, ImageViewOutOfRange) {
  // tinygltf 2.7.0 reads out of bounds here.
  EXPECT_REFUSED("bufferView", [](GltfBuilder& b) {
    b.json["images"] = {{{"bufferView", 77}, {"mimeType", "image/png"}}};
  });
}

TEST(GltfGate, NodeForest) {
  EXPECT_REFUSED("cycle", [](GltfBuilder& b) {
    b.json["nodes"] = {{{"children", {1}}}, {{"children", {0}}}};
  });
  EXPECT_REFUSED("cycle", [](GltfBuilder& b) { b.json["nodes"] = {{{"children", {0}}}}; });
  EXPECT_REFUSED("two parents", [](GltfBuilder& b) {
    b.json["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, json::object()};
    b.json["scenes"][0]["nodes"] = {0, 1};
  });
  EXPECT_REFUSED("not a root", [](GltfBuilder& b) {
    b.json["nodes"] = {{{"children", {1}}}, {{"mesh", 0}}};
    b.json["scenes"][0]["nodes"] = {0, 1};
  });
}

TEST(GltfGate, UrisStayInTheFolder) {
  TemporaryFolder folder;
  std::filesystem::create_directories(folder / "scene");
  std::filesystem::create_directories(folder / "scene/sub");
  const std::string data(36, '\0');
  write(folder / "outside.bin", data);
  write(folder / "scene/inside.bin", data);
  std::filesystem::create_symlink(folder / "outside.bin", folder / "scene/link.bin");
  ::mkfifo((folder / "scene/fifo.bin").c_str(), 0600);
  const auto with = [&](const std::string& uri) {
    GltfBuilder b;
    b.json["buffers"] = {{{"byteLength", 36}, {"uri", uri}}};
    return refusal(b.write(folder / "scene/a.glb"));
  };
  // The triangle of zeros has no area, so that the file is refused, but only after its buffer was read.
  EXPECT_NE(with("inside.bin").find("holds no triangle"), std::string::npos);
  EXPECT_NE(with("%69nside.bin").find("holds no triangle"), std::string::npos);
  EXPECT_NE(with("../outside.bin").find("leaves the scene's folder"), std::string::npos);
  EXPECT_NE(with("%2e%2e/outside.bin").find("leaves the scene's folder"), std::string::npos);
  EXPECT_NE(with("sub/../../outside.bin").find("leaves the scene's folder"), std::string::npos);
  EXPECT_NE(with((folder / "outside.bin").string()).find("absolute"), std::string::npos);
  EXPECT_NE(with("link.bin").find("through a link"), std::string::npos);
  EXPECT_NE(with("fifo.bin").find("not a regular file"), std::string::npos);
  EXPECT_NE(with("sub").find("not a regular file"), std::string::npos);
  EXPECT_NE(with("missing.bin").find("does not exist"), std::string::npos);
  EXPECT_NE(with("http://example.org/a.bin").find("scheme"), std::string::npos);
  EXPECT_NE(with("file:///etc/passwd").find("scheme"), std::string::npos);
  EXPECT_NE(with("data:application/octet-stream;base64,@@@@").find("base64"), std::string::npos);
  EXPECT_NE(with("").find("no file name"), std::string::npos);
}

}  // namespace
}  // namespace saccade::core
