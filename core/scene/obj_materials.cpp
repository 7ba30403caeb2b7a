#include "core/scene/obj_materials.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/image_io.h"
#include "core/scene/confined_file.h"

namespace saccade::core {
namespace {

constexpr float kStandardIor = 1.5f, kLargestIor = 10;
/// Below this Kd counts as black, above that Ks as a mirror's.
constexpr float kBlackKd = 0.05f, kMirrorKs = 0.3f;
/// Phong exponents from here on are meant as polished.
constexpr float kPolishedNs = 1000;

Vec3 rgb(const tinyobj::real_t (&c)[3]) {
  Vec3 out;
  for (int i = 0; i < 3; ++i) {
    const float x = static_cast<float>(c[i]);
    out[i] = std::isfinite(x) ? std::max(x, 0.0f) : 0.0f;
  }
  return out;
}

float largest(const Vec3& c) { return std::max({c.x, c.y, c.z}); }

/// Perceptual roughness of the Phong exponent: GGX alpha = sqrt(2 / (Ns + 2)) (Walter et al. 2007, section
/// 5).
float roughnessOf(float ns) {
  if (!(ns >= 0)) return 1;
  return ns >= kPolishedNs ? 0 : std::sqrt(std::sqrt(2 / (ns + 2)));
}

/// MTL's illumination models with refraction: 4, 6, 7, 9.
bool isGlass(int illum) { return illum == 4 || illum == 6 || illum == 7 || illum == 9; }
/// Those with ray-traced reflection: 3, 5, 8 (4, 6, 7 and 9 are glass).
bool reflects(int illum) { return illum == 3 || illum == 5 || illum == 8; }

void glass(const tinyobj::material_t& from, Material& m) {
  m.transmission = 1;
  m.roughness = 0;
  m.ior = from.ior > 1 ? std::min(static_cast<float>(from.ior), kLargestIor) : kStandardIor;
  // Exporters disagree on whether Tf 0 or Tf 1 is clear (the Cornell box's clear ball says 0.1): only its hue
  // counts.
  const Vec3 filter = rgb(from.transmittance);
  m.baseColor = largest(filter) > 0 ? filter / largest(filter) : Vec3(1);
}

void opaque(const tinyobj::material_t& from, Material& m) {
  const Vec3 kd = rgb(from.diffuse), ks = glm::min(rgb(from.specular), Vec3(1));
  m.baseColor = glm::min(kd, Vec3(1));
  const bool black = largest(kd) < kBlackKd && from.diffuse_texname.empty();
  if (black && largest(ks) > 0 && (reflects(from.illum) || largest(ks) > kMirrorKs)) {
    m.metallic = 1;
    m.baseColor = ks;
    m.roughness = from.illum == 5 ? 0 : roughnessOf(static_cast<float>(from.shininess));
    return;
  }
  if (largest(ks) <= 0 || from.illum == 0 || from.illum == 1) {
    m.specular = 0;
    return;
  }
  // Plastic: F0 = Ks.
  constexpr float kF0 = ((kStandardIor - 1) / (kStandardIor + 1)) * ((kStandardIor - 1) / (kStandardIor + 1));
  m.specularColor = ks / kF0;
  m.roughness = roughnessOf(static_cast<float>(from.shininess));
}

class Converter {
 public:
  Converter(const std::filesystem::path& folder, Scene& scene, LoadBudget& budget)
      : folder_(folder), scene_(scene), budget_(budget) {}

  Material convert(const tinyobj::material_t& from) {
    Material m;
    m.name = from.name;
    m.metallic = 0;
    m.doubleSided = true;  // OBJ has no notion of a back side
    if (isGlass(from.illum)) {
      glass(from, m);
    } else {
      opaque(from, m);
    }
    m.emission = rgb(from.emission);
    // An emitter shines from its front alone, as lamps in OBJ scenes are modelled.
    if (m.emits()) m.doubleSided = false;
    if (from.dissolve < 1 && !isGlass(from.illum)) {
      m.alphaMode = AlphaMode::blend;
      m.alpha = std::clamp(static_cast<float>(from.dissolve), 0.0f, 1.0f);
    }
    if (!isGlass(from.illum)) m.baseColorTexture = slot(from.diffuse_texname, true);
    if (m.baseColorTexture && from.alpha_texname == from.diffuse_texname) m.alphaMode = AlphaMode::mask;
    m.emissionTexture = slot(from.emissive_texname, true);
    m.normalTexture = slot(from.normal_texname, false);
    return m;
  }

 private:
  TextureSlot slot(std::string name, bool srgb) {
    if (name.empty()) return {};
    std::replace(name.begin(), name.end(), '\\', '/');
    const auto known = made_.find({name, srgb});
    if (known != made_.end()) return {known->second, 0};
    int index = -1;
    const std::string who = std::string("texture ").append(name);
    if (const auto file = confinedFileIfThere(folder_, name, who)) {
      Texture texture;
      texture.name = name;
      texture.image = readTexture(*file, who);
      texture.srgb = srgb;
      index = static_cast<int>(scene_.textures.size());
      scene_.textures.push_back(std::move(texture));
    } else {
      scene_.warnings.push_back(who + " does not exist beside the scene and is left out");
    }
    made_[{name, srgb}] = index;
    return {index, 0};
  }

  ImageRgba8 readTexture(const std::filesystem::path& file, const std::string& who) {
    const auto bytes = readSceneFile(file, budget_);
    ImageRgba8 image = decodeImage(bytes, who, budget_);
    budget_.release(bytes.size());
    return image;
  }

  const std::filesystem::path& folder_;
  Scene& scene_;
  LoadBudget& budget_;
  std::map<std::pair<std::string, bool>, int> made_;
};

}  // namespace

void convertObjMaterials(const std::vector<tinyobj::material_t>& materials,
                         const std::filesystem::path& folder, Scene& scene, LoadBudget& budget) {
  Converter converter(folder, scene, budget);
  for (const tinyobj::material_t& m : materials) scene.materials.push_back(converter.convert(m));
}

}  // namespace saccade::core
