#include "raytrace/bake/kept_charts.h"

#include <algorithm>
#include <memory>

#include "core/error.h"
#include "raytrace/bake/baker.h"
#include "raytrace/bake/texel_map.h"
#include "raytrace/world.h"

namespace saccade::raytrace {
namespace {

using core::PunctualLight;
using core::Vec3;

/// Equal but for names and intensities.
bool placedAlike(const PunctualLight& a, const PunctualLight& b) {
  return a.type == b.type && a.position == b.position && a.direction == b.direction && a.range == b.range &&
         a.cosInner == b.cosInner && a.cosOuter == b.cosOuter;
}

/// The lights that one state has and the other has not; where only the intensity differs, by its difference.
std::vector<PunctualLight> difference(const std::vector<PunctualLight>& before,
                                      const std::vector<PunctualLight>& now) {
  std::vector<PunctualLight> out, gone = before;
  for (const PunctualLight& light : now) {
    const auto same = [&](const PunctualLight& o) { return placedAlike(light, o); };
    PunctualLight changed = light;
    const auto found = std::find_if(gone.begin(), gone.end(), same);
    if (found != gone.end()) {
      changed.intensity = glm::abs(light.intensity - found->intensity);
      gone.erase(found);
    }
    if (changed.intensity != Vec3(0)) out.push_back(changed);
  }
  out.insert(out.end(), gone.begin(), gone.end());
  return out;
}

void addName(std::vector<std::string>& names, const std::string& name) {
  const std::string shown = name.empty() ? "(unnamed)" : name;
  if (std::find(names.begin(), names.end(), shown) == names.end()) names.push_back(shown);
}

/// Leaves in `scene` only what has changed, as bright as the change, and says what that is.
std::vector<std::string> keepChanged(core::Scene& scene, const core::LightState& before) {
  std::vector<std::string> names;
  scene.lights = difference(before.lights, scene.lights);
  for (const PunctualLight& light : scene.lights) addName(names, light.name);
  for (std::size_t m = 0; m < scene.materials.size(); ++m)
    scene.materials[m].emission = glm::abs(scene.materials[m].emission - before.emission[m]);
  for (const core::Object& object : scene.objects) {
    if (scene.materials[static_cast<std::size_t>(object.material)].emission != Vec3(0))
      addName(names, object.name);
  }
  scene.environment = nullptr;
  return names;
}

}  // namespace

double errorTargetOf(const std::string& quality) {
  if (quality == "high") return 0.02;
  if (quality == "medium") return 0.05;
  if (quality == "preview") return 0.1;
  throw core::UsageError("unknown quality '" + quality + "': use preview, medium or high");
}

LightChange findLightChange(const core::Scene& charted, const core::Plan& plan,
                            const core::IlluminationMaps& previous, const EarlierLight& before, int threads,
                            const std::stop_token& stop) {
  LightChange change;
  core::Scene scene = charted;
  change.names = keepChanged(scene, before.state);
  const World world(scene, plan);
  BakeOptions quick;
  quick.quality = "preview";
  quick.threads = threads;
  const core::IlluminationMaps bound = bakeMaps(world, {}, previous.width, quick, {{}, stop});

  const TexelMap texels(charted, previous.width);
  const int size = texels.size();
  struct Chart {
    double most = 0;  ///< luminance that may have changed
    std::size_t texels = 0;
  };
  std::vector<Chart> charts(texels.charts().size());
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t t = 0; t < texels.texelCount(); ++t) {
    if (texels.chartOf(t) < 0 || !(texels.area(t) > 0)) continue;
    Chart& chart = charts[static_cast<std::size_t>(texels.chartOf(t))];
    ++chart.texels;
    const int x = static_cast<int>(t) % size, y = static_cast<int>(t) / size;
    for (int layer = 0; layer < bound.layers; ++layer)
      chart.most = std::max<double>(chart.most, core::luminance(bound.texel(x, y, layer)));
    sum += core::luminance(previous.texel(x, y, 0));
    ++count;
  }
  const double mean = count ? sum / static_cast<double>(count) : 0;
  const double allowed = std::max(0.0, 0.5 * errorTargetOf(previous.quality) - before.drift) * mean;
  std::size_t again = 0;
  double drift = 0;
  change.kept.previous = &previous;
  for (const Chart& chart : charts) {
    const bool keep = chart.most <= allowed;
    change.kept.keep.push_back(keep);
    if (chart.texels == 0) continue;
    ++change.charts;
    change.keptCharts += keep;
    if (keep)
      drift = std::max(drift, chart.most);
    else
      again += chart.texels;
  }
  if (mean > 0) change.drift = drift / mean;
  if (change.keptCharts > 0) change.drift += before.drift;
  change.texelShare = count ? static_cast<double>(again) / static_cast<double>(count) : 0;
  return change;
}

}  // namespace saccade::raytrace
