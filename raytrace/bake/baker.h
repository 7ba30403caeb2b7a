// The illumination maps of a scene (Haber 2001, section 4): direct light by shadow rays per texel, indirect
// light and caustics by particle tracing with density estimation.
//
// A bake is a job of long stages (particles; direct light of each layer; at medium and high final gathering
// of each layer, which looks up what those found), which can pause and go on with the same bits, and a quick
// end (density estimation, smoothing, gutters, halves), which is done anew when it was interrupted.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "core/maps.h"
#include "core/progress.h"
#include "raytrace/bake/bake_stage.h"
#include "raytrace/bake/density.h"
#include "raytrace/bake/detail.h"
#include "raytrace/bake/direct.h"
#include "raytrace/bake/gather.h"
#include "raytrace/bake/imported_light.h"
#include "raytrace/bake/kept.h"
#include "raytrace/bake/open_area.h"
#include "raytrace/bake/particles.h"
#include "raytrace/bake/quality.h"
#include "raytrace/bake/texel_map.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

struct BakeOptions {
  std::string quality = "medium";  ///< a name of quality.h
  std::uint64_t photons = 0;       ///< particles; 0 = as the quality says
  std::uint32_t seed = 1;
  std::size_t detailTexels = 0;             ///< most texels of blocks (core::MapDetail), a layer; 0: none
  int threads = 0;                          ///< 0 = all on the calling thread; the maps do not depend on it
  const ImportedLight* imported = nullptr;  ///< replaces what is baked for some objects; null: none
  const KeptCharts* kept = nullptr;         ///< charts that keep the texels of an earlier bake; null: none
};

struct BakeProgress {
  double fraction = 0;  ///< of the time that the whole job takes, [0, 1]; never falls
  double secondsLeft = 0;
  std::string_view stage;  ///< what is being done
};
/// Called from any of the threads, one at a time, at most some tens of times a second; may be empty.
using BakeReport = std::function<void(const BakeProgress&)>;

/// One bake. One thread owns it; it starts threads of its own as the options say.
class BakeJob {
 public:
  /// The world's scene is charted (core::applyCharts) for an atlas of this size; the world must outlive the
  /// job. Throws core::UsageError for an unknown quality.
  BakeJob(const World& world, int atlasSize, const BakeOptions& options);
  BakeJob(const BakeJob&) = delete;
  BakeJob& operator=(const BakeJob&) = delete;

  /// Works on the stages until they are done (true) or until `pause` was requested (false), at least one
  /// piece of work. In between the job may be kept (stages()); any pauses lead to the same bits.
  bool advance(const std::stop_token& pause, const BakeReport& report);

  /// What the long stages have found, in the order of work. A job of the same world and options goes on from
  /// `done`, `seconds` and `results` of another.
  std::span<BakeStage> stages() { return stages_; }

  /// Hash of all that the stages' results depend on, beside the scene's key: options but threads and imported
  /// light, which only the quick end reads, and the charts.
  std::uint64_t settingsHash() const;

  /// How far it is, by what its stages took so far.
  BakeProgress progress();

  /// The quick end, once advance() returned true. Takes `charts` into the maps; `key` is left 0. Throws
  /// core::Error when stopped; it may then be called again.
  core::IlluminationMaps finish(core::SceneCharts charts, const std::stop_token& stop,
                                const BakeReport& report);

 private:
  /// How far a stage has come at the moment of a report.
  struct Pace {
    const BakeStage* stage = nullptr;  ///< null: the quick end
    std::uint64_t done = 0;
    double seconds = 0;
    double finished = 0;  ///< share of the quick end
  };

  void addOpenArea(int layer);
  void addParticles();
  void addDirect(int layer);
  DirectOptions directOptions() const;
  void addGather(int layer);
  std::vector<LayerLight> directLayers();
  void addEdgeProbes();
  void addDetail();
  /// Works on one stage up to `last`; false when paused.
  bool run(BakeStage& stage, std::uint64_t last, const std::stop_token& pause, const BakeReport& report);
  BakeProgress progressAt(const Pace& now, std::string_view stage);
  std::vector<DensityEstimate> particleLight(int layer, int plane, std::uint64_t emitted,
                                             const core::Progress& progress);
  std::vector<DensityEstimate> causticLight(int layer, const core::Progress& progress);
  std::vector<DensityEstimate> indirectLight(int layer, const core::Progress& progress);
  void findSource(const core::Progress& progress);
  /// Overwrites kept charts' texels by those of the earlier bake.
  void takeKept(int layer, std::span<Vec3> irradiance) const;
  /// What a layer shows, gutters filled, and what of that is not direct light.
  struct FinishedLayer {
    std::vector<Vec3> irradiance, indirect;
  };
  FinishedLayer finishLayer(int layer, const core::Progress& progress);

  const World& world_;
  BakeOptions options_;
  const Quality& quality_;
  TexelMap texels_;
  int layers_;
  OpenArea open_;
  ParticleOptions tracing_;
  ParticleState particles_;
  std::vector<std::vector<DirectEstimate>> direct_, gathered_;  ///< by layer
  TexelLight source_;                                           ///< what gather rays look up, once found
  DetailLight detail_;
  std::vector<BakeStage> stages_;
  double fraction_ = 0;  ///< as reported last
};

/// A whole bake: irradiance of every texel, W/m^2, without albedo; gutters filled so that bilinear look-ups
/// near chart borders read no empty texel; `key` left 0 for the caller. `charts` and `atlasSize` come from
/// makeCharts and were applied to the world's scene (core::applyCharts); the charts are moved into the
/// result. Layer 1 exists when some material that shows irradiance is double-sided. Progress from any of the
/// threads. Throws core::UsageError for an unknown quality, core::Error when stopped.
core::IlluminationMaps bakeMaps(const World& world, core::SceneCharts charts, int atlasSize,
                                const BakeOptions& options, const core::Progress& progress);

}  // namespace saccade::raytrace
