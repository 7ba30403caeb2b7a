#include "app/session/earlier_maps.h"

#include <spdlog/spdlog.h>

#include <span>
#include <vector>

#include "app/session/maps_note.h"
#include "core/cache_folder.h"
#include "core/content_hash.h"

namespace saccade::app {
namespace {

std::filesystem::path noteFile(const core::Scene& scene, const std::string& settings) {
  core::ContentHash hash;
  hash.add(std::filesystem::absolute(scene.path).lexically_normal().string());
  hash.add(settings);
  return core::cacheFolder() / (core::cacheName(hash.value()) + ".newest");
}

}  // namespace

std::optional<EarlierMaps> earlierMaps(const core::Scene& scene, const core::SceneState& state,
                                       const std::string& settings) {
  try {
    const std::filesystem::path file = noteFile(scene, settings);
    if (!std::filesystem::exists(file)) return std::nullopt;
    MapsNote note = readNote(file);
    if (note.key == core::sceneKey(scene) || !std::filesystem::exists(note.maps)) return std::nullopt;
    if (note.scene.state.environment != state.environment) {
      spdlog::info("the environment changed since {}: baking everything", note.maps);
      return std::nullopt;
    }
    EarlierMaps earlier{core::readMaps(note.maps, note.key), std::move(note.scene)};
    if (core::contentHash(earlier.maps) != note.light) {
      spdlog::info("{} was written anew since its scene was noted: baking everything", note.maps);
      return std::nullopt;
    }
    const core::Scene& plain = earlier.scene.state.plain;
    const bool fits = earlier.maps.charts.meshes.size() == plain.meshes.size() &&
                      earlier.maps.charts.places.size() == plain.objects.size();
    return fits ? std::optional(std::move(earlier)) : std::nullopt;
  } catch (const core::Error&) {
    return std::nullopt;  // maps or notes that cannot be read are of no use here
  }
}

void rememberMaps(const Workspace& opened, const core::SceneState& state, const std::string& settings,
                  const std::filesystem::path& file, double drift) {
  try {
    const std::filesystem::path note = noteFile(opened.scene, settings);
    std::error_code ignored;  // writing says what is wrong
    std::filesystem::create_directories(note.parent_path(), ignored);
    writeNote(note, {std::filesystem::absolute(file).string(),
                     opened.maps.key,
                     core::contentHash(opened.maps),
                     {state, drift}});
  } catch (const core::Error& e) {
    spdlog::debug("{}", e.what());
  }
}

}  // namespace saccade::app
