// The plan: what a scene needs, with the reason for each line. Stages it leaves out do not run or allocate.
#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace saccade::core {

struct PlanLine {
  std::string stage;
  bool on = false;
  std::string reason;
};

struct Plan {
  bool corrections = false;  ///< some object is non-diffuse
  bool glossy = false;       ///< a rough specular lobe occurs: distributed reflection, light sampling
  bool refraction = false;   ///< some object transmits
  bool attenuation = false;  ///< some solid tints the light that crosses it
  bool dispersion = false;   ///< some solid splits light into colours
  bool alphaTest = false;    ///< mask or blend occurs
  bool normalMaps = false;
  bool doubleSided = false;  ///< maps need a back layer
  int recursionDepth = 0;    ///< longest specular chain followed
  int lightmapSize = 0;      ///< largest atlas side in texels, by the memory that maps may take
  float finestTexel = 0, coarsestTexel = 0;  ///< metres, between which a bake chooses
  std::size_t denseMeshes = 0;      ///< whose light a bake may keep by vertex: many vertices, short edges
  double diffuseEnergyLeftOut = 0;  ///< area-weighted mean non-Lambert albedo of objects treated as diffuse
  std::vector<PlanLine> lines;      ///< for `saccade info`
};

/// What the texels of illumination maps may take unless the user says otherwise, MiB.
inline constexpr int kMapsMegabytes = 64;

/// `mapsMegabytes`: most memory for the texels of illumination maps, MiB; 6 bytes a texel and layer.
Plan makePlan(const Scene& scene, int mapsMegabytes = kMapsMegabytes);

/// Cosine-averaged albedo of a material's lobes other than Lambert, textures averaged; [0, 1].
float nonDiffuseAlbedo(const Scene& scene, const Material& material);

}  // namespace saccade::core
