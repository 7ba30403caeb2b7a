#include "core/scene/plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/scene/instances.h"
#include "core/scene/median_edge.h"
#include "core/scene/sheen.h"
#include "core/scene/texture_mean.h"

namespace saccade::core {
namespace {

// Longest specular chains. Opaque: a mirror in a mirror in a mirror, and its last view. Refraction: a solid
// takes two interfaces and their inner reflections; each further transmitting object two more, up to the
// largest.
constexpr int kDepthOpaque = 4, kDepthRefraction = 8, kDepthPerObject = 2, kDepthLargest = 12;
/// Perceptual roughness below which a lobe is followed as a mirror.
constexpr float kMirrorRoughness = 0.03f;

// Illumination maps: texels between these parts of the scene's diagonal.
constexpr double kCoarsestPart = 1.0 / 128, kFinestPart = 1.0 / 16384;
constexpr double kBytesPerTexel = 6;  // three halves
constexpr int kSmallestMap = 64, kLargestMap = 4096, kMapStep = 64;

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

std::string counted(std::size_t n, const char* one, const std::string& more) {
  return std::to_string(n) + " " + (n == 1 ? one : more);
}

std::string counted(std::size_t n, const char* thing) { return counted(n, thing, std::string(thing) + "s"); }

/// "1 solid tints light", "2 solids tint light".
std::string counted(std::size_t n, const char* thing, const char* oneDoes, const char* severalDo) {
  return counted(n, thing) + " " + (n == 1 ? oneDoes : severalDo);
}

/// What the objects of a scene amount to.
struct Census {
  std::size_t nonDiffuse = 0, rough = 0, transmitting = 0, alpha = 0, normalMapped = 0, doubleSided = 0,
              emitting = 0, attenuating = 0, coated = 0, anisotropic = 0, sheen = 0, ward = 0, iridescent = 0,
              dispersing = 0;
  double area = 0, leftOut = 0, diffuseArea = 0;
};

void countLayers(const Material& m, Census& c) {
  if (m.unlit) return;
  c.ward += m.ward.has_value();
  if (m.ward) return;
  c.coated += m.clearcoat > 0;
  c.iridescent += m.iridescence > 0;
  c.anisotropic += m.anisotropy > 0;
  c.sheen += m.sheenColor != Vec3(0);
}

Census count(const Scene& scene) {
  Census c;
  std::vector<MaterialMeans> means;
  for (const Material& m : scene.materials) means.push_back(materialMeans(scene, m));
  for (const Object& o : scene.objects) {
    const Material& m = scene.materials[static_cast<std::size_t>(o.material)];
    const MaterialMeans& mean = means[static_cast<std::size_t>(o.material)];
    const double area = surfaceArea(scene, o);
    c.area += area;
    c.alpha += m.alphaMode != AlphaMode::opaque;
    c.emitting += m.emits();
    c.normalMapped += static_cast<bool>(m.normalTexture);
    c.attenuating += o.closed && m.attenuates();
    c.dispersing += o.closed && m.disperses();
    countLayers(m, c);
    c.doubleSided += m.doubleSided && !m.unlit && mean.metallic < 1 && mean.transmission < 1;
    if (o.id == 0) {
      c.diffuseArea += area;
      c.leftOut += area * static_cast<double>(o.nonDiffuseAlbedo);
      continue;
    }
    ++c.nonDiffuse;
    const bool hasLobe = mean.metallic > 0 || luminance(mean.dielectricAlbedo) > 0;
    c.rough += (hasLobe && mean.roughness > kMirrorRoughness) || m.ward || mean.over.sheen > 0 ||
               (mean.over.coat > 0 && mean.over.coatRoughness > kMirrorRoughness);
    c.transmitting += mean.transmission > 0;
  }
  return c;
}

void sizeLightmap(const Scene& scene, const Census& c, int megabytes, Plan& plan) {
  if (!(c.area > 0)) return;
  const double diagonal = static_cast<double>(scene.bounds.diagonal());
  plan.coarsestTexel = static_cast<float>(diagonal * kCoarsestPart);
  plan.finestTexel = static_cast<float>(diagonal * kFinestPart);
  const double texels = megabytes * double{1 << 20} / (kBytesPerTexel * (plan.doubleSided ? 2 : 1));
  const int stepped = static_cast<int>(std::min(std::sqrt(texels), 1e6)) / kMapStep * kMapStep;
  plan.lightmapSize = std::clamp(stepped, kSmallestMap, kLargestMap);
}

/// Meshes in world space with edges mostly shorter than the coarsest texel.
std::size_t countDense(const Scene& scene, float coarsestTexel) {
  return static_cast<std::size_t>(
      std::count_if(scene.meshes.begin(), scene.meshes.end(), [&](const Mesh& mesh) {
        return !mesh.instanced && mesh.positions.size() >= kDenseVertices &&
               medianEdge(mesh) < static_cast<double>(coarsestTexel);
      }));
}

std::string describe(const Environment& e) {
  const ImageRgb& image = e.radiance;
  return e.name + ", " + std::to_string(image.width()) + "x" + std::to_string(image.height()) +
         ", turned by " + number(static_cast<double>(glm::degrees(e.rotation))) +
         " degrees: lights the scene and shows behind it";
}

void describe(const Scene& scene, const Census& c, int mapsMegabytes, Plan& plan) {
  const auto line = [&](const char* stage, bool on, const std::string& yes, const std::string& no) {
    plan.lines.push_back({stage, on, on ? yes : no});
  };
  const std::string nobody = "every object is treated as diffuse";
  line("corrections", plan.corrections,
       counted(c.nonDiffuse, "object", "reflects or transmits", "reflect or transmit") + " beyond Lambert",
       nobody);
  line("glossy reflection", plan.glossy, counted(c.rough, "non-diffuse object") + " with a rough lobe",
       "no rough lobe on a non-diffuse object");
  line("refraction", plan.refraction, counted(c.transmitting, "object", "transmits", "transmit") + " light",
       "nothing transmits light");
  line("attenuation", plan.attenuation,
       counted(c.attenuating, "solid", "tints", "tint") + " the light that crosses", "no solid tints light");
  line("dispersion", plan.dispersion,
       counted(c.dispersing, "solid", "splits", "split") + " light into colours",
       "no solid splits light into colours");
  line("iridescence", c.iridescent > 0, counted(c.iridescent, "object") + " under a thin film",
       "no material has a thin film");
  line("clearcoat", c.coated > 0, counted(c.coated, "object") + " under a coat", "no material has a coat");
  line("anisotropy", c.anisotropic > 0, counted(c.anisotropic, "object") + " with brushed highlights",
       "no anisotropic material");
  line("sheen", c.sheen > 0, counted(c.sheen, "object") + " with sheen", "no material has sheen");
  line("Ward", c.ward > 0, counted(c.ward, "object") + " with Ward's lobe", "no material has Ward's lobe");
  line("alpha test", plan.alphaTest, counted(c.alpha, "object") + " with alpha mask or blend",
       "no alpha mask or blend");
  line("normal maps", plan.normalMaps, counted(c.normalMapped, "object") + " with a normal map",
       "no material has a normal map");
  line("back-side maps", plan.doubleSided,
       counted(c.doubleSided, "double-sided object", "takes", "take") + " light from behind",
       "no double-sided surface takes light");
  line("recursion", plan.recursionDepth > 0,
       "depth " + std::to_string(plan.recursionDepth) +
           (plan.refraction ? ": solids refract on entry and exit" : ": mirrors seen in mirrors"),
       "depth 0: no specular chain to follow");
  line("object ids", plan.corrections,
       counted(c.nonDiffuse, "id") + ", a float beside each pixel's colour holds them exactly",
       "no object needs an id");
  const std::string size = std::to_string(plan.lightmapSize);
  line("illumination maps", plan.lightmapSize > 0,
       "at most " + size + "x" + size + (plan.doubleSided ? " in 2 layers" : "") + " by the cap of " +
           std::to_string(mapsMegabytes) + " MiB, for " + number(c.area) + " m2 of surface; texels from " +
           number(static_cast<double>(plan.finestTexel)) + " to " +
           number(static_cast<double>(plan.coarsestTexel)) + " m, as light varies",
       "no surface");
  line("light by vertex", plan.denseMeshes > 0,
       counted(plan.denseMeshes, "mesh with edges", "meshes with edges") +
           " shorter than the coarsest texel: kept by vertex where charts would take more",
       "no mesh is dense enough: light is kept in charts");
  const std::size_t lights = scene.lights.size() + c.emitting;
  line("environment", scene.environment != nullptr, scene.environment ? describe(*scene.environment) : "",
       "none: rays that miss everything are black");
  line("light sampling", scene.lights.size() > 1 || c.emitting > 0 || scene.environment,
       counted(scene.lights.size(), "punctual light") + ", " + counted(c.emitting, "emitting mesh object") +
           (scene.environment ? ", the environment" : ""),
       lights == 1 ? "one punctual light: nothing to choose" : "no light shines");
  line("default light", scene.defaultLight, "the scene has none", "the scene lights itself");
  line("default camera", scene.defaultCamera, "the scene has none",
       "the scene brings " + counted(scene.cameras.size(), "camera"));
  line(
      "energy left out", plan.diffuseEnergyLeftOut > 0,
      number(100 * plan.diffuseEnergyLeftOut) + " % mean albedo of other lobes on objects treated as diffuse",
      "objects treated as diffuse have no other lobe");
  for (const char* stage : {"medium", "volume", "motion"}) line(stage, false, "", "not in this scene");
}

/// Of S and G.
float baseAlbedo(const MaterialMeans& m) {
  const float dielectric = luminance(m.dielectricAlbedo);
  const float through = (1 - dielectric) * m.transmission * luminance(m.baseColor);
  return m.metallic * luminance(m.metallicAlbedo) + (1 - m.metallic) * (dielectric + through);
}

/// With sheen over the base, and a coat over both.
float underLayers(const MaterialMeans& m, float albedo) {
  if (m.over.sheen > 0) {
    const float sheen = sheenMeanAlbedo(m.over.sheenRoughness);
    albedo = luminance(m.sheenColor) * sheen + (1 - m.over.sheen * sheen) * albedo;
  }
  if (m.over.coat > 0) {
    const AlbedoPair pair = meanAlbedo(m.over.coatRoughness);
    const float coat = m.over.coat * (kCoatF0 * pair.scale + pair.bias);
    albedo = coat + (1 - coat) * albedo;
  }
  return albedo;
}

}  // namespace

float nonDiffuseAlbedo(const Scene& scene, const Material& material) {
  const MaterialMeans m = materialMeans(scene, material);
  const float coverage = material.alphaMode == AlphaMode::blend ? std::clamp(m.alpha, 0.0f, 1.0f) : 1.0f;
  float lobes = 0;
  if (!material.unlit) {
    lobes = material.ward ? luminance(material.ward->specular) : underLayers(m, baseAlbedo(m));
  }
  return std::clamp(coverage * lobes + (1 - coverage), 0.0f, 1.0f);
}

Plan makePlan(const Scene& scene, int mapsMegabytes) {
  const Census c = count(scene);
  Plan plan;
  plan.corrections = c.nonDiffuse > 0;
  plan.glossy = c.rough > 0;
  plan.refraction = c.transmitting > 0;
  plan.attenuation = c.attenuating > 0;
  plan.dispersion = c.dispersing > 0;
  plan.alphaTest = c.alpha > 0;
  plan.normalMaps = c.normalMapped > 0;
  plan.doubleSided = c.doubleSided > 0;
  if (plan.corrections) plan.recursionDepth = kDepthOpaque;
  if (plan.refraction)
    plan.recursionDepth = std::min(
        kDepthLargest,
        kDepthRefraction + kDepthPerObject * static_cast<int>(std::min<std::size_t>(c.transmitting - 1, 2)));
  if (c.diffuseArea > 0) plan.diffuseEnergyLeftOut = c.leftOut / c.diffuseArea;
  sizeLightmap(scene, c, mapsMegabytes, plan);
  plan.denseMeshes = countDense(scene, plan.coarsestTexel);
  describe(scene, c, mapsMegabytes, plan);
  return plan;
}

}  // namespace saccade::core
