// A scene written as a lit GLB: what comes back, and glTF's own rules.
#include "core/scene/export_gltf.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>
#include <set>

#include "core/atomic_file.h"
#include "core/scene/glb_chunks.h"
#include "core/scene/load.h"
#include "tests/unit/core/scene_shapes.h"
#include "tests/unit/core/temporary_folder.h"

namespace saccade::core {
namespace {

using namespace saccade::tests;
using nlohmann::json;

/// Two unit quads with every attribute of a file.
Mesh quads() {
  Mesh m;
  m.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, -1}, {1, 1, -1}};
  m.normals.assign(6, Vec3(0, 0, 1));
  m.tangents.assign(6, Vec4(1, 0, 0, 1));
  for (const Vec3& p : m.positions) {
    m.uv0.emplace_back(p.x + 1, p.y);
    m.uv1.emplace_back(p.y, p.z - p.x);
    m.colors.emplace_back(0.5f, p.x, p.y, 1);
  }
  m.indices = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2};
  return m;
}

Texture dots(int side, bool srgb) {
  Texture t;
  t.name = "dots " + std::to_string(side);
  t.image = ImageRgba8(side, side, {10, 20, 30, 40});
  t.image.at(1, 0) = {200, 100, 50, 255};
  t.srgb = srgb;
  return t;
}

/// Materials by name: plain, everything (each factor and slot set), ward, unlit, second (uses uv1 alone).
std::vector<Material> manyMaterials() {
  Material plain = lambert();
  plain.emission = Vec3(3, 2, 0.5f);
  Material all;
  all.name = "everything";
  all.baseColor = Vec3(0.2f, 0.4f, 0.6f);
  all.alpha = 0.8f;
  all.alphaMode = AlphaMode::mask;
  all.alphaCutoff = 0.3f;
  all.metallic = 0.25f;
  all.roughness = 0.35f;
  all.normalScale = 0.7f;
  all.emission = Vec3(0.1f, 0, 0.2f);
  all.ior = 1.4f;
  all.specular = 0.6f;
  all.specularColor = Vec3(0.9f, 0.8f, 0.7f);
  all.transmission = 0.3f;
  all.attenuationColor = Vec3(0.5f, 0.6f, 0.7f);
  all.attenuationDistance = 0.4f;
  all.dispersion = 0.2f;
  all.clearcoat = 0.5f;
  all.clearcoatRoughness = 0.15f;
  all.clearcoatNormalScale = 0.4f;
  all.anisotropy = 0.6f;
  all.anisotropyRotation = 0.5f;
  all.sheenColor = Vec3(0.1f, 0.2f, 0.3f);
  all.sheenRoughness = 0.45f;
  all.iridescence = 0.7f;
  all.iridescenceIor = 1.25f;
  all.iridescenceThicknessMin = 150;
  all.iridescenceThicknessMax = 350;
  all.doubleSided = true;
  all.baseColorTexture = all.emissionTexture =
      all.sheenColorTexture = {0, 0, Vec2(0.1f, 0.2f), 0.3f, Vec2(2, 3)};
  all.metallicRoughnessTexture = all.normalTexture = all.transmissionTexture = all.clearcoatTexture =
      all.clearcoatRoughnessTexture = all.clearcoatNormalTexture = all.anisotropyTexture =
          all.iridescenceTexture = all.iridescenceThicknessTexture = {1};
  all.specularTexture = all.specularColorTexture = all.sheenRoughnessTexture = {0};
  Material ward = lambert();
  ward.name = "ward";
  ward.ward = WardLobe{Vec3(0.1f), Vec3(0.3f), 0.05f, 0.2f};
  ward.baseColor = ward.ward->diffuse;
  Material unlit = lambert();
  unlit.name = "unlit";
  unlit.unlit = true;
  Material second = lambert();
  second.name = "second";
  second.baseColorTexture = {0, 1};
  return {plain, all, ward, unlit, second};
}

/// One object of each material under a turned, stretched and mirrored tree of nodes, and the default panel.
Scene manyThings() {
  Scene scene;
  scene.path = "memory";
  scene.textures = {dots(4, true), dots(8, false)};
  scene.textures[0].wrapS = Wrap::mirror;
  scene.textures[1].wrapT = Wrap::clamp;
  scene.textures[1].nearest = true;
  scene.materials = manyMaterials();
  Node root;
  root.name = "root";
  root.localToParent = root.localToWorld =
      glm::rotate(glm::translate(Mat4(1), Vec3(1, 2, 3)), 0.7f, Vec3(0, 1, 0));
  scene.nodes = {root};
  for (int i = 0; i < static_cast<int>(scene.materials.size()); ++i) {
    Node node;
    node.name = "node of " + scene.materials[static_cast<std::size_t>(i)].name;
    node.parent = 0;
    node.localToParent = glm::scale(glm::translate(Mat4(1), Vec3(3.0f * static_cast<float>(i), 0, 0)),
                                    Vec3(i == 2 ? -2 : 1.5f, 1, 1));
    node.localToWorld = root.localToWorld * node.localToParent;
    scene.nodes.push_back(node);
    Mesh mesh = quads();
    mesh.instanced = true;
    Object o;
    o.name = node.name;
    o.node = i + 1;
    o.material = i;
    o.meshToWorld = node.localToWorld;
    scene.add(o, mesh);
  }
  Camera camera;
  camera.name = "eye";
  camera.eye = Vec3(1, 2, 9);
  camera.at = Vec3(1, 1, 0);
  camera.fovYDegrees = 40;
  scene.cameras = {camera};
  completeScene(scene, {});
  for (Mesh& mesh : scene.meshes)
    for (const Vec3& p : mesh.positions) mesh.lightmapUv.push_back(0.1f + 0.02f * Vec2(p.y, p.x));
  for (std::size_t o = 0; o < scene.objects.size(); ++o)
    scene.objects[o].lightmapScaleOffset = Vec4(0.2f, 0.3f, 0.2f * static_cast<float>(o), 0.5f);
  return scene;
}

LightTextures lightOf(const Scene& scene) {
  LightTextures light;
  light.emission = ImageRgba8(16, 16, {255, 128, 0, 255});
  light.lightmap = ImageRgba8(8, 8, {1, 2, 3, 255});
  light.materials.resize(scene.materials.size());
  light.materials[0] = {7, 2};
  light.materials[1] = {0.5f, 3};
  return light;
}

Scene reloaded(const Scene& scene, const std::string& name) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / name;
  writeFileAtomically(file, exportGltf(scene, lightOf(scene)));
  return loadScene(file, {});
}

json jsonOf(const std::vector<std::uint8_t>& glb) {
  Repairs repairs;
  const GltfParts parts = splitGlb(glb, "export", repairs);
  Warnings warnings;
  repairs.report(warnings);
  EXPECT_TRUE(warnings.empty());
  return json::parse(parts.json.begin(), parts.json.end());
}

void expectSameSlot(const Scene& a, const TextureSlot& s, const Scene& b, const TextureSlot& t, int uvSet) {
  ASSERT_EQ(static_cast<bool>(s), static_cast<bool>(t));
  if (!s) return;
  const Texture &x = a.textures[static_cast<std::size_t>(s.texture)],
                &y = b.textures[static_cast<std::size_t>(t.texture)];
  EXPECT_EQ(x.image.pixels(), y.image.pixels());
  EXPECT_EQ(std::tuple(x.wrapS, x.wrapT, x.nearest), std::tuple(y.wrapS, y.wrapT, y.nearest));
  EXPECT_EQ(std::tuple(uvSet, s.offset, s.rotation, s.scale),
            std::tuple(t.uvSet, t.offset, t.rotation, t.scale));
}

TEST(ExportGltf, MaterialsComeBackWithoutAWarning) {
  const Scene from = manyThings(), to = reloaded(from, "materials.glb");
  EXPECT_EQ(to.warnings, Warnings{});
  ASSERT_EQ(from.materials.size(), to.materials.size());
  for (std::size_t i = 0; i < from.materials.size(); ++i) {
    const Material &a = from.materials[i], &b = to.materials[i];
    SCOPED_TRACE(a.name);
    EXPECT_EQ(a.name, b.name);
    const auto factors = [](const Material& m) {
      return std::tuple(m.baseColor, m.alpha, m.metallic, m.normalScale, m.ior, m.specular,
                        m.specular * m.specularColor, m.transmission, m.thinWalled, m.attenuationColor,
                        m.attenuationDistance, m.dispersion, m.clearcoat, m.clearcoatRoughness,
                        m.clearcoatNormalScale, m.anisotropy, m.anisotropyRotation, m.sheenColor,
                        m.sheenRoughness, m.iridescence, m.iridescenceIor, m.iridescenceThicknessMin,
                        m.iridescenceThicknessMax, m.alphaMode, m.alphaCutoff, m.doubleSided, m.unlit);
    };
    EXPECT_TRUE(factors(a) == factors(b));
    if (!a.ward) {
      EXPECT_EQ(a.roughness, b.roughness);
    }
    for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(a.emission[c], b.emission[c]);
    ASSERT_EQ(a.ward.has_value(), b.ward.has_value());
    if (a.ward) {
      EXPECT_EQ(std::tuple(a.ward->diffuse, a.ward->specular, a.ward->alphaX, a.ward->alphaY),
                std::tuple(b.ward->diffuse, b.ward->specular, b.ward->alphaX, b.ward->alphaY));
    }
    for (const auto slot :
         {&Material::baseColorTexture, &Material::metallicRoughnessTexture, &Material::normalTexture,
          &Material::emissionTexture, &Material::specularTexture, &Material::specularColorTexture,
          &Material::transmissionTexture, &Material::clearcoatTexture, &Material::clearcoatRoughnessTexture,
          &Material::clearcoatNormalTexture, &Material::anisotropyTexture, &Material::sheenColorTexture,
          &Material::sheenRoughnessTexture, &Material::iridescenceTexture,
          &Material::iridescenceThicknessTexture})
      expectSameSlot(from, a.*slot, to, b.*slot, 0);
  }
}

TEST(ExportGltf, GeometryNodesAndCamerasComeBack) {
  const Scene from = manyThings(), to = reloaded(from, "geometry.glb");
  ASSERT_EQ(from.objects.size(), to.objects.size());
  for (std::size_t o = 0; o < from.objects.size(); ++o) {
    const Object &a = from.objects[o], &b = to.objects[o];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.material, b.material);
    const Mesh &m = from.meshOf(a), &n = to.meshOf(b);
    ASSERT_EQ(m.indices.size(), n.indices.size());
    for (std::size_t i = 0; i < m.indices.size(); ++i) {
      const std::uint32_t v = m.indices[i], w = n.indices[i];
      EXPECT_LT(glm::length(m.positions[v] - n.positions[w]), 1e-5f);
      EXPECT_LT(glm::length(m.normals[v] - n.normals[w]), 1e-5f);
      EXPECT_EQ(placeInAtlas(a.lightmapScaleOffset, m.lightmapUv[v]), n.uv1[w]);
      if (m.uv0.empty()) continue;  // the light panel
      EXPECT_EQ(m.colors[v], n.colors[w]);
      const bool second = from.materials[static_cast<std::size_t>(a.material)].name == "second";
      EXPECT_EQ(second ? m.uv1[v] : m.uv0[v], n.uv0[w]);
    }
  }
  EXPECT_LT(glm::length(from.bounds.lo - to.bounds.lo) + glm::length(from.bounds.hi - to.bounds.hi), 1e-5f);
  ASSERT_EQ(to.cameras.size(), 1u);
  EXPECT_EQ(to.cameras[0].name, "eye");
  EXPECT_LT(glm::length(to.cameras[0].eye - from.cameras[0].eye), 1e-6f);
  EXPECT_LT(glm::length(glm::normalize(to.cameras[0].at - to.cameras[0].eye) -
                        glm::normalize(from.cameras[0].at - from.cameras[0].eye)),
            1e-6f);
  EXPECT_FLOAT_EQ(to.cameras[0].fovYDegrees, 40);
}

TEST(ExportGltf, LightStandsWhereViewersLookForIt) {
  const Scene scene = manyThings();
  const json root = jsonOf(exportGltf(scene, lightOf(scene)));
  EXPECT_FALSE(root.dump().find("KHR_lights_punctual") != std::string::npos);
  for (std::size_t i : {0u, 1u}) {
    const json& m = root["materials"][i];
    const MaterialLight light = lightOf(scene).materials[i];
    EXPECT_EQ(m["emissiveTexture"]["texCoord"], 1);
    EXPECT_EQ(root["textures"][m["emissiveTexture"]["index"].get<std::size_t>()]["name"], "outgoing light");
    const json strength = m["extensions"].value("KHR_materials_emissive_strength", json::object());
    EXPECT_FLOAT_EQ(m["emissiveFactor"][0].get<float>() * strength.value("emissiveStrength", 1.0f),
                    light.radiance);
    EXPECT_FLOAT_EQ(m["extensions"]["MOZ_lightmap"]["intensity"].get<float>(), light.irradiance);
    EXPECT_EQ(m["extensions"]["MOZ_lightmap"]["texCoord"], 1);
    EXPECT_EQ(m["extras"]["saccade"]["lightmap"], m["extensions"]["MOZ_lightmap"]);
  }
  EXPECT_FALSE(root["materials"][2].contains("emissiveTexture"));
}

TEST(ExportGltf, AnInstancedMeshIsStoredOnceButForItsPlacesInTheAtlas) {
  Scene scene = manyThings();
  Object again = scene.objects[0];
  again.mesh = static_cast<std::uint32_t>(scene.meshes.size());
  scene.meshes.push_back(quads());
  scene.meshes.back().lightmapUv = scene.meshes.back().uv0;
  scene.meshes.back().instanced = true;
  again.node = -1;
  again.meshToWorld = Mat4(1);
  scene.objects = {again, again};
  scene.objects[1].lightmapScaleOffset = Vec4(0.1f, 0.1f, 0.7f, 0.7f);
  const json root = jsonOf(exportGltf(scene, lightOf(scene)));
  json one = root["meshes"][0]["primitives"][0], other = root["meshes"][1]["primitives"][0];
  EXPECT_NE(one["attributes"]["TEXCOORD_1"], other["attributes"]["TEXCOORD_1"]);
  one["attributes"].erase("TEXCOORD_1");
  other["attributes"].erase("TEXCOORD_1");
  EXPECT_EQ(one, other);
}

TEST(ExportGltf, KeepsTheRulesOfGltf) {
  const Scene scene = manyThings();
  const std::vector<std::uint8_t> glb = exportGltf(scene, lightOf(scene));
  EXPECT_EQ(glb.size() % 4, 0u);
  const json root = jsonOf(glb);
  const auto sizeOf = [](const json& accessor) {
    const std::string type = accessor["type"];
    const std::size_t components = type == "SCALAR" ? 1 : static_cast<std::size_t>(type[3] - '0');
    return components * (accessor["componentType"] == 5123 ? 2 : 4) * accessor["count"].get<std::size_t>();
  };
  for (const json& view : root["bufferViews"]) EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
  for (const json& accessor : root["accessors"]) {
    const json& view = root["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const auto offset = accessor["byteOffset"].get<std::size_t>();
    EXPECT_EQ(offset % (accessor["componentType"] == 5123 ? 2 : 4), 0u);
    EXPECT_LE(offset + sizeOf(accessor), view["byteLength"].get<std::size_t>());
  }
  for (const json& mesh : root["meshes"])
    for (const json& primitive : mesh["primitives"]) {
      const json& attributes = primitive["attributes"];
      const json& positions = root["accessors"][attributes["POSITION"].get<std::size_t>()];
      EXPECT_EQ(positions["min"].size(), 3u);
      EXPECT_EQ(positions["max"].size(), 3u);
      for (const json& a : attributes)
        EXPECT_EQ(root["accessors"][a.get<std::size_t>()]["count"], positions["count"]);
      EXPECT_TRUE(attributes.contains("TEXCOORD_0") && attributes.contains("TEXCOORD_1"));
    }
  std::set<std::string> used;
  const auto collect = [&](const auto& self, const json& value) -> void {
    if (value.is_object() && value.contains("extensions"))
      for (const auto& item : value["extensions"].items()) used.insert(item.key());
    if (value.is_structured())
      for (const json& child : value) self(self, child);
  };
  collect(collect, root);
  EXPECT_EQ(root["extensionsUsed"].get<std::set<std::string>>(), used);
}

}  // namespace
}  // namespace saccade::core
