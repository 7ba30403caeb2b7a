#include "raytrace/bake/kept_charts.h"

#include <algorithm>

#include "raytrace/bake/baker.h"
#include "raytrace/bake/change_bound.h"
#include "raytrace/bake/quality.h"
#include "raytrace/bake/texel_map.h"
#include "raytrace/world.h"

namespace saccade::raytrace {
namespace {

/// How to look at a scene in a hurry.
struct Hurry {
  const TexelMap& texels;  ///< of the present scene
  const core::Plan& plan;
  int threads;
  const std::stop_token& stop;
};

bool shines(const core::Scene& scene) {
  return !scene.lights.empty() ||
         std::any_of(scene.objects.begin(), scene.objects.end(), [&](const core::Object& o) {
           return scene.materials[static_cast<std::size_t>(o.material)].emits();
         });
}

/// Adds the brightest texel's luminance to each chart's bound.
void addLight(const core::Scene& scene, const Hurry& hurry, std::vector<double>& bound) {
  if (!shines(scene)) return;
  const World world(scene, hurry.plan);
  BakeOptions quick;
  quick.quality = "preview";
  quick.threads = hurry.threads;
  const int size = hurry.texels.size();
  const core::IlluminationMaps light = bakeMaps(world, {}, size, quick, {{}, hurry.stop});
  std::vector<double> most(bound.size(), 0);
  for (std::size_t t = 0; t < hurry.texels.texelCount(); ++t) {
    if (hurry.texels.chartOf(t) < 0 || !(hurry.texels.area(t) > 0)) continue;
    double& chart = most[static_cast<std::size_t>(hurry.texels.chartOf(t))];
    for (int layer = 0; layer < light.layers; ++layer) {
      const Vec3 e = light.texel(static_cast<int>(t) % size, static_cast<int>(t) / size, layer);
      chart = std::max<double>(chart, core::luminance(e));
    }
  }
  for (std::size_t c = 0; c < bound.size(); ++c) bound[c] += most[c];
}

std::vector<double> bounds(const ChangedScene& scene, const Hurry& hurry, double allowed) {
  std::vector<double> bound(hurry.texels.charts().size(), 0);
  if (!scene.match.sameObjects()) {
    const int size = hurry.texels.size();
    const QuickLight now(sceneNow(scene), hurry.plan, size, hurry.threads, hurry.stop);
    const QuickLight before(sceneBefore(scene), hurry.plan, size, hurry.threads, hurry.stop);
    bound = boundOfChange(hurry.texels, now, before, allowed);
    addLight(goneLight(scene), hurry, bound);
  }
  addLight(newLight(scene), hurry, bound);
  return bound;
}

}  // namespace

SceneChange findSceneChange(const ChangedScene& scene, const core::Plan& plan,
                            const core::IlluminationMaps& previous, int size,
                            const std::vector<char>& inPlace, double drift, int threads,
                            const std::stop_token& stop) {
  const TexelMap texels(scene.now, size);
  const auto stays = [&](std::size_t chart) { return inPlace.empty() || inPlace[chart]; };
  std::vector<std::size_t> count(texels.charts().size(), 0);
  double sum = 0;
  std::size_t kept = 0, all = 0;
  for (std::size_t t = 0; t < texels.texelCount(); ++t) {
    if (texels.chartOf(t) < 0 || !(texels.area(t) > 0)) continue;
    const auto chart = static_cast<std::size_t>(texels.chartOf(t));
    ++count[chart];
    ++all;
    if (!stays(chart)) continue;
    sum += core::luminance(previous.texel(static_cast<int>(t) % size, static_cast<int>(t) / size, 0));
    ++kept;
  }
  const double mean = kept ? sum / static_cast<double>(kept) : 0;
  const double allowed = std::max(0.0, 0.5 * qualityOf(previous.quality).errorTarget - drift) * mean;
  const std::vector<double> bound = bounds(scene, {texels, plan, threads, stop}, allowed);
  SceneChange change;
  change.kept.previous = &previous;
  std::size_t again = 0;
  double left = 0;
  for (std::size_t c = 0; c < bound.size(); ++c) {
    const bool keep = stays(c) && bound[c] <= allowed;
    change.kept.keep.push_back(keep);
    if (count[c] == 0) continue;
    ++change.charts;
    change.keptCharts += keep;
    if (keep)
      left = std::max(left, bound[c]);
    else
      again += count[c];
  }
  if (mean > 0) change.drift = left / mean;
  if (change.keptCharts > 0) change.drift += drift;
  change.texelShare = all ? static_cast<double>(again) / static_cast<double>(all) : 0;
  return change;
}

}  // namespace saccade::raytrace
