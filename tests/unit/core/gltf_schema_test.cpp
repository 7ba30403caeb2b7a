// The property tables: types are refused, ranges are mended and counted; animations and extras pass checked.
#include "core/scene/gltf_schema.h"

#include <gtest/gtest.h>

#include <functional>

#include "core/scene/gltf_gate.h"
#include "tests/unit/core/gltf_builder.h"
#include "tests/unit/core/temporary_folder.h"

namespace saccade::core {
namespace {

using nlohmann::json;
using saccade::tests::GltfBuilder;
using saccade::tests::TemporaryFolder;
using Bend = std::function<void(GltfBuilder&)>;

GatedGltf gate(const Bend& bend) {
  TemporaryFolder folder;
  GltfBuilder builder;
  bend(builder);
  LoadBudget budget({}, "a.glb");
  return readGatedGltf(builder.write(folder / "a.glb"), budget);
}

std::string refusal(const Bend& bend) {
  try {
    gate(bend);
    return "";
  } catch (const Error& e) {
    return e.what();
  }
}

std::string warnings(const Bend& bend) {
  std::string all;
  for (const std::string& w : gate(bend).warnings) all += w + "\n";
  return all;
}

void expectPart(const std::string& whole, const std::string& part) {
  EXPECT_NE(whole.find(part), std::string::npos) << "'" << whole << "' lacks '" << part << "'";
}

json& extension(GltfBuilder& b, const char* name) {
  b.json["extensionsUsed"] = {name};
  return b.material()["extensions"][name];
}

TEST(GltfSchema, WrongTypesNameElementAndRule) {
  expectPart(refusal([](GltfBuilder& b) { b.json["nodes"][0]["name"] = 3; }),
             "a.glb: nodes[0]: 'name' must be a string");
  expectPart(refusal([](GltfBuilder& b) { b.material()["doubleSided"] = 1; }),
             "a.glb: materials[0]: 'doubleSided' must be true or false");
  expectPart(refusal([](GltfBuilder& b) { b.material()["pbrMetallicRoughness"]["metallicFactor"] = "1"; }),
             "materials[0].pbrMetallicRoughness: 'metallicFactor' must be a number");
  expectPart(refusal([](GltfBuilder& b) { b.json["nodes"] = "all"; }), "nodes: must be an array");
  expectPart(refusal([](GltfBuilder& b) { b.json["nodes"][0]["matrix"] = {1, 2}; }), "must be 16 numbers");
  expectPart(refusal([](GltfBuilder& b) { b.json["scenes"][0]["nodes"] = {0, 0}; }), "names 0 twice");
}

TEST(GltfSchema, FactorsOutOfRangeAreClampedAndCounted) {
  const GatedGltf gated = gate([](GltfBuilder& b) {
    b.material()["pbrMetallicRoughness"] = {{"metallicFactor", -1}, {"baseColorFactor", {2, 0.5, -3, 1}}};
    b.json["extensionsUsed"] = {"KHR_materials_ior", "KHR_materials_volume"};
    b.material()["extensions"]["KHR_materials_ior"]["ior"] = 0.5;
    b.material()["extensions"]["KHR_materials_volume"]["attenuationDistance"] = 0;
  });
  ASSERT_EQ(gated.warnings.size(), 1u);
  expectPart(gated.warnings[0], "5 material factors out of range were clamped (first: a.glb: materials[0]");
  const json material = json::parse(gated.json)["materials"][0];
  EXPECT_EQ(material["pbrMetallicRoughness"]["metallicFactor"], 0);
  EXPECT_EQ(material["pbrMetallicRoughness"]["baseColorFactor"], json({1, 0.5, 0, 1}));
  EXPECT_EQ(material["extensions"]["KHR_materials_ior"]["ior"], 1);
  EXPECT_FALSE(material["extensions"]["KHR_materials_volume"].contains("attenuationDistance"));
}

TEST(GltfSchema, IorZeroIsTheSwitchOfItsExtension) {
  EXPECT_EQ(warnings([](GltfBuilder& b) { extension(b, "KHR_materials_ior")["ior"] = 0; }), "");
}

TEST(GltfSchema, TextureReferencesInsideExtensionsAreChecked) {
  for (const auto& [name, key] : {std::pair{"KHR_materials_clearcoat", "clearcoatNormalTexture"},
                                  {"KHR_materials_sheen", "sheenRoughnessTexture"},
                                  {"KHR_materials_volume", "thicknessTexture"},
                                  {"KHR_materials_iridescence", "iridescenceThicknessTexture"},
                                  {"KHR_materials_anisotropy", "anisotropyTexture"},
                                  {"KHR_materials_pbrSpecularGlossiness", "diffuseTexture"}})
    expectPart(refusal([&](GltfBuilder& b) { extension(b, name)[key]["index"] = 0; }),
               std::string(name) + "." + key + ": 'index' is 0, but there are 0 textures");
  expectPart(refusal([](GltfBuilder& b) {
               b.json["textures"] = {json::object()};
               b.material()["normalTexture"] = {
                   {"index", 0}, {"extensions", {{"KHR_texture_transform", {{"scale", {1, 2, 3}}}}}}};
             }),
             "KHR_texture_transform: 'scale' must be 2 numbers");
}

TEST(GltfSchema, ExtensionsOutOfPlaceAreLeftOutAndCounted) {
  const GatedGltf gated = gate([](GltfBuilder& b) {
    b.json["extensionsUsed"] = {"KHR_materials_ior"};
    b.json["nodes"][0]["extensions"]["KHR_materials_ior"] = json::object();
  });
  ASSERT_EQ(gated.warnings.size(), 1u);
  expectPart(gated.warnings[0], "1 extensions in a place where they mean nothing");
  EXPECT_EQ(gated.json.find("KHR_materials_ior\":{}"), std::string::npos);
}

TEST(GltfSchema, UndeclaredExtensionsAreCounted) {
  expectPart(
      warnings([](GltfBuilder& b) { b.material()["extensions"]["KHR_materials_unlit"] = json::object(); }),
      "1 extensions are used that 'extensionsUsed' does not name");
}

TEST(GltfSchema, MaterialExtrasPass) {
  const GatedGltf gated = gate([](GltfBuilder& b) {
    b.material()["extras"] = {{"ward", {{"alphaX", 0.1}}}};
    b.json["nodes"][0]["extras"] = "not ours";
  });
  const json out = json::parse(gated.json);
  EXPECT_EQ(out["materials"][0]["extras"]["ward"]["alphaX"], 0.1);
  EXPECT_FALSE(out["nodes"][0].contains("extras"));
}

// ---- animations

/// One channel that moves node 0 at two keys.
json& animate(GltfBuilder& b, const char* path, int output, std::vector<float> times = {0, 1}) {
  b.json["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}},
                           {"samplers", {{{"input", b.floats("SCALAR", times)}, {"output", output}}}}}};
  return b.json["animations"][0];
}

TEST(GltfAnimations, GoodOnesPassUnchanged) {
  json written;
  const GatedGltf gated = gate([&](GltfBuilder& b) {
    written = animate(b, "translation", b.floats("VEC3", {0, 0, 0, 1, 2, 3}));
  });
  EXPECT_TRUE(gated.warnings.empty());
  EXPECT_EQ(json::parse(gated.json)["animations"][0], written);
}

TEST(GltfAnimations, ContentsAreChecked) {
  const auto with = [](std::vector<float> times, std::vector<float> values) {
    return refusal([&](GltfBuilder& b) { animate(b, "scale", b.floats("VEC3", values), times); });
  };
  EXPECT_EQ(with({0, 1}, {1, 1, 1, 2, 2, 2}), "");
  expectPart(with({0, 1}, {1, 1, 1}), "output has 1 elements, must have 2");
  expectPart(with({0, 1}, {1, 1, 1, 2, 2, INFINITY}), "not finite");
  expectPart(refusal([](GltfBuilder& b) {
               animate(b, "scale", b.floats("VEC4", {1, 1, 1, 1, 2, 2, 2, 2}));
             }),
             "wrong type for scale");
  expectPart(refusal([](GltfBuilder& b) {
               animate(b, "scale", b.floats("VEC3", {1, 1, 1, 2, 2, 2}))["samplers"][0]["interpolation"] =
                   "CUBICSPLINE";
             }),
             "must have 6");
  expectPart(refusal([](GltfBuilder& b) {
               animate(b, "scale", b.floats("VEC3", {1, 1, 1, 2, 2, 2}))["channels"][0]["sampler"] = 1;
             }),
             "but there are 1 samplers");
}

TEST(GltfAnimations, TimesThatDoNotIncreaseLeaveTheChannelOut) {
  for (const auto& [times, what] : {std::pair{std::vector<float>{1, 1}, "do not increase"},
                                    {{-1, 1}, "negative"},
                                    {{0, NAN}, "no number"}}) {
    const GatedGltf gated = gate([&](GltfBuilder& b) {
      animate(b, "scale", b.floats("VEC3", {1, 1, 1, 2, 2, 2}), times);
    });
    EXPECT_FALSE(json::parse(gated.json).contains("animations"));
    std::string all;
    for (const std::string& w : gated.warnings) all += w;
    expectPart(all, what);
  }
}

TEST(GltfAnimations, RotationsOffUnitLengthAreCounted) {
  expectPart(warnings([](GltfBuilder& b) {
               animate(b, "rotation", b.floats("VEC4", {0, 0, 0, 1, 0, 0, 0, 3}));
             }),
             "1 animated rotations were not of unit length");
}

TEST(GltfAnimations, WhatIsNotPlayedIsLeftOutAndCounted) {
  const GatedGltf gated = gate([](GltfBuilder& b) {
    json& animation = animate(b, "translation", b.floats("VEC3", {0, 0, 0, 1, 2, 3}));
    json weights = animation["channels"][0];
    weights["target"]["path"] = "weights";
    animation["channels"].push_back(weights);
    animation["channels"].push_back(animation["channels"][0]);
  });
  ASSERT_EQ(gated.warnings.size(), 2u);
  expectPart(gated.warnings[0], "1 animation channels of morph targets");
  expectPart(gated.warnings[1], "1 animation channels with the target of an earlier one");
  EXPECT_EQ(json::parse(gated.json)["animations"][0]["channels"].size(), 1u);
}

}  // namespace
}  // namespace saccade::core
