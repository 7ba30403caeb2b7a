// Every field that glTF's material extensions, texture transforms and our extras fill.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/image_io.h"
#include "core/scene/load.h"
#include "core/scene/specular_albedo.h"
#include "core/scene/texture_transform.h"
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

bool warned(const Scene& scene, const std::string& part) {
  for (const std::string& w : scene.warnings)
    if (w.find(part) != std::string::npos) return true;
  return false;
}

/// A triangle with both UV sets, two textures (0, and 1 with another image) and a material of one extension.
GltfBuilder textured() {
  GltfBuilder b;
  for (const Rgba8 color : {Rgba8{10, 20, 30, 255}, Rgba8{200, 100, 50, 51}}) {
    const std::vector<std::uint8_t> png = encodePng(ImageRgba8(2, 1, color));
    b.json["images"].push_back({{"bufferView", b.view(png.data(), png.size())}, {"mimeType", "image/png"}});
    b.json["textures"].push_back({{"source", b.json["images"].size() - 1}});
  }
  b.primitive()["attributes"]["TEXCOORD_0"] = b.floats("VEC2", {0, 0, 1, 0, 0, 1});
  b.primitive()["attributes"]["TEXCOORD_1"] = b.floats("VEC2", {0, 1, 1, 1, 0, 0});
  return b;
}

Scene withExtension(const std::string& name, const json& value, const LoadOptions& options = {}) {
  GltfBuilder b = textured();
  b.material()["extensions"][name] = value;
  return load(b, options);
}

json infoOf(int texture, int uvSet = 0) { return {{"index", texture}, {"texCoord", uvSet}}; }

/// The first texel of a slot; the slot must be filled.
Rgba8 texelOf(const Scene& scene, const TextureSlot& slot) {
  EXPECT_TRUE(slot);
  return slot ? scene.textures[static_cast<std::size_t>(slot.texture)].image.at(0, 0) : Rgba8{};
}

TEST(GltfMaterials, Volume) {
  const json volume = {
      {"thicknessFactor", 0.25}, {"attenuationDistance", 3}, {"attenuationColor", {0.5, 0.25, 1}}};
  LoadOptions options;
  options.unitScale = 0.01f;
  const Scene scene = withExtension("KHR_materials_volume", volume, options);
  EXPECT_FLOAT_EQ(scene.materials[0].attenuationDistance, 0.03f);
  EXPECT_EQ(scene.materials[0].attenuationColor, Vec3(0.5f, 0.25f, 1));
  EXPECT_FALSE(scene.materials[0].thinWalled);
  const Scene thin = withExtension("KHR_materials_volume", json::object());
  EXPECT_TRUE(thin.materials[0].thinWalled);
  EXPECT_EQ(thin.materials[0].attenuationDistance, kInfinity);
  GltfBuilder none;
  none.material();
  EXPECT_FALSE(load(none).materials[0].thinWalled);
}

TEST(GltfMaterials, ClearCoat) {
  const json coat = {{"clearcoatFactor", 0.75},
                     {"clearcoatTexture", infoOf(0)},
                     {"clearcoatRoughnessFactor", 0.5},
                     {"clearcoatRoughnessTexture", infoOf(1, 1)},
                     {"clearcoatNormalTexture", {{"index", 1}, {"scale", -2}}}};
  const Scene scene = withExtension("KHR_materials_clearcoat", coat);
  const Material& m = scene.materials[0];
  EXPECT_EQ(m.clearcoat, 0.75f);
  EXPECT_EQ(m.clearcoatRoughness, 0.5f);
  EXPECT_EQ(texelOf(scene, m.clearcoatTexture).r, 10);
  EXPECT_EQ(texelOf(scene, m.clearcoatRoughnessTexture).g, 100);
  EXPECT_EQ(m.clearcoatRoughnessTexture.uvSet, 1);
  EXPECT_EQ(texelOf(scene, m.clearcoatNormalTexture).b, 50);
  EXPECT_EQ(m.clearcoatNormalScale, -2);
  for (const Texture& t : scene.textures) EXPECT_FALSE(t.srgb);
  EXPECT_FALSE(scene.meshOf(scene.objects[0]).tangents.empty());
}

TEST(GltfMaterials, Anisotropy) {
  const json brushed = {
      {"anisotropyStrength", 0.5}, {"anisotropyRotation", -7.5}, {"anisotropyTexture", infoOf(1)}};
  const Scene scene = withExtension("KHR_materials_anisotropy", brushed);
  const Material& m = scene.materials[0];
  EXPECT_EQ(m.anisotropy, 0.5f);
  EXPECT_EQ(m.anisotropyRotation, -7.5f);
  EXPECT_EQ(texelOf(scene, m.anisotropyTexture).b, 50);
  EXPECT_FALSE(scene.textures[0].srgb);
  EXPECT_FALSE(scene.meshOf(scene.objects[0]).tangents.empty());
}

TEST(GltfMaterials, Sheen) {
  const json cloth = {{"sheenColorFactor", {0.1, 0.2, 0.3}},
                      {"sheenColorTexture", infoOf(0)},
                      {"sheenRoughnessFactor", 0.4},
                      {"sheenRoughnessTexture", infoOf(1, 1)}};
  const Scene scene = withExtension("KHR_materials_sheen", cloth);
  const Material& m = scene.materials[0];
  EXPECT_EQ(m.sheenColor, Vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(m.sheenRoughness, 0.4f);
  EXPECT_TRUE(scene.textures[static_cast<std::size_t>(m.sheenColorTexture.texture)].srgb);
  EXPECT_EQ(texelOf(scene, m.sheenColorTexture).g, 20);
  EXPECT_EQ(texelOf(scene, m.sheenRoughnessTexture).a, 51);
  EXPECT_EQ(m.sheenRoughnessTexture.uvSet, 1);
}

TEST(GltfMaterials, IridescenceAndItsDefaults) {
  const json bubble = {{"iridescenceFactor", 0.5},           {"iridescenceIor", 1.8},
                       {"iridescenceThicknessMinimum", 250}, {"iridescenceThicknessMaximum", 150},
                       {"iridescenceTexture", infoOf(0)},    {"iridescenceThicknessTexture", infoOf(1)}};
  const Scene scene = withExtension("KHR_materials_iridescence", bubble);
  const Material& m = scene.materials[0];
  EXPECT_EQ(m.iridescence, 0.5f);
  EXPECT_EQ(m.iridescenceIor, 1.8f);
  EXPECT_EQ(m.iridescenceThicknessMin, 250);  // may exceed the maximum
  EXPECT_EQ(m.iridescenceThicknessMax, 150);
  EXPECT_EQ(texelOf(scene, m.iridescenceTexture).r, 10);
  EXPECT_EQ(texelOf(scene, m.iridescenceThicknessTexture).g, 100);
  const Material plain = withExtension("KHR_materials_iridescence", {{"iridescenceFactor", 1}}).materials[0];
  EXPECT_EQ(plain.iridescenceIor, 1.3f);
  EXPECT_EQ(plain.iridescenceThicknessMin, 100);
  EXPECT_EQ(plain.iridescenceThicknessMax, 400);
}

TEST(GltfMaterials, DispersionAndUnlit) {
  EXPECT_EQ(withExtension("KHR_materials_dispersion", {{"dispersion", 0.4}}).materials[0].dispersion, 0.4f);
  EXPECT_TRUE(withExtension("KHR_materials_unlit", json::object()).materials[0].unlit);
}

TEST(GltfMaterials, SpecularTexturesAndAnIndexOfZero) {
  const Scene scene = withExtension(
      "KHR_materials_specular",
      {{"specularFactor", 0.5}, {"specularTexture", infoOf(1)}, {"specularColorTexture", infoOf(1)}});
  EXPECT_EQ(texelOf(scene, scene.materials[0].specularTexture).a, 51);
  EXPECT_TRUE(scene.textures[static_cast<std::size_t>(scene.materials[0].specularColorTexture.texture)].srgb);
  EXPECT_EQ(scene.textures.size(), 1u);  // alpha has no colour space: one copy serves both
  const Scene perfect = withExtension("KHR_materials_ior", {{"ior", 0}});
  EXPECT_EQ(dielectricF0(perfect.materials[0]), Vec3(1));
}

TEST(GltfMaterials, TexturesOfAFactorOfZeroAreNotLoaded) {
  const Scene scene = withExtension("KHR_materials_clearcoat",
                                    {{"clearcoatTexture", infoOf(0)}, {"clearcoatNormalTexture", infoOf(1)}});
  EXPECT_TRUE(scene.textures.empty());
  EXPECT_FALSE(scene.materials[0].needsTangents());
}

TEST(GltfMaterials, FactorsOutOfRangeAreClampedAndCounted) {
  GltfBuilder b;
  b.material()["extensions"] = {
      {"KHR_materials_volume", {{"thicknessFactor", -1}, {"attenuationDistance", 0}}},
      {"KHR_materials_clearcoat", {{"clearcoatFactor", 2}, {"clearcoatRoughnessFactor", -1}}},
      {"KHR_materials_anisotropy", {{"anisotropyStrength", 1.5}}},
      {"KHR_materials_sheen", {{"sheenColorFactor", {2, 0.5, -1}}, {"sheenRoughnessFactor", 3}}},
      {"KHR_materials_iridescence",
       {{"iridescenceFactor", 2}, {"iridescenceIor", 0}, {"iridescenceThicknessMaximum", -5}}},
      {"KHR_materials_dispersion", {{"dispersion", -2}}}};
  const Scene scene = load(b);
  const Material& m = scene.materials[0];
  EXPECT_TRUE(m.thinWalled);
  EXPECT_GT(m.attenuationDistance, 0);
  EXPECT_EQ(m.clearcoat, 1);
  EXPECT_EQ(m.clearcoatRoughness, 0);
  EXPECT_EQ(m.anisotropy, 1);
  EXPECT_EQ(m.sheenColor, Vec3(1, 0.5f, 0));
  EXPECT_EQ(m.sheenRoughness, 1);
  EXPECT_EQ(m.iridescence, 1);
  EXPECT_EQ(m.iridescenceIor, 1);
  EXPECT_EQ(m.iridescenceThicknessMax, 0);
  EXPECT_EQ(m.dispersion, 0);
  EXPECT_TRUE(warned(scene, "12 material factors")) << testing::PrintToString(scene.warnings);
}

// ---- KHR_materials_pbrSpecularGlossiness

TEST(SpecularGlossiness, F0IsTheSpecularFactorExactly) {
  for (const Vec3 specular : {Vec3(0.04f), Vec3(1, 0.77f, 0.34f), Vec3(0), Vec3(1)}) {
    const Scene scene = withExtension("KHR_materials_pbrSpecularGlossiness",
                                      {{"diffuseFactor", {0.1, 0.2, 0.3, 0.4}},
                                       {"specularFactor", {specular.x, specular.y, specular.z}},
                                       {"glossinessFactor", 0.75}});
    const Material& m = scene.materials[0];
    EXPECT_EQ(dielectricF0(m), specular);
    EXPECT_EQ(m.metallic, 0);
    EXPECT_EQ(m.roughness, 0.25f);
    EXPECT_EQ(m.baseColor, Vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.alpha, 0.4f);
  }
}

TEST(SpecularGlossiness, TakesThePlaceOfMetallicRoughnessAndDefaultsToWhiteGloss) {
  GltfBuilder b = textured();
  b.material() = {{"pbrMetallicRoughness",
                   {{"baseColorFactor", {0.5, 0.5, 0.5, 0.5}},
                    {"baseColorTexture", infoOf(0)},
                    {"metallicRoughnessTexture", infoOf(0)}}},
                  {"extensions", {{"KHR_materials_pbrSpecularGlossiness", json::object()}}}};
  const Material m = load(b).materials[0];
  EXPECT_EQ(m.baseColor, Vec3(1));
  EXPECT_EQ(m.alpha, 1);
  EXPECT_EQ(m.roughness, 0);
  EXPECT_EQ(dielectricF0(m), Vec3(1));
  EXPECT_FALSE(m.baseColorTexture);
  EXPECT_FALSE(m.metallicRoughnessTexture);
}

TEST(SpecularGlossiness, TheTexturesAlphaBecomesRoughness) {
  for (const float factor : {1.0f, 0.5f}) {
    const Scene scene =
        withExtension("KHR_materials_pbrSpecularGlossiness", {{"diffuseTexture", infoOf(0, 1)},
                                                              {"specularGlossinessTexture", infoOf(1)},
                                                              {"glossinessFactor", factor}});
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.baseColorTexture.uvSet, 1);
    EXPECT_EQ(texelOf(scene, m.specularColorTexture), (Rgba8{200, 100, 50, 51}));
    EXPECT_TRUE(scene.textures[static_cast<std::size_t>(m.specularColorTexture.texture)].srgb);
    EXPECT_EQ(m.roughness, 1);
    const Rgba8 rough = texelOf(scene, m.metallicRoughnessTexture);
    EXPECT_NEAR(static_cast<float>(rough.g), 255 - factor * 51, 0.5f);
    EXPECT_EQ(rough.b, 0);
    EXPECT_FALSE(scene.textures[static_cast<std::size_t>(m.metallicRoughnessTexture.texture)].srgb);
  }
}

// ---- KHR_texture_transform

TEST(TextureTransform, TheExtensionsOwnExamples) {
  const auto at = [](const TextureSlot& slot, Vec2 uv) { return uvMatrix(slot) * Vec3(uv, 1); };
  // "only the lower left quadrant of the source image, rotated clockwise 90 degrees"
  TextureSlot quadrant;
  quadrant.offset = {0, 1};
  quadrant.rotation = kPi / 2;
  quadrant.scale = Vec2(0.5f);
  EXPECT_LT(glm::length(at(quadrant, {0, 0}) - Vec2(0, 1)), 1e-6f);
  EXPECT_LT(glm::length(at(quadrant, {1, 0}) - Vec2(0, 0.5f)), 1e-6f);
  EXPECT_LT(glm::length(at(quadrant, {0, 1}) - Vec2(0.5f, 1)), 1e-6f);
  // "inverts the T axis, effectively defining a bottom-left origin"
  TextureSlot flipped;
  flipped.offset = {0, 1};
  flipped.scale = {1, -1};
  EXPECT_EQ(at(flipped, {0.25f, 0.25f}), Vec2(0.25f, 0.75f));
  EXPECT_FALSE(TextureSlot{}.transformed());
  EXPECT_EQ(at({}, {0.3f, 0.7f}), Vec2(0.3f, 0.7f));
}

TEST(TextureTransform, IsTranslationTimesRotationTimesScale) {
  TextureSlot slot;
  slot.offset = {0.3f, -1.2f};
  slot.rotation = 0.7f;
  slot.scale = {2, -0.5f};
  const float c = std::cos(0.7f), s = std::sin(0.7f);
  const glm::mat3 translation(1, 0, 0, 0, 1, 0, 0.3f, -1.2f, 1), rotation(c, -s, 0, s, c, 0, 0, 0, 1),
      scale(2, 0, 0, 0, -0.5f, 0, 0, 0, 1);
  for (const Vec2 uv : {Vec2(0), Vec2(1, 0), Vec2(0.25f, 3)}) {
    const Vec2 expected(translation * rotation * scale * Vec3(uv, 1));
    EXPECT_LT(glm::length(uvMatrix(slot) * Vec3(uv, 1) - expected), 1e-6f);
  }
}

TEST(TextureTransform, IsReadFromEverySlot) {
  const json info = {{"index", 1},
                     {"texCoord", 0},
                     {"extensions",
                      {{"KHR_texture_transform",
                        {{"offset", {0.1, 0.2}}, {"rotation", 0.3}, {"scale", {4, 5}}, {"texCoord", 1}}}}}};
  GltfBuilder b = textured();
  b.material() = {
      {"pbrMetallicRoughness", {{"baseColorTexture", info}, {"metallicRoughnessTexture", info}}},
      {"normalTexture", info},
      {"emissiveTexture", info},
      {"extensions",
       {{"KHR_materials_transmission", {{"transmissionFactor", 1}, {"transmissionTexture", info}}},
        {"KHR_materials_specular", {{"specularTexture", info}, {"specularColorTexture", info}}},
        {"KHR_materials_clearcoat",
         {{"clearcoatFactor", 1},
          {"clearcoatTexture", info},
          {"clearcoatRoughnessTexture", info},
          {"clearcoatNormalTexture", info}}},
        {"KHR_materials_anisotropy", {{"anisotropyStrength", 1}, {"anisotropyTexture", info}}},
        {"KHR_materials_sheen",
         {{"sheenColorFactor", {1, 1, 1}}, {"sheenColorTexture", info}, {"sheenRoughnessTexture", info}}},
        {"KHR_materials_iridescence",
         {{"iridescenceFactor", 1}, {"iridescenceTexture", info}, {"iridescenceThicknessTexture", info}}}}}};
  const Scene scene = load(b);
  const Material& m = scene.materials[0];
  for (const TextureSlot* slot :
       {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture, &m.emissionTexture,
        &m.transmissionTexture, &m.specularTexture, &m.specularColorTexture, &m.clearcoatTexture,
        &m.clearcoatRoughnessTexture, &m.clearcoatNormalTexture, &m.anisotropyTexture, &m.sheenColorTexture,
        &m.sheenRoughnessTexture, &m.iridescenceTexture, &m.iridescenceThicknessTexture}) {
    EXPECT_TRUE(*slot);
    EXPECT_EQ(slot->uvSet, 1);  // overridden
    EXPECT_EQ(slot->offset, Vec2(0.1f, 0.2f));
    EXPECT_EQ(slot->rotation, 0.3f);
    EXPECT_EQ(slot->scale, Vec2(4, 5));
  }
}

TEST(TextureTransform, TurnsTheTangentsOfItsNormalMap) {
  // u' = -v: the picture's u runs against the mesh's v, which runs up this triangle.
  GltfBuilder b = textured();
  b.primitive()["attributes"].erase("TEXCOORD_1");
  b.material()["normalTexture"] = {{"index", 0},
                                   {"extensions", {{"KHR_texture_transform", {{"rotation", -M_PI / 2}}}}}};
  const Scene scene = load(b);
  const Mesh& mesh = scene.meshOf(scene.objects[0]);
  ASSERT_FALSE(mesh.tangents.empty());
  EXPECT_LT(glm::length(Vec3(mesh.tangents[0]) - Vec3(0, -1, 0)), 1e-6f);
}

TEST(TextureTransform, UvSetsAboveOneAreLeftOutWithAWarning) {
  GltfBuilder b = textured();
  b.material()["emissiveTexture"] = {{"index", 0},
                                     {"extensions", {{"KHR_texture_transform", {{"texCoord", 2}}}}}};
  const Scene scene = load(b);
  EXPECT_FALSE(scene.materials[0].emissionTexture);
  EXPECT_TRUE(warned(scene, "UV set above 1"));
}

// ---- Ward

json wardOf(const Vec3& diffuse, const Vec3& specular, Vec2 alpha) {
  return {{"saccade",
           {{"ward",
             {{"diffuse", {diffuse.x, diffuse.y, diffuse.z}},
              {"specular", {specular.x, specular.y, specular.z}},
              {"alpha", {alpha.x, alpha.y}}}}}}};
}

Scene withExtras(const json& extras) {
  GltfBuilder b = textured();
  b.material() = {{"name", "brushed"},
                  {"doubleSided", true},
                  {"emissiveFactor", {0, 1, 0}},
                  {"pbrMetallicRoughness", {{"metallicFactor", 1}, {"baseColorTexture", infoOf(0)}}},
                  {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}},
                  {"extras", extras}};
  return load(b);
}

TEST(WardExtras, ReplaceTheLobesAndKeepTheRest) {
  const Scene scene = withExtras(wardOf({0.25f, 0.5f, 0.125f}, {0.5f, 0.25f, 0.5f}, {0.0625f, 0.25f}));
  const Material& m = scene.materials[0];
  ASSERT_TRUE(m.ward);
  EXPECT_EQ(m.ward->diffuse, Vec3(0.25f, 0.5f, 0.125f));
  EXPECT_EQ(m.ward->specular, Vec3(0.5f, 0.25f, 0.5f));
  EXPECT_EQ(m.ward->alphaX, 0.0625f);
  EXPECT_EQ(m.ward->alphaY, 0.25f);
  EXPECT_EQ(m.baseColor, m.ward->diffuse);
  EXPECT_EQ(m.metallic, 0);
  EXPECT_EQ(m.transmission, 0);
  EXPECT_EQ(baseDiffuseFactor(scene, m), 1);
  EXPECT_EQ(m.name, "brushed");
  EXPECT_TRUE(m.doubleSided);
  EXPECT_EQ(m.emission, Vec3(0, 1, 0));
  EXPECT_TRUE(m.baseColorTexture);
  EXPECT_TRUE(m.needsTangents());
  EXPECT_FALSE(scene.meshOf(scene.objects[0]).tangents.empty());
  EXPECT_FALSE(withExtras(wardOf(Vec3(0), Vec3(1), Vec2(0.5f))).materials[0].needsTangents());
}

TEST(WardExtras, EnergyAndAlphaAreKeptInRange) {
  const Scene scene = withExtras(wardOf({0.5f, 1, 0}, {0.5f, 1, 0.25f}, {0, 7}));
  const WardLobe& lobe = *scene.materials[0].ward;
  EXPECT_EQ(lobe.diffuse, Vec3(0.25f, 0.5f, 0));
  EXPECT_EQ(lobe.specular, Vec3(0.25f, 0.5f, 0.125f));
  EXPECT_GT(lobe.alphaX, 0);
  EXPECT_EQ(lobe.alphaY, 1);
  EXPECT_TRUE(warned(scene, "1 Ward materials reflected more light"));
  EXPECT_TRUE(warned(scene, "2 Ward factors"));
}

TEST(WardExtras, OfAnotherFormAreRefusedByName) {
  const auto refusal = [](const json& extras) -> std::string {
    try {
      withExtras(extras);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  json ward = wardOf(Vec3(0.5f), Vec3(0.1f), Vec2(0.1f));
  ward["saccade"]["ward"]["alpha"] = 0.1;
  EXPECT_EQ(refusal(ward), "a.glb: materials[0].extras.saccade.ward: 'alpha' must be 2 numbers");
  ward["saccade"]["ward"].erase("alpha");
  EXPECT_EQ(refusal(ward), "a.glb: materials[0].extras.saccade.ward: 'alpha' must be 2 numbers");
  ward["saccade"]["ward"]["diffuse"] = {"a", "b", "c"};
  EXPECT_EQ(refusal(ward), "a.glb: materials[0].extras.saccade.ward: 'diffuse' must be 3 numbers");
  EXPECT_EQ(refusal({{"saccade", {{"ward", 3}}}}),
            "a.glb: materials[0].extras.saccade.ward: must be an object");
  EXPECT_EQ(refusal({{"saccade", 3}}), "");  // not Ward's
  EXPECT_EQ(refusal({{"author", "somebody"}}), "");
}

}  // namespace
}  // namespace saccade::core
