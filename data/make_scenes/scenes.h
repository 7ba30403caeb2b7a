// The bundled scenes and the walks through them.
#pragma once

#include <filesystem>
#include <vector>

#include "core/camera.h"
#include "data/make_scenes/glb_writer.h"

namespace saccade::data {

GlbWriter makeCornell();
GlbWriter makeTable();
GlbWriter makeGallery();
GlbWriter makeWard();
/// The hall with a tribune of `objects` small non-diffuse things, each visible from the camera.
/// Throws core::UsageError outside [1, 4000].
GlbWriter makeTribune(int objects);

/// A camera on its way; `seconds` rise from key to key.
struct PathKey {
  double seconds = 0;
  core::Camera camera;
};
using CameraPath = std::vector<PathKey>;

CameraPath cornellPath();
CameraPath tablePath();
CameraPath galleryPath();
CameraPath wardPath();
/// JSON: [{"t", "eye", "at", "up", "fov"}, ...], seconds, metres, degrees.
void writePath(const std::filesystem::path& file, const CameraPath& path);

}  // namespace saccade::data
