#include "app/session/light_export.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "app/cli/console.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/image_io.h"
#include "raytrace/bake/light_textures.h"

namespace saccade::app {
namespace {

namespace fs = std::filesystem;

fs::path beside(const fs::path& glb, const char* ending) {
  return glb.parent_path() / (glb.stem().string() + ending);
}

}  // namespace

LitFiles::LitFiles(const fs::path& file)
    : glb(file), front(beside(file, ".exr")), back(beside(file, "-back.exr")) {}

void checkExport(const fs::path& file, const fs::path& scene) {
  if (file.extension() != ".glb")
    throw core::UsageError("--export writes binary glTF: name a file that ends in .glb, not '" +
                           file.string() + "'");
  std::error_code ignored;
  if (fs::equivalent(file, scene, ignored))
    throw core::UsageError("--export would overwrite the scene '" + scene.string() + "'; name another file");
  const fs::path folder = fs::absolute(file).parent_path();
  if (fs::is_directory(file, ignored)) throw core::Error(file.string() + ": is a folder; name a file in it");
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw core::Error(folder.string() + ": " + std::strerror(errno) +
                      "; --export needs a folder that can be written");
}

void exportLit(const Workspace& workspace, const fs::path& file, int threads, const std::stop_token& stop) {
  const LitFiles files(file);
  ProgressBar bar("exporting");
  const core::LightTextures light = raytrace::makeLightTextures(
      *workspace.world, workspace.maps, threads, {[&](double fraction) { bar.show(fraction); }, stop});
  for (int layer = 0; layer < workspace.maps.layers; ++layer)
    core::writeExr(layer == 0 ? files.front : files.back,
                   raytrace::irradiancePicture(*workspace.world, workspace.maps, layer, threads, {{}, stop}));
  try {
    core::writeFileAtomically(files.glb, core::exportGltf(workspace.scene, light));
  } catch (const core::Error& e) {
    const std::string what = e.what();
    throw core::Error(what.starts_with(file.string()) ? what : file.string() + ": " + what);
  }
  spdlog::info("exported {}, irradiance in {}{}", files.glb.string(), files.front.string(),
               workspace.maps.layers > 1 ? " and " + files.back.string() : "");
}

}  // namespace saccade::app
