#include "raytrace/bake/light_textures.h"

#include <algorithm>

#include "core/srgb8.h"
#include "raytrace/bake/charts.h"
#include "raytrace/bake/gutters.h"
#include "raytrace/bake/texel_map.h"
#include "raytrace/parallel_rows.h"
#include "raytrace/surface.h"

namespace saccade::raytrace {
namespace {

/// Points in a texel.
constexpr int kPoints = 4;

std::size_t materialOf(const core::Scene& scene, const TexelMap& texels, std::size_t texel) {
  return static_cast<std::size_t>(scene.objects[texels.fragments(texel).front().object].material);
}

/// Colours that vary over the surface.
bool isDetailed(const core::Material& m) {
  return m.baseColorTexture || m.emissionTexture || m.metallicRoughnessTexture || m.transmissionTexture;
}
bool isDetailed(const core::Scene& scene, std::size_t object) {
  const core::Object& o = scene.objects[object];
  return isDetailed(scene.materials[static_cast<std::size_t>(o.material)]) || !scene.meshOf(o).colors.empty();
}

/// Of the picture that shows the detail of the maps.
int lightSide(const core::IlluminationMaps& maps) {
  int finest = 0;
  for (const std::uint32_t packed : maps.detail.blocks) {
    const auto block = core::MapBlock::unpack(packed);
    finest = std::max({finest, block.log2Columns, block.log2Rows});
  }
  int side = maps.width;
  for (; finest > 0 && side * 2 <= kDetailedSide; --finest) side *= 2;
  return side;
}

int emissionSide(const core::Scene& scene, int atlasSide) {
  bool detailed = false;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const auto material = static_cast<std::size_t>(scene.objects[o].material);
    detailed = detailed || (showsIrradiance(scene.materials[material]) && isDetailed(scene, o));
  }
  while (detailed && atlasSide * 2 <= kDetailedSide) atlasSide *= 2;
  return atlasSide;
}

/// By chart: the layer that receives more light.
std::vector<char> brighterSides(const TexelMap& texels, const core::IlluminationMaps& maps) {
  std::vector<double> gain(texels.charts().size());
  if (maps.layers < 2) return std::vector<char>(gain.size());
  for (std::size_t i = 0; i < texels.texelCount(); ++i) {
    const std::int32_t chart = texels.chartOf(i);
    if (chart < 0 || !texels.charts()[static_cast<std::size_t>(chart)].doubleSided) continue;
    const int x = static_cast<int>(i) % texels.size(), y = static_cast<int>(i) / texels.size();
    const Vec3 more = maps.texel(x, y, 1) - maps.texel(x, y, 0);
    gain[static_cast<std::size_t>(chart)] += texels.area(i) * core::luminance(more);
  }
  std::vector<char> out(gain.size());
  std::transform(gain.begin(), gain.end(), out.begin(), [](double g) { return g > 0; });
  return out;
}

/// Mean over a texel of what the base layer shows from `layer`'s side.
Vec3 radianceOf(const World& world, const TexelMap& texels, std::size_t texel, int layer) {
  Vec3 sum(0);
  for (int i = 0; i < kPoints; ++i) {
    const float u = (static_cast<float>(i) + 0.5f) / kPoints;
    const MeshPoint p = texels.pointOn(texel, u, i % 2 ? 0.25f : 0.75f, i < 2 ? 0.25f : 0.75f);
    Hit hit;
    hit.object = p.object;
    hit.triangle = world.firstTriangle(p.object) + p.triangle;
    hit.u = p.b1;
    hit.v = p.b2;
    hit.ng = world.geometricNormal(p.object, hit.triangle);
    const BaseLight light = baseLight(world, hit, layer == 0 ? -hit.ng : hit.ng);
    sum += light.reflected + light.emitted;
  }
  return sum / static_cast<float>(kPoints);
}

/// Mean of the maps over a texel of an atlas of `side`.
Vec3 meanLookUp(const World& world, int x, int y, int side, int layer) {
  Vec3 sum(0);
  for (int i = 0; i < kPoints; ++i) {
    const Vec2 point = Vec2(x, y) + Vec2(i % 2 ? 0.25f : 0.75f, i < 2 ? 0.25f : 0.75f);
    sum += world.irradiance(point / static_cast<float>(side), layer);
  }
  return sum / static_cast<float>(kPoints);
}

/// Codes of the values relative to the brightest of each material, which goes to `brightest`.
core::ImageRgba8 encode(const core::Scene& scene, const TexelMap& texels, std::vector<Vec3> values,
                        std::vector<float>& brightest) {
  brightest.assign(scene.materials.size(), 0);
  const auto forEach = [&](auto&& visit) {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (texels.chartOf(i) >= 0) visit(values[i], brightest[materialOf(scene, texels, i)]);
  };
  forEach([](const Vec3& v, float& most) { most = std::max({most, v.x, v.y, v.z}); });
  forEach([](Vec3& v, float most) { v = most > 0 ? v / most : Vec3(0); });
  fillGutters(texels, values);
  core::ImageRgba8 out(texels.size(), texels.size());
  const core::Srgb8& code = core::Srgb8::table();
  std::transform(values.begin(), values.end(), out.pixels().begin(), [&](const Vec3& v) {
    return core::Rgba8{code(v.x), code(v.y), code(v.z), 255};
  });
  return out;
}

}  // namespace

core::ImageRgb irradiancePicture(const World& world, const core::IlluminationMaps& maps, int layer,
                                 int threads, const core::Progress& progress) {
  const int side = lightSide(maps);
  core::ImageRgb out(side, side);
  parallelRows(side, threads, progress, [&](int y, int) {
    for (int x = 0; x < side; ++x)
      out.at(x, y) = side == maps.width ? maps.texel(x, y, layer) : meanLookUp(world, x, y, side, layer);
  });
  return out;
}

core::LightTextures makeLightTextures(const World& world, const core::IlluminationMaps& maps, int threads,
                                      const core::Progress& progress) {
  const core::Scene& scene = world.scene();
  const std::vector<char> sides = brighterSides(TexelMap(scene, maps.width), maps);
  const auto layerOf = [&](const TexelMap& texels, std::size_t i) {
    return static_cast<int>(sides[static_cast<std::size_t>(texels.chartOf(i))]);
  };
  core::LightTextures out;
  out.materials.resize(scene.materials.size());
  std::vector<float> brightest;
  {
    const TexelMap texels(scene, lightSide(maps));
    std::vector<core::ImageRgb> layers;
    layers.reserve(static_cast<std::size_t>(maps.layers));
    for (int layer = 0; layer < maps.layers; ++layer)
      layers.push_back(irradiancePicture(world, maps, layer, threads, {{}, progress.stop}));
    std::vector<Vec3> light(texels.texelCount());
    for (std::size_t i = 0; i < light.size(); ++i)
      if (texels.chartOf(i) >= 0)
        light[i] = layers[static_cast<std::size_t>(layerOf(texels, i))].pixels()[i] / core::kPi;
    out.lightmap = encode(scene, texels, std::move(light), brightest);
  }
  for (std::size_t m = 0; m < brightest.size(); ++m) out.materials[m].irradiance = brightest[m];

  const int side = emissionSide(scene, lightSide(maps));
  const TexelMap fine(scene, side);
  std::vector<Vec3> radiance(fine.texelCount());
  parallelRows(side, threads, progress, [&](int y, int) {
    for (int x = 0; x < side; ++x) {
      const auto i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x);
      if (fine.chartOf(i) >= 0) radiance[i] = radianceOf(world, fine, i, layerOf(fine, i));
    }
  });
  out.emission = encode(scene, fine, std::move(radiance), brightest);
  for (std::size_t m = 0; m < brightest.size(); ++m) out.materials[m].radiance = brightest[m];
  return out;
}

}  // namespace saccade::raytrace
