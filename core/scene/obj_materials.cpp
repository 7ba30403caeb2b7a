#include "core/scene/obj_materials.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "core/image_io.h"
#include "core/scene/confined_file.h"
#include "core/scene/repairs.h"

namespace saccade::core {
namespace {

constexpr float kStandardIor = 1.5f, kLargestIor = 10;
/// Below this Kd counts as black, above that Ks as a mirror's.
constexpr float kBlackKd = 0.05f, kMirrorKs = 0.3f;
/// Phong exponents from here on are meant as polished.
constexpr float kPolishedNs = 1000;
/// MTL's sheen names no roughness; Blender's default.
constexpr float kSheenRoughness = 0.5f;

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

/// The material uses the PBR extension of MTL. A property that is absent reads as 0, so a polished one of
/// nothing but `Pr 0` is told by its Ns alone, as exporters write it beside.
bool isPhysical(const tinyobj::material_t& from) {
  return from.roughness > 0 || from.metallic > 0 || from.sheen > 0 || from.clearcoat_thickness > 0 ||
         from.anisotropy > 0 || !from.roughness_texname.empty() || !from.metallic_texname.empty();
}

/// Numbers outside [0, 1] are taken to its end, and counted.
void physical(const tinyobj::material_t& from, Material& m, Repairs& repairs) {
  const auto unit = [&](tinyobj::real_t x) {
    const float kept = x > 0 ? std::min(static_cast<float>(x), 1.0f) : 0.0f;
    if (kept != static_cast<float>(x))
      repairs.add("material factors out of range were clamped", "material " + from.name);
    return kept;
  };
  if (isGlass(from.illum)) {
    glass(from, m);
  } else {
    m.baseColor = glm::min(rgb(from.diffuse), Vec3(1));
    m.metallic = unit(from.metallic);
    if (from.ior > 1) m.ior = std::min(static_cast<float>(from.ior), kLargestIor);
  }
  m.roughness = unit(from.roughness);
  m.clearcoat = unit(from.clearcoat_thickness);
  m.clearcoatRoughness = unit(from.clearcoat_roughness);
  m.anisotropy = unit(from.anisotropy);
  if (std::isfinite(from.anisotropy_rotation))
    m.anisotropyRotation = 2 * kPi * static_cast<float>(from.anisotropy_rotation);
  m.sheenColor = Vec3(unit(from.sheen));
  m.sheenRoughness = kSheenRoughness;
}

/// MTL's -s and -o: coordinates times s plus o, where v runs up; ours runs down.
void place(const tinyobj::texture_option_t& options, TextureSlot& slot) {
  const auto finite = [](tinyobj::real_t x, float otherwise) {
    return std::isfinite(x) ? static_cast<float>(x) : otherwise;
  };
  slot.scale = {finite(options.scale[0], 1), finite(options.scale[1], 1)};
  slot.offset = {finite(options.origin_offset[0], 0), 1 - slot.scale.y - finite(options.origin_offset[1], 0)};
}

/// The grey of one image as channel G, that of another as B; an empty one counts as white. The first one that
/// is there gives the size.
ImageRgba8 packed(const ImageRgba8& green, const ImageRgba8& blue) {
  ImageRgba8 out = green.empty() ? blue : green;
  const auto grey = [&](const ImageRgba8& from, int x, int y) -> std::uint8_t {
    return from.empty() ? 255 : from.at(x * from.width() / out.width(), y * from.height() / out.height()).r;
  };
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) out.at(x, y) = {255, grey(green, x, y), grey(blue, x, y), 255};
  return out;
}

class Converter {
 public:
  Converter(const std::filesystem::path& folder, Scene& scene, LoadBudget& budget, Repairs& repairs)
      : folder_(folder), scene_(scene), budget_(budget), repairs_(repairs) {}

  Material convert(const tinyobj::material_t& from) {
    Material m;
    m.name = from.name;
    m.metallic = 0;
    m.doubleSided = true;  // OBJ has no notion of a back side
    if (isPhysical(from)) {
      physical(from, m, repairs_);
    } else if (isGlass(from.illum)) {
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
    if (!isGlass(from.illum)) {
      m.baseColorTexture = slot(from.diffuse_texname, from.diffuse_texopt, true);
      metallicRoughness(from, m);
    }
    if (m.baseColorTexture && from.alpha_texname == from.diffuse_texname) m.alphaMode = AlphaMode::mask;
    m.emissionTexture = slot(from.emissive_texname, from.emissive_texopt, true);
    m.normalTexture = slot(from.normal_texname, from.normal_texopt, false);
    if (std::isfinite(from.normal_texopt.bump_multiplier))
      m.normalScale = static_cast<float>(from.normal_texopt.bump_multiplier);
    return m;
  }

 private:
  TextureSlot slot(const std::string& name, const tinyobj::texture_option_t& options, bool srgb) {
    if (name.empty()) return {};
    TextureSlot slot;
    const auto [at, isNew] = made_.try_emplace({name, srgb, options.clamp}, -1);
    if (isNew) at->second = add(name, image(name), srgb, options.clamp);
    slot.texture = at->second;
    if (slot) place(options, slot);
    return slot;
  }

  /// map_Pr and map_Pm as one texture, placed as the first of them that is named; each takes the place of its
  /// number.
  void metallicRoughness(const tinyobj::material_t& from, Material& m) {
    const std::string &rough = from.roughness_texname, &metal = from.metallic_texname;
    const tinyobj::texture_option_t& options = rough.empty() ? from.metallic_texopt : from.roughness_texopt;
    const auto [at, isNew] = packed_.try_emplace({rough, metal, options.clamp});
    if (isNew) at->second = pack(rough, metal, options.clamp);
    if (at->second.texture < 0) return;
    m.metallicRoughnessTexture.texture = at->second.texture;
    place(options, m.metallicRoughnessTexture);
    if (at->second.rough) m.roughness = 1;
    if (at->second.metal) m.metallic = 1;
  }

  struct Packed {
    int texture = -1;
    bool rough = false, metal = false;  ///< which images were there
  };
  Packed pack(const std::string& rough, const std::string& metal, bool clamp) {
    const ImageRgba8 green = image(rough), blue = image(metal);
    budget_.charge(std::max(green.pixels().size(), blue.pixels().size()), sizeof(Rgba8), rough + metal);
    return {add(rough + " " + metal, packed(green, blue), false, clamp), !green.empty(), !blue.empty()};
  }

  /// Its index; -1 for an empty image.
  int add(const std::string& name, ImageRgba8 image, bool srgb, bool clamp) {
    if (image.empty()) return -1;
    Texture texture;
    texture.name = name;
    texture.image = std::move(image);
    texture.srgb = srgb;
    if (clamp) texture.wrapS = texture.wrapT = Wrap::clamp;
    scene_.textures.push_back(std::move(texture));
    return static_cast<int>(scene_.textures.size()) - 1;
  }

  /// Empty, with a warning, where there is no such file.
  ImageRgba8 image(std::string name) {
    if (name.empty()) return {};
    std::replace(name.begin(), name.end(), '\\', '/');
    const std::string who = std::string("texture ").append(name);
    if (const auto file = confinedFileIfThere(folder_, name, who)) return readTexture(*file, who);
    scene_.warnings.push_back(who + " does not exist beside the scene and is left out");
    return {};
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
  Repairs& repairs_;
  std::map<std::tuple<std::string, bool, bool>, int> made_;              ///< by name, sRGB, clamped
  std::map<std::tuple<std::string, std::string, bool>, Packed> packed_;  ///< by names, clamped
};

}  // namespace

void convertObjMaterials(const std::vector<tinyobj::material_t>& materials,
                         const std::filesystem::path& folder, Scene& scene, LoadBudget& budget) {
  Repairs repairs;
  Converter converter(folder, scene, budget, repairs);
  for (const tinyobj::material_t& m : materials) scene.materials.push_back(converter.convert(m));
  repairs.report(scene.warnings);
}

}  // namespace saccade::core
