#include "app/session/kept_cache.h"

#include <link.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <fstream>
#include <optional>
#include <span>
#include <string>

#include "core/atomic_file.h"
#include "core/cache_folder.h"
#include "core/content_hash.h"
#include "core/error.h"

namespace saccade::app {
namespace {

/// The executable, byte by byte: whoever builds it anew need not think of a version.
std::uint64_t programHash() {
  core::ContentHash hash;
  hash.add(kKeptVersion);
  hash.addArray(core::readWholeFile("/proc/self/exe"));
  return hash.value();
}

int addLibrary(dl_phdr_info* library, std::size_t, void* hash) {
  auto& all = *static_cast<core::ContentHash*>(hash);
  struct stat status {};
  if (library->dlpi_name[0] == '\0' || ::stat(library->dlpi_name, &status) != 0) return 0;
  all.add(std::string(library->dlpi_name));
  all.add(static_cast<std::int64_t>(status.st_size));
  all.add(static_cast<std::int64_t>(status.st_mtime));
  return 0;
}

/// Embree and the mathematics library choose their code by the processor.
std::uint64_t machineHash() {
  core::ContentHash hash;
  ::dl_iterate_phdr(addLibrary, &hash);
  std::ifstream processors("/proc/cpuinfo");
  for (std::string line; std::getline(processors, line) && !line.empty();) {
    if (line.starts_with("model name") || line.starts_with("flags")) hash.add(line);
  }
  return hash.value();
}

std::filesystem::path fileOf(const core::Scene& scene) {
  core::ContentHash hash;
  hash.add(std::filesystem::absolute(scene.path).lexically_normal().string());
  return core::cacheFolder() / (core::cacheName(hash.value()) + ".samples");
}

/// What changed since, or nothing.
std::string difference(const SampleOrigin& before, const SampleOrigin& now) {
  if (before.program != now.program) return "they were made by another build of saccade";
  if (before.scene != now.scene) return "the scene has changed";
  if (before.maps != now.maps) return "the illumination maps have changed";
  if (before.settings != now.settings) return "--spp or --seed has changed";
  return {};
}

}  // namespace

KeptCache::KeptCache(const Workspace& workspace, const SceneOptions& scene,
                     const CorrectiveOptions& corrective, std::uint32_t seed)
    : workspace_(workspace),
      limits_(scene.load.limits),
      maxBytes_(static_cast<std::size_t>(corrective.cacheMb) << 20),
      file_(fileOf(workspace.scene)) {
  core::ContentHash settings;
  settings.add(corrective.samplesPerPixel);
  settings.add(seed);
  origin_ = {workspace.maps.key, core::contentHash(workspace.maps), settings.value(), programHash(),
             machineHash()};
}

void KeptCache::restore(FrameLoop& loop) const {
  if (!std::filesystem::exists(file_)) return;
  if (loop.recording()) {
    spdlog::info(
        "a recording holds all that its pictures are made of: the samples of the last visit are not used");
    return;
  }
  try {
    const KeptFile kept(file_, limits_);
    const std::string changed = difference(kept.visit().origin, origin_);
    if (!changed.empty()) {
      spdlog::info("the samples of the last visit are not used: {}", changed);
      return;
    }
    kept.samples(workspace_.scene.idCount(), loop.cache());
    if (kept.visit().origin.machine == origin_.machine) loop.resume(kept.visit().end);
    spdlog::info("beginning with {} samples of the last visit", loop.cache().size());
  } catch (const core::Error& e) {
    spdlog::warn("{}", e.what());
  }
}

void KeptCache::keep(const FrameLoop& loop) const {
  const std::optional<VisitEnd> end = loop.visitEnd();
  if (!end) return;
  try {
    std::error_code ignored;  // writing says what is wrong
    std::filesystem::create_directories(file_.parent_path(), ignored);
    const std::size_t samples = writeKept(file_, {origin_, *end}, loop.cache(), maxBytes_);
    spdlog::info("kept {} samples for the next visit in {}", samples, file_.string());
  } catch (const core::Error& e) {
    spdlog::warn("{}; the samples of this visit are lost (XDG_CACHE_HOME names another folder)", e.what());
  }
}

}  // namespace saccade::app
