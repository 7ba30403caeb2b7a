// The options that several commands share, with their help texts in one place.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "attention/importance.h"
#include "core/camera.h"
#include "core/corrective/queues.h"
#include "core/scene/load.h"
#include "core/scene/plan.h"
#include "core/scene/scene.h"
#include "render/splat/aging.h"

namespace CLI {
class App;
class Option;
}

namespace saccade::app {

struct SceneOptions {
  std::string path;
  core::LoadOptions load;
  std::string mapsFile;            ///< --maps; empty = the cache folder
  std::string quality = "medium";  ///< of the implicit bake
  std::uint64_t photons = 0;       ///< 0 = what the quality says
  int mapsMegabytes = core::kMapsMegabytes;
};

struct CameraOptions {
  std::string camera;  ///< name or index in the file; empty = the first
  std::vector<float> eye, at, up;
  std::optional<float> fovDegrees;
};

struct RunOptions {
  std::string context = "osmesa";
  int threads = -1;  ///< tracer threads; -1 = one less than the cores, at least one; 0 = everything inline
  std::uint32_t seed = 1;
  float exposureEv = 0;
  std::string statsFile;
};

using render::AgingTest;

/// By their names on the command line and in recorded sessions.
const std::map<std::string, AgingTest>& agingTests();

struct CorrectiveOptions {
  attention::AttentionOptions attention;
  AgingTest aging = AgingTest::haber;
  float delta = 0.1f;
  int nMin = 10;
  int maxAge = 30;
  int cacheMb = 64;
  float inhibition = core::RegionQueue::kInhibition;
  int jobSize = 64;
  int samplesPerPixel = 1;
  bool approximation = false;  ///< light probes where nothing is corrected yet
};

struct ImageSize {
  int width = 512, height = 512;
};

/// Returns the scene file itself, which is required.
CLI::Option* addSceneOptions(CLI::App& command, SceneOptions& options);
void addCameraOptions(CLI::App& command, CameraOptions& options);
void addRunOptions(CLI::App& command, RunOptions& options);
/// --normalise, --orientation; among addCorrectiveOptions', too.
void addSaliencyOptions(CLI::App& command, attention::SaliencyOptions& options);
void addCorrectiveOptions(CLI::App& command, CorrectiveOptions& options);
/// --size WxH; throws core::UsageError on anything else.
void addSizeOption(CLI::App& command, ImageSize& size);

/// The camera the options ask for: one of the scene's, overridden field by field. Throws core::UsageError.
core::Camera chooseCamera(const core::Scene& scene, const CameraOptions& options);

/// Tracer threads after the default is resolved.
int tracerThreads(const RunOptions& options);

}  // namespace saccade::app
