// glTF files to scenes: geometry, transforms, materials, cameras, lights.
#include <gtest/gtest.h>

#include "core/image_io.h"
#include "core/scene/load.h"
#include "tests/unit/core/gltf_builder.h"
#include "tests/unit/core/temporary_folder.h"

namespace saccade::core {
namespace {

using nlohmann::json;
using saccade::tests::GltfBuilder;
using saccade::tests::TemporaryFolder;

Scene load(GltfBuilder& b, const LoadOptions& options = {}) {
  TemporaryFolder folder;
  return loadScene(b.write(folder / "a.glb"), options);
}

Vec3 faceNormal(const Mesh& m) {
  const Vec3 a = m.positions[m.indices[0]];
  return glm::normalize(glm::cross(m.positions[m.indices[1]] - a, m.positions[m.indices[2]] - a));
}

bool warned(const Scene& scene, const std::string& part) {
  for (const std::string& w : scene.warnings)
    if (w.find(part) != std::string::npos) return true;
  return false;
}

TEST(GltfLoad, ATriangle) {
  GltfBuilder b;
  const Scene scene = load(b);
  ASSERT_GE(scene.objects.size(), 1u);
  const Object& o = scene.objects[0];
  EXPECT_EQ(o.name, "thing");
  EXPECT_EQ(scene.meshOf(o).triangleCount(), 1u);
  EXPECT_EQ(scene.meshOf(o).normals[0], Vec3(0, 0, 1));
  EXPECT_EQ(o.bounds.hi, Vec3(1, 1, 0));
  EXPECT_FALSE(o.closed);
  EXPECT_TRUE(scene.defaultCamera);
  EXPECT_EQ(scene.materials[o.material].metallic, 1);  // glTF's default material
}

TEST(GltfLoad, IndicesOfEveryWidthStripsAndFans) {
  for (const int type : {5121, 5123, 5125}) {
    GltfBuilder b;
    b.primitive()["attributes"]["POSITION"] = b.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
    int indices = 0;
    if (type == 5121) indices = b.accessor<std::uint8_t>("SCALAR", type, {0, 1, 2, 3});
    if (type == 5123) indices = b.accessor<std::uint16_t>("SCALAR", type, {0, 1, 2, 3});
    if (type == 5125) indices = b.accessor<std::uint32_t>("SCALAR", type, {0, 1, 2, 3});
    b.primitive()["indices"] = indices;
    b.primitive()["mode"] = 5;
    const Scene scene = load(b);
    const Mesh& m = scene.meshes[0];
    ASSERT_EQ(m.triangleCount(), 2u);
    for (const Vec3& n : m.normals)
      EXPECT_EQ(n, Vec3(0, 0, 1));  // both triangles of the strip face the same way
  }
  GltfBuilder fan;
  fan.primitive()["attributes"]["POSITION"] = fan.floats("VEC3", {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  fan.primitive()["mode"] = 6;
  const Scene scene = load(fan);
  ASSERT_EQ(scene.meshes[0].triangleCount(), 2u);
  for (const Vec3& n : scene.meshes[0].normals) EXPECT_EQ(n, Vec3(0, 0, 1));
}

TEST(GltfLoad, IndexBeyondTheVerticesIsDroppedAndCounted) {
  GltfBuilder b;
  b.primitive()["indices"] = b.accessor<std::uint8_t>("SCALAR", 5121, {0, 1, 2, 0, 1, 200});
  const Scene scene = load(b);
  EXPECT_EQ(scene.meshes[0].triangleCount(), 1u);
  EXPECT_TRUE(warned(scene, "1 triangles were dropped"));
}

TEST(GltfLoad, PointsAreLeftOutWithAWarning) {
  GltfBuilder b;
  b.json["meshes"][0]["primitives"].push_back(b.primitive());
  b.json["meshes"][0]["primitives"][1]["mode"] = 0;
  const Scene scene = load(b);
  EXPECT_EQ(scene.triangleCount(), 1u + 2u);  // and the default light
  EXPECT_TRUE(warned(scene, "points or lines"));
}

TEST(GltfLoad, SparseAndNormalizedAccessors) {
  GltfBuilder b;
  const std::uint16_t index = 1;
  const float moved[] = {5, 0, 0};
  const int at = b.view(&index, 2), with = b.view(moved, 12);
  b.json["accessors"][0]["sparse"] = {{"count", 1},
                                      {"indices", {{"bufferView", at}, {"componentType", 5123}}},
                                      {"values", {{"bufferView", with}}}};
  b.primitive()["attributes"]["TEXCOORD_0"] =
      b.accessor<std::uint16_t>("VEC2", 5123, {0, 65535, 65535, 0, 0, 0}, true);
  b.primitive()["attributes"]["COLOR_0"] =
      b.accessor<std::uint8_t>("VEC4", 5121, {255, 0, 51, 255, 0, 0, 0, 0, 0, 0, 0, 0}, true);
  const Scene scene = load(b);
  const Mesh& m = scene.meshes[0];
  EXPECT_EQ(m.positions[1], Vec3(5, 0, 0));
  EXPECT_EQ(m.uv0[0], Vec2(0, 1));
  EXPECT_EQ(m.uv0[1], Vec2(1, 0));
  EXPECT_EQ(m.colors[0], Vec4(1, 0, 0.2f, 1));
}

TEST(GltfLoad, StridedViewsAndViewlessAccessors) {
  GltfBuilder b;
  const float interleaved[] = {0, 0, 0, 9, 2, 0, 0, 9, 0, 2, 0, 9};
  const int view = b.view(interleaved, sizeof interleaved);
  b.json["bufferViews"][view]["byteStride"] = 16;
  b.json["accessors"][0]["bufferView"] = view;
  b.json["accessors"].push_back({{"componentType", 5126}, {"count", 3}, {"type", "VEC2"}});
  b.primitive()["attributes"]["TEXCOORD_0"] = 1;
  const Scene scene = load(b);
  EXPECT_EQ(scene.objects[0].bounds.hi, Vec3(2, 2, 0));
  EXPECT_EQ(scene.meshes[0].uv0[2], Vec2(0));
}

TEST(GltfLoad, TransformsComposeAndScaleToMetres) {
  GltfBuilder b;
  b.json["nodes"] = {
      {{"translation", {1, 0, 0}}, {"rotation", {0, 0.70710678, 0, 0.70710678}}, {"children", {1}}},
      {{"scale", {2, 2, 2}}, {"mesh", 0}}};
  LoadOptions options;
  options.unitScale = 0.1f;
  const Scene scene = load(b, options);
  const Mesh& m = scene.meshes[0];
  EXPECT_LT(glm::length(m.positions[0] - Vec3(0.1f, 0, 0)), 1e-6f);
  EXPECT_LT(glm::length(m.positions[1] - Vec3(0.1f, 0, -0.2f)), 1e-6f);  // x turns to -z
  EXPECT_LT(glm::length(m.normals[0] - Vec3(1, 0, 0)), 1e-6f);
}

TEST(GltfLoad, MirroredNodesKeepTheirFronts) {
  GltfBuilder b;
  b.primitive()["attributes"]["NORMAL"] = b.floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  b.json["nodes"][0]["scale"] = {-1, 1, 1};
  const Scene scene = load(b);
  const Mesh& m = scene.meshes[0];
  EXPECT_EQ(m.positions[1].x, -1);
  EXPECT_EQ(faceNormal(m), Vec3(0, 0, 1));
  EXPECT_EQ(m.normals[0], Vec3(0, 0, 1));
}

TEST(GltfLoad, UnevenScaleTiltsNormalsRight) {
  GltfBuilder b;
  b.primitive()["attributes"]["POSITION"] = b.floats("VEC3", {0, 0, 0, 1, -1, 0, 0, 0, 1});
  b.primitive()["attributes"]["NORMAL"] = b.floats("VEC3", {-1, -1, 0, -1, -1, 0, -1, -1, 0});
  b.json["nodes"][0]["scale"] = {4, 1, 1};
  const Scene scene = load(b);
  const Mesh& m = scene.meshes[0];
  EXPECT_GT(glm::dot(m.normals[0], faceNormal(m)), 1 - 1e-6f);
}

TEST(GltfLoad, ZeroRotationIsRepaired) {
  GltfBuilder b;
  b.json["nodes"][0]["rotation"] = {0, 0, 0, 0};
  EXPECT_TRUE(warned(load(b), "1 node rotations"));
}

TEST(GltfLoad, MaterialWithItsExtensions) {
  GltfBuilder b;
  b.material() = {
      {"name", "m"},
      {"doubleSided", true},
      {"alphaMode", "MASK"},
      {"alphaCutoff", 0.25},
      {"emissiveFactor", {1, 0.5, 0}},
      {"pbrMetallicRoughness",
       {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.5}, {"roughnessFactor", 0.6}}},
      {"extensions",
       {{"KHR_materials_transmission", {{"transmissionFactor", 0.7}}},
        {"KHR_materials_ior", {{"ior", 1.33}}},
        {"KHR_materials_specular", {{"specularFactor", 0.8}, {"specularColorFactor", {1, 0.9, 2}}}},
        {"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}}};
  const Scene scene = load(b);
  const Material& m = scene.materials[0];
  EXPECT_EQ(m.name, "m");
  EXPECT_TRUE(m.doubleSided);
  EXPECT_EQ(m.alphaMode, AlphaMode::mask);
  EXPECT_EQ(m.alphaCutoff, 0.25f);
  EXPECT_EQ(m.emission, Vec3(4, 2, 0));
  EXPECT_EQ(m.baseColor, Vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(m.alpha, 0.4f);
  EXPECT_EQ(m.metallic, 0.5f);
  EXPECT_EQ(m.roughness, 0.6f);
  EXPECT_EQ(m.transmission, 0.7f);
  EXPECT_EQ(m.ior, 1.33f);
  EXPECT_EQ(m.specular, 0.8f);
  EXPECT_EQ(m.specularColor, Vec3(1, 0.9f, 2));
  EXPECT_FALSE(scene.defaultLight);
}

TEST(GltfLoad, FactorsOutOfRangeAreClampedAndCounted) {
  GltfBuilder b;
  b.material() = {{"pbrMetallicRoughness", {{"metallicFactor", -3}, {"roughnessFactor", 7}}},
                  {"extensions", {{"KHR_materials_ior", {{"ior", 0.5}}}}}};
  const Scene scene = load(b);
  EXPECT_EQ(scene.materials[0].metallic, 0);
  EXPECT_EQ(scene.materials[0].roughness, 1);
  EXPECT_EQ(scene.materials[0].ior, 1);
  EXPECT_TRUE(warned(scene, "3 material factors"));
}

TEST(GltfLoad, TexturesWithTheirColourSpace) {
  GltfBuilder b;
  const std::vector<std::uint8_t> png = encodePng(ImageRgba8(2, 1, {10, 20, 30, 255}));
  b.json["images"] = {{{"bufferView", b.view(png.data(), png.size())}, {"mimeType", "image/png"}}};
  b.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
  b.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
  b.material() = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                  {"normalTexture", {{"index", 0}, {"scale", 0.5}, {"texCoord", 1}}}};
  b.primitive()["attributes"]["TEXCOORD_0"] = b.floats("VEC2", {0, 0, 1, 0, 0, 1});
  b.primitive()["attributes"]["TEXCOORD_1"] = b.floats("VEC2", {0, 1, 1, 1, 0, 0});
  const Scene scene = load(b);
  ASSERT_EQ(scene.textures.size(), 2u);  // one image as colour and as data
  const Material& m = scene.materials[0];
  EXPECT_TRUE(scene.textures[m.baseColorTexture.texture].srgb);
  EXPECT_FALSE(scene.textures[m.normalTexture.texture].srgb);
  EXPECT_EQ(m.normalTexture.uvSet, 1);
  EXPECT_EQ(m.normalScale, 0.5f);
  const Texture& t = scene.textures[0];
  EXPECT_EQ(t.wrapS, Wrap::clamp);
  EXPECT_EQ(t.wrapT, Wrap::mirror);
  EXPECT_TRUE(t.nearest);
  EXPECT_EQ(t.image.at(1, 0), (Rgba8{10, 20, 30, 255}));
  EXPECT_EQ(scene.meshes[0].tangents[0], Vec4(1, 0, 0, 1));  // from the second UV set
}

TEST(GltfLoad, CamerasAndLightsFollowTheirNodes) {
  GltfBuilder b;
  b.json["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 1.0471976}, {"znear", 0.1}}}},
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 9}, {"znear", 0}}}}};
  b.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"},
       {"intensity", 3},
       {"color", {1, 0.5, 0}},
       {"range", 10},
       {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}}};
  b.json["nodes"].push_back({{"camera", 0}, {"name", "eye"}, {"translation", {0, 1, 5}}});
  b.json["nodes"].push_back({{"camera", 1}});
  b.json["nodes"].push_back({{"translation", {0, 3, 0}},
                             {"rotation", {-0.70710678, 0, 0, 0.70710678}},
                             {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  b.json["scenes"][0]["nodes"] = {0, 1, 2, 3};
  LoadOptions options;
  options.unitScale = 2;
  const Scene scene = load(b, options);
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.cameras[0].name, "eye");
  EXPECT_EQ(scene.cameras[0].eye, Vec3(0, 2, 10));
  EXPECT_EQ(scene.cameras[0].at, Vec3(0, 2, 9));
  EXPECT_NEAR(scene.cameras[0].fovYDegrees, 60, 1e-4f);
  EXPECT_FALSE(scene.defaultCamera);
  ASSERT_EQ(scene.lights.size(), 1u);
  const PunctualLight& light = scene.lights[0];
  EXPECT_EQ(light.type, PunctualLight::Type::spot);
  EXPECT_EQ(light.position, Vec3(0, 6, 0));
  EXPECT_LT(glm::length(light.direction - Vec3(0, -1, 0)), 1e-6f);
  EXPECT_EQ(light.intensity, Vec3(3, 1.5f, 0));
  EXPECT_EQ(light.range, 20);
  EXPECT_NEAR(light.cosOuter, std::cos(0.2f), 1e-6f);
  EXPECT_FALSE(scene.defaultLight);
}

TEST(GltfLoad, TheChosenSceneIsLoaded) {
  GltfBuilder b;
  b.json["nodes"].push_back({{"mesh", 0}, {"translation", {10, 0, 0}}});
  b.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  LoadOptions options;
  EXPECT_EQ(load(b).objects[0].bounds.lo.x, 0);
  options.scene = 1;
  EXPECT_EQ(load(b, options).objects[0].bounds.lo.x, 10);
  options.scene = 2;
  EXPECT_THROW(load(b, options), Error);
}

TEST(GltfLoad, GlbAndTextAgreeWhateverTheName) {
  TemporaryFolder folder;
  GltfBuilder b;
  b.json["buffers"] = {{{"byteLength", b.bytes.size()}, {"uri", "a b.bin"}}};
  std::ofstream(folder / "a b.bin", std::ios::binary)
      .write(reinterpret_cast<const char*>(b.bytes.data()), static_cast<std::streamsize>(b.bytes.size()));
  b.json["buffers"][0]["uri"] = "a%20b.bin";
  std::ofstream(folder / "text.unknown") << b.json.dump();
  const Scene text = loadScene(folder / "text.unknown", {});
  GltfBuilder plain;
  plain.write(folder / "binary.obj");
  const Scene binary = loadScene(folder / "binary.obj", {});
  EXPECT_EQ(text.meshes[0].positions, binary.meshes[0].positions);
}

}  // namespace
}  // namespace saccade::core
