// bake --export: a lit scene for other programs (docs/lightmaps.md).
#pragma once

#include <filesystem>
#include <stop_token>

#include "app/session/workspace.h"

namespace saccade::app {

/// The files that exportLit writes.
struct LitFiles {
  std::filesystem::path glb, front, back;
  explicit LitFiles(const std::filesystem::path& file);
};

/// To be called before anything long: throws core::UsageError when `file` does not end in .glb or is the
/// scene itself, core::Error when nothing can be written there.
void checkExport(const std::filesystem::path& file, const std::filesystem::path& scene);

/// Writes FILE.glb (core::exportGltf), FILE.exr with the irradiance of the atlas in W/m^2 (row 0 at v = 0)
/// and, where the maps have a layer for backs, FILE-back.exr; prints their names. `threads` 0 = inline.
/// Throws core::Error.
void exportLit(const Workspace& workspace, const std::filesystem::path& file, int threads,
               const std::stop_token& stop);

}  // namespace saccade::app
