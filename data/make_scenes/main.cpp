// make_scenes [--out DIR] [--objects N]: writes the bundled scenes and camera paths into DIR (default: data).
// With --objects N only DIR/scenes/gallery-N.glb is written.
#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>

#include "core/atomic_file.h"
#include "core/error.h"
#include "data/make_scenes/scenes.h"

int main(int argc, char** argv) {
  namespace data = saccade::data;
  CLI::App app{"Writes the bundled scenes (GLB) and camera paths (JSON)."};
  std::filesystem::path out = "data";
  int objects = 0;
  app.add_option("--out", out, "folder that holds scenes/ and paths/");
  CLI::Option* tribune =
      app.add_option("--objects", objects, "write gallery-N.glb with N small objects instead");
  CLI11_PARSE(app, argc, argv);
  try {
    std::filesystem::create_directories(out / "scenes");
    std::filesystem::create_directories(out / "paths");
    if (*tribune) {
      saccade::core::writeFileAtomically(out / "scenes" / ("gallery-" + std::to_string(objects) + ".glb"),
                                         data::makeTribune(objects).bytes());
      return 0;
    }
    saccade::core::writeFileAtomically(out / "scenes" / "cornell.glb", data::makeCornell().bytes());
    saccade::core::writeFileAtomically(out / "scenes" / "table.glb", data::makeTable().bytes());
    saccade::core::writeFileAtomically(out / "scenes" / "gallery.glb", data::makeGallery().bytes());
    saccade::core::writeFileAtomically(out / "scenes" / "ward.glb", data::makeWard().bytes());
    data::writePath(out / "paths" / "cornell.json", data::cornellPath());
    data::writePath(out / "paths" / "table.json", data::tablePath());
    data::writePath(out / "paths" / "gallery.json", data::galleryPath());
    data::writePath(out / "paths" / "ward.json", data::wardPath());
  } catch (const saccade::core::UsageError& error) {
    std::cerr << "make_scenes: error: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "make_scenes: error: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
