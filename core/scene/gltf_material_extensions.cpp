#include "core/scene/gltf_material_extensions.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/scene/gltf_values.h"

namespace saccade::core {
namespace {

/// ((n - 1) / (n + 1))^2 is 1 exactly in float: the index of "F0 is specularColor". Larger ones are the same.
constexpr float kPerfectIor = 1e8f;
constexpr float kSmallestWardAlpha = 0.001f;

using Value = tinygltf::Value;

// An extension whose factor is 0 adds nothing: its textures are not loaded.

void specularGlossiness(const Value& e, MaterialContext& c, Material& m) {
  const Vec4 diffuse = vectorOr(e, "diffuseFactor", Vec4(1));
  m.baseColor = Vec3(diffuse);
  m.alpha = diffuse.w;
  m.baseColorTexture = c.textures.slot(e, "diffuseTexture", true);
  m.metallic = 0;
  m.ior = kPerfectIor;
  m.specularColor = vectorOr(e, "specularFactor", Vec3(1));
  m.specularColorTexture = c.textures.slot(e, "specularGlossinessTexture", true);
  const float glossiness = numberOr(e, "glossinessFactor", 1);
  m.metallicRoughnessTexture = c.textures.roughnessFromGlossiness(e, "specularGlossinessTexture", glossiness);
  m.roughness = m.metallicRoughnessTexture ? 1 : 1 - glossiness;
}

void transmission(const Value& e, MaterialContext& c, Material& m) {
  m.transmission = numberOr(e, "transmissionFactor", 0);
  if (m.transmission == 0) return;
  m.transmissionTexture = c.textures.slot(e, "transmissionTexture", false);
}

void ior(const Value& e, MaterialContext&, Material& m) {
  // 0 is the extension's switch for "F0 = 1 before specularColor".
  const float index = numberOr(e, "ior", 1.5f);
  m.ior = index == 0 ? kPerfectIor : std::min(index, kPerfectIor);
}

void specular(const Value& e, MaterialContext& c, Material& m) {
  m.specular = numberOr(e, "specularFactor", 1);
  m.specularColor = vectorOr(e, "specularColorFactor", Vec3(1));
  // Only the alpha channel of the first is read, which no colour space changes: files pack both in one image.
  m.specularTexture = c.textures.slot(e, "specularTexture", true);
  m.specularColorTexture = c.textures.slot(e, "specularColorTexture", true);
}

void emissiveStrength(const Value& e, MaterialContext&, Material& m) {
  m.emission *= numberOr(e, "emissiveStrength", 1);
}

/// Of a file that we exported: its emissiveTexture holds all light that leaves.
void ownEmission(const Value& e, MaterialContext& c, Material& m) {
  m.emission = vectorOr(e, "emissiveFactor", Vec3(0));
  m.emissionTexture = c.textures.slot(e, "emissiveTexture", true);
}

void volume(const Value& e, MaterialContext& c, Material& m) {
  m.thinWalled = numberOr(e, "thicknessFactor", 0) == 0;
  m.attenuationColor = vectorOr(e, "attenuationColor", Vec3(1));
  m.attenuationDistance = c.unitScale * numberOr(e, "attenuationDistance", kInfinity);
}

void clearcoat(const Value& e, MaterialContext& c, Material& m) {
  m.clearcoat = numberOr(e, "clearcoatFactor", 0);
  if (m.clearcoat == 0) return;
  m.clearcoatRoughness = numberOr(e, "clearcoatRoughnessFactor", 0);
  m.clearcoatTexture = c.textures.slot(e, "clearcoatTexture", false);
  m.clearcoatRoughnessTexture = c.textures.slot(e, "clearcoatRoughnessTexture", false);
  m.clearcoatNormalTexture = c.textures.slot(e, "clearcoatNormalTexture", false);
  if (m.clearcoatNormalTexture)
    m.clearcoatNormalScale = numberOr(e.Get("clearcoatNormalTexture"), "scale", 1);
}

void anisotropy(const Value& e, MaterialContext& c, Material& m) {
  m.anisotropy = numberOr(e, "anisotropyStrength", 0);
  if (m.anisotropy == 0) return;
  m.anisotropyRotation = numberOr(e, "anisotropyRotation", 0);
  m.anisotropyTexture = c.textures.slot(e, "anisotropyTexture", false);
}

void sheen(const Value& e, MaterialContext& c, Material& m) {
  m.sheenColor = vectorOr(e, "sheenColorFactor", Vec3(0));
  if (m.sheenColor == Vec3(0)) return;
  m.sheenRoughness = numberOr(e, "sheenRoughnessFactor", 0);
  m.sheenColorTexture = c.textures.slot(e, "sheenColorTexture", true);
  m.sheenRoughnessTexture = c.textures.slot(e, "sheenRoughnessTexture", true);  // alpha, as in specular()
}

void iridescence(const Value& e, MaterialContext& c, Material& m) {
  m.iridescence = numberOr(e, "iridescenceFactor", 0);
  if (m.iridescence == 0) return;
  m.iridescenceIor = numberOr(e, "iridescenceIor", 1.3f);
  m.iridescenceThicknessMin = numberOr(e, "iridescenceThicknessMinimum", 100);
  m.iridescenceThicknessMax = numberOr(e, "iridescenceThicknessMaximum", 400);
  m.iridescenceTexture = c.textures.slot(e, "iridescenceTexture", false);
  m.iridescenceThicknessTexture = c.textures.slot(e, "iridescenceThicknessTexture", false);
}

void dispersion(const Value& e, MaterialContext&, Material& m) {
  m.dispersion = numberOr(e, "dispersion", 0);
}

void unlit(const Value&, MaterialContext&, Material& m) { m.unlit = true; }

struct Extension {
  const char* name;
  void (*apply)(const Value&, MaterialContext&, Material&);
};
/// The one that replaces the base comes first.
constexpr Extension kExtensions[] = {{"KHR_materials_pbrSpecularGlossiness", &specularGlossiness},
                                     {"KHR_materials_transmission", &transmission},
                                     {"KHR_materials_ior", &ior},
                                     {"KHR_materials_specular", &specular},
                                     {"KHR_materials_emissive_strength", &emissiveStrength},
                                     {"KHR_materials_volume", &volume},
                                     {"KHR_materials_clearcoat", &clearcoat},
                                     {"KHR_materials_anisotropy", &anisotropy},
                                     {"KHR_materials_sheen", &sheen},
                                     {"KHR_materials_iridescence", &iridescence},
                                     {"KHR_materials_dispersion", &dispersion},
                                     {"KHR_materials_unlit", &unlit},
                                     {kOwnEmissionExtension, &ownEmission}};

/// The members of Ward's lobe, which the gate does not know: their form is checked here, their range mended.
class WardReader {
 public:
  WardReader(const Value& ward, const std::string& who, Repairs& repairs)
      : ward_(ward), who_(who), repairs_(repairs) {
    if (!ward.IsObject()) throw Error(who + ": must be an object");
  }
  /// In [lo, 1].
  template <class Vector>
  Vector read(const char* key, float lo) {
    const Value& list = ward_.Get(key);
    bool good = list.ArrayLen() == static_cast<std::size_t>(Vector::length());
    for (int i = 0; good && i < Vector::length(); ++i) good = list.Get(i).IsNumber();
    if (!good) throw Error(who_ + ": '" + key + "' must be " + std::to_string(Vector::length()) + " numbers");
    Vector out(0);
    for (int i = 0; i < Vector::length(); ++i) {
      const double given = list.Get(i).GetNumberAsDouble();
      const double kept = std::clamp(given, static_cast<double>(lo), 1.0);
      if (kept != given) repairs_.add("Ward factors out of range were clamped", who_);
      out[i] = static_cast<float>(kept);
    }
    return out;
  }

 private:
  const Value& ward_;
  const std::string& who_;
  Repairs& repairs_;
};

const Value* member(const Value* object, const char* key) {
  return object && object->Has(key) ? &object->Get(key) : nullptr;
}

}  // namespace

void applyMaterialExtensions(const tinygltf::ExtensionMap& extensions, MaterialContext& context,
                             Material& m) {
  for (const Extension& extension : kExtensions)
    if (const auto at = extensions.find(extension.name); at != extensions.end())
      extension.apply(at->second, context, m);
}

void applyWardExtras(const tinygltf::Value& extras, const std::string& who, MaterialContext& context,
                     Material& m) {
  const Value* at = member(member(&extras, "saccade"), "ward");
  if (!at) return;
  const std::string element = who + ".extras.saccade.ward";
  WardReader reader(*at, element, context.repairs);
  WardLobe lobe;
  lobe.diffuse = reader.read<Vec3>("diffuse", 0);
  lobe.specular = reader.read<Vec3>("specular", 0);
  const Vec2 alpha = reader.read<Vec2>("alpha", kSmallestWardAlpha);
  lobe.alphaX = alpha.x;
  lobe.alphaY = alpha.y;
  const Vec3 sum = lobe.diffuse + lobe.specular;
  if (const float most = std::max({sum.x, sum.y, sum.z}); most > 1) {
    lobe.diffuse /= most;
    lobe.specular /= most;
    context.repairs.add("Ward materials reflected more light than they receive and were scaled down",
                        element);
  }
  Material ward;
  ward.name = m.name;
  ward.baseColor = lobe.diffuse;
  ward.baseColorTexture = m.baseColorTexture;
  ward.alpha = m.alpha;
  ward.alphaMode = m.alphaMode;
  ward.alphaCutoff = m.alphaCutoff;
  ward.normalTexture = m.normalTexture;
  ward.normalScale = m.normalScale;
  ward.emission = m.emission;
  ward.emissionTexture = m.emissionTexture;
  ward.doubleSided = m.doubleSided;
  ward.metallic = 0;
  ward.specular = 0;
  ward.ward = lobe;
  m = std::move(ward);
}

}  // namespace saccade::core
