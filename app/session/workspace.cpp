#include "app/session/workspace.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "app/cli/console.h"
#include "app/session/earlier_maps.h"
#include "app/session/lightmap_import.h"
#include "app/session/long_bake.h"
#include "core/atomic_file.h"
#include "raytrace/bake/baker.h"
#include "raytrace/bake/kept_charts.h"
#include "raytrace/bake/kept_layout.h"
#include "raytrace/bake/light_charts.h"

namespace saccade::app {

namespace {

/// Settings that tell maps of one scene apart in the cache folder.
std::string settingsName(const SceneOptions& options, const BakeRequest& bake) {
  std::string name = options.quality;
  if (options.photons > 0) name += "-" + std::to_string(options.photons);
  if (options.mapsMegabytes != core::kMapsMegabytes)
    name += "-" + std::to_string(options.mapsMegabytes) + "mb";
  if (bake.seed != 1) name += "-seed" + std::to_string(bake.seed);
  return name;
}

/// Whether the user said where the maps are or go.
bool mapsAreNamed(const SceneOptions& options, const BakeRequest& bake) {
  return !bake.file.empty() || !options.mapsFile.empty();
}

/// Maps that can be used as they are. A file that the user named is never overwritten when it belongs to
/// another scene.
std::optional<core::IlluminationMaps> existingMaps(const std::filesystem::path& file, std::uint64_t key,
                                                   bool namedByUser) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  try {
    return core::readMaps(file, key);
  } catch (const core::Error& e) {
    if (namedByUser)
      throw core::Error(std::string(e.what()) +
                        "; name another file or bake it again with 'saccade bake -o'");
    spdlog::warn("{}; baking again", e.what());
    return std::nullopt;
  }
}

void createFolderOf(const std::filesystem::path& file) {
  std::error_code ignored;  // writing the file reports what went wrong
  std::filesystem::create_directories(std::filesystem::absolute(file).parent_path(), ignored);
}

/// Before a long bake, not after it. Throws core::Error.
void checkWritable(const std::filesystem::path& file) {
  createFolderOf(file);
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    throw core::Error(file.string() + ": is a folder; name a file");
  const core::AtomicFile probe(file);
}

/// Where the maps must be kept throws core::Error, with how to go on; else warns and returns false.
bool store(const std::filesystem::path& file, const core::IlluminationMaps& maps, const BakeRequest& bake,
           bool namedByUser) {
  try {
    createFolderOf(file);
    core::writeMaps(file, maps);
    forgetCheckpoint(file);
    return true;
  } catch (const core::Error& e) {
    if (bake.always || namedByUser) throw core::Error(e.what() + howToGoOn(file, bake.always));
    spdlog::warn("{}; going on with the maps in memory (set XDG_CACHE_HOME or --maps to keep them)",
                 e.what());
    return false;
  }
}

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

raytrace::ImportedLight importReported(const BakeRequest& bake, const core::LoadLimits& limits,
                                       const core::Scene& scene) {
  LightmapReport report;
  raytrace::ImportedLight imported =
      readLightmaps(bake.importFolder, scene, bake.importScale, limits, report);
  for (const std::string& line : report.taken) spdlog::info("imported {}", line);
  printWarnings(report.warnings);
  if (!report.baked.empty()) spdlog::info("baked, for want of a lightmap: {}", joined(report.baked));
  return imported;
}

bool keepsLightByVertex(const core::SceneCharts& charts) {
  return std::any_of(charts.meshes.begin(), charts.meshes.end(),
                     [](const core::MeshCharts& mesh) { return mesh.perVertex; });
}

/// Which meshes' second UV sets are kept as the layout of their charts; nothing where no mesh has one.
void reportOwnAtlases(const raytrace::AtlasCounts& counts) {
  using raytrace::AtlasFault;
  const std::size_t missing = counts[static_cast<std::size_t>(AtlasFault::missing)];
  if (std::accumulate(counts.begin(), counts.end(), std::size_t{0}) == missing) return;
  const std::size_t kept = counts[static_cast<std::size_t>(AtlasFault::none)];
  spdlog::info("{} {} the second UV set as the layout of light", kept,
               kept == 1 ? "mesh keeps" : "meshes keep");
  for (std::size_t f = 1; f < counts.size(); ++f) {
    if (counts[f] == 0) continue;
    spdlog::info("{} {} cut anew: the second UV set {}", counts[f], counts[f] == 1 ? "mesh is" : "meshes are",
                 raytrace::describe(static_cast<AtlasFault>(f)));
  }
}

std::string widths(float finest, float coarsest) {
  const std::string least = fmt::format("{:.2g}", finest), most = fmt::format("{:.2g}", coarsest);
  return least == most ? most + " m" : least + " to " + most + " m";
}

void tell(const OpeningReport& report, const OpeningStep& step) {
  if (report) report(step);
}

/// Charts the scene and builds its world.
raytrace::ChartAtlas chartReported(Workspace& w, const SceneOptions& options, const BakeRequest& bake,
                                   const std::stop_token& stop, const OpeningReport& report) {
  const auto show = [&](double fraction) { tell(report, {"dividing surfaces into charts", fraction}); };
  show(0);
  raytrace::LightCharts charts = raytrace::chartByLight(w.scene, w.plan,
                                                        {.quality = options.quality,
                                                         .seed = bake.seed,
                                                         .threads = bake.threads,
                                                         .vertexLight = !bake.chartsOnly},
                                                        {show, stop});
  w.world = std::move(charts.world);
  const bool refined = raytrace::detailTexelsOf(options.quality, w.plan, charts.atlas.size) > 0;
  if (charts.coarsestMetres > 0) {
    spdlog::info("{} {}: {} x {} texels of {}; {:.2g} % of direct light is finer than they hold{}",
                 charts.atlas.chartCount, charts.atlas.chartCount == 1 ? "chart" : "charts",
                 charts.atlas.size, charts.atlas.size, widths(charts.finestMetres, charts.coarsestMetres),
                 100 * charts.relativeError, refined ? ", its edges get texels of their own" : "");
  } else {
    spdlog::info("no surface shows irradiance: all are mirrors, metal, glass or unlit, the maps are empty");
  }
  reportOwnAtlases(charts.atlas.ownAtlases);
  if (const std::size_t n = charts.atlas.vertexLitMeshes; n > 0)
    spdlog::info("{} {} light by vertex", n, n == 1 ? "mesh keeps its" : "meshes keep their");
  return std::move(charts.atlas);
}

/// As many names as a line holds.
std::string shortList(std::vector<std::string> names) {
  constexpr std::size_t kMost = 8;
  const std::size_t more = names.size() > kMost ? names.size() - kMost : 0;
  names.resize(names.size() - more);
  if (more > 0) names.push_back(std::to_string(more) + " more");
  return joined(names);
}

/// Charts, a world and what can be kept of earlier maps.
struct Prepared {
  raytrace::ChartAtlas atlas;
  raytrace::SceneChange change;
  bool keeps = false;  ///< `change` holds
};

/// Charts the scene so that what did not change stays where it was in earlier maps; finds what need not be
/// baked again, and says so.
Prepared chartLikeEarlier(Workspace& w, const EarlierMaps& earlier, const core::SceneState& state,
                          const SceneOptions& options, const BakeRequest& bake, const std::stop_token& stop,
                          const OpeningReport& report) {
  const core::SceneState& before = earlier.scene.state;
  const raytrace::SceneMatch match = raytrace::matchScenes(state, before);
  const raytrace::ChangedScene changed{w.scene, state, before, match};
  std::vector<std::string> names = raytrace::namesOfChanges(match, state, before);
  const std::vector<std::string> lights = raytrace::namesOfLights(changed);
  names.insert(names.end(), lights.begin(), lights.end());
  Prepared out;
  std::vector<char> inPlace;
  if (match.sameObjects()) {
    out.atlas.charts = earlier.maps.charts;
    out.atlas.size = earlier.maps.width;
    core::applyCharts(w.scene, out.atlas.charts);
    w.world = std::make_unique<raytrace::World>(w.scene, w.plan, core::Progress{{}, stop});
  } else {
    out.atlas = chartReported(w, options, bake, stop, report);
    std::optional<raytrace::KeptLayout> layout =
        raytrace::keepLayout(w.scene, out.atlas, match, before.plain, earlier.maps, w.plan.lightmapSize);
    if (!layout) {
      spdlog::info("changed ({}): no chart can keep its place, everything is baked again", shortList(names));
      return out;
    }
    out.atlas.charts = std::move(layout->charts);
    out.atlas.size = layout->size;
    inPlace = std::move(layout->inPlace);
    core::placeCharts(w.scene, out.atlas.charts);
    w.world->refreshCharts();
  }
  out.change = raytrace::findSceneChange(changed, w.plan, earlier.maps, out.atlas.size, inPlace,
                                         earlier.scene.drift, bake.threads, stop);
  out.keeps = true;
  const raytrace::SceneChange& change = out.change;
  const long again = std::lround(100 * change.texelShare);
  spdlog::info("changed ({}): {} of {} charts ({} % of texels) baked again, {} % kept", shortList(names),
               change.charts - change.keptCharts, change.charts, again, 100 - again);
  return out;
}

core::IlluminationMaps bakeNow(Workspace& w, raytrace::ChartAtlas atlas, const SceneOptions& options,
                               const BakeRequest& bake, std::uint64_t key, const raytrace::KeptCharts* kept,
                               const std::stop_token& stop, const OpeningReport& report) {
  raytrace::BakeOptions bakeOptions;
  bakeOptions.kept = kept;
  bakeOptions.quality = options.quality;
  bakeOptions.photons = options.photons;
  bakeOptions.seed = bake.seed;
  bakeOptions.detailTexels = raytrace::detailTexelsOf(options.quality, w.plan, atlas.size);
  bakeOptions.threads = bake.threads;
  raytrace::ImportedLight imported;
  if (!bake.importFolder.empty()) {
    imported = importReported(bake, options.load.limits, w.scene);
    bakeOptions.imported = &imported;
  }
  raytrace::BakeJob job(*w.world, atlas.size, bakeOptions);
  const LongBake longBake{mapsPath(key, options, bake), key, bake.resume || !bake.always, bake.always,
                          bake.checkpointEvery};
  core::IlluminationMaps maps =
      bakeLong(job, std::move(atlas.charts), longBake, stop, [&](const raytrace::BakeProgress& p) {
        tell(report, {"computing its light: " + std::string(p.stage), p.fraction, p.secondsLeft});
      });
  maps.key = key;
  if (maps.clampedTexels > 0)
    spdlog::warn("illumination maps hold at most 65504 W/m^2: {} texels are brighter, {:.3g} W are left out",
                 maps.clampedTexels, maps.clampedWatts);
  return maps;
}

}  // namespace

std::filesystem::path mapsPath(std::uint64_t key, const SceneOptions& options, const BakeRequest& bake) {
  if (!bake.file.empty()) return bake.file;
  if (!options.mapsFile.empty()) return options.mapsFile;
  return core::defaultMapsPath(key, settingsName(options, bake));
}

core::Scene loadSceneReported(const SceneOptions& options) {
  core::Scene scene = core::loadScene(options.path, options.load);
  printWarnings(scene.warnings);
  return scene;
}

std::unique_ptr<Workspace> openWithoutMaps(const SceneOptions& options) {
  auto w = std::make_unique<Workspace>();
  w->scene = loadSceneReported(options);
  w->plan = core::makePlan(w->scene, options.mapsMegabytes);
  w->world = std::make_unique<raytrace::World>(w->scene, w->plan);
  return w;
}

namespace {

/// Charts what no maps were found for, and bakes it. What earlier maps hold is used again.
void bakeMaps(Workspace& w, const SceneOptions& options, const BakeRequest& bake, std::uint64_t key,
              const std::stop_token& stop, const OpeningReport& report) {
  const std::filesystem::path file = mapsPath(key, options, bake);
  if (!bake.always)
    spdlog::info("no illumination maps for {} yet; baking ({}) into {}", options.path, options.quality,
                 file.string());
  if (bake.always) checkWritable(file);
  const bool plain = bake.importFolder.empty();
  const core::SceneState state = core::sceneState(w.scene);
  std::optional<EarlierMaps> earlier;
  if (plain) earlier = earlierMaps(w.scene, state, settingsName(options, bake));
  if (earlier && bake.chartsOnly && keepsLightByVertex(earlier->maps.charts)) earlier.reset();
  Prepared prepared;
  if (earlier)
    prepared = chartLikeEarlier(w, *earlier, state, options, bake, stop, report);
  else
    prepared.atlas = chartReported(w, options, bake, stop, report);
  w.maps = bakeNow(w, std::move(prepared.atlas), options, bake, key,
                   prepared.keeps ? &prepared.change.kept : nullptr, stop, report);
  w.mapsAreKept = store(file, w.maps, bake, mapsAreNamed(options, bake));
  if (plain && w.mapsAreKept)
    rememberMaps(w, state, settingsName(options, bake), file, prepared.change.drift);
}

}  // namespace

std::unique_ptr<Workspace> openWorkspace(const SceneOptions& options, const BakeRequest& bake,
                                         const std::stop_token& stop, const OpeningReport& report) {
  std::unique_ptr<Workspace> w = readWorkspace(options, bake, stop, report);
  finishWorkspace(*w, stop, report);
  return w;
}

std::unique_ptr<Workspace> readWorkspace(const SceneOptions& asked, const BakeRequest& bake,
                                         const std::stop_token& stop, const OpeningReport& report) {
  SceneOptions options = asked;
  options.load.limits.stop = stop;
  auto w = std::make_unique<Workspace>();
  tell(report, {"reading the scene"});
  w->scene = loadSceneReported(options);
  w->plan = core::makePlan(w->scene, options.mapsMegabytes);
  const std::uint64_t key = core::sceneKey(w->scene);
  const std::filesystem::path file = mapsPath(key, options, bake);
  std::optional<core::IlluminationMaps> found;
  if (!bake.always) found = existingMaps(file, key, mapsAreNamed(options, bake));
  if (found && bake.chartsOnly && keepsLightByVertex(found->charts)) {
    spdlog::info("{} keeps light by vertex, which glTF cannot hold: baking again", file.string());
    found.reset();
  }
  if (found) {
    core::applyCharts(w->scene, found->charts);
    w->maps = std::move(*found);
    w->mapsWereThere = true;
  } else {
    bakeMaps(*w, options, bake, key, stop, report);
  }
  return w;
}

void finishWorkspace(Workspace& w, const std::stop_token& stop, const OpeningReport& report) {
  const auto show = [&](double fraction) { tell(report, {"preparing rays", fraction}); };
  if (!w.world) {
    show(0);
    w.world = std::make_unique<raytrace::World>(w.scene, w.plan, core::Progress{show, stop});
  }
  core::throwIfStopped(stop);
  w.world->setMaps(&w.maps);
}

}  // namespace saccade::app
