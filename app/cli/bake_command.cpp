// saccade bake: illumination maps ahead of time.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/cli/console.h"
#include "app/cli/options.h"
#include "app/commands.h"
#include "app/session/headless.h"
#include "app/session/light_export.h"
#include "app/session/workspace.h"

namespace saccade::app {

namespace {

struct BakeOptions {
  SceneOptions scene;
  RunOptions run;
  std::string output;
  std::string importFolder;
  float importScale = 1;
  bool resume = false;
  int checkpointSeconds = 60;
  std::string exportFile;

  /// An export alone takes the maps that are there.
  bool mustBake() const { return exportFile.empty() || !output.empty() || !importFolder.empty(); }
};

const char* noteOn(const Workspace& w) {
  if (w.mapsWereThere) return " (already there, not baked again)";
  return w.mapsAreKept ? "" : " (not kept)";
}

int bake(const BakeOptions& o) {
  const auto start = std::chrono::steady_clock::now();
  if (!o.exportFile.empty()) checkExport(o.exportFile, o.scene.path);
  BakeRequest request{.file = o.output,
                      .always = o.mustBake(),
                      .threads = tracerThreads(o.run),
                      .seed = o.run.seed,
                      .importFolder = o.importFolder,
                      .importScale = o.importScale,
                      .resume = o.resume,
                      .checkpointEvery = std::chrono::seconds(o.checkpointSeconds),
                      .chartsOnly = !o.exportFile.empty()};
  const auto workspace = openWorkspace(o.scene, request, interruptToken());
  const std::string file = mapsPath(workspace->maps.key, o.scene, request).string();
  if (!o.exportFile.empty()) exportLit(*workspace, o.exportFile, tracerThreads(o.run), interruptToken());
  const core::IlluminationMaps& maps = workspace->maps;
  std::printf("%s%s: %dx%d texels, %d layer%s, %.1f MiB%s, %llu particles, quality %s, %.1f s\n",
              file.c_str(), noteOn(*workspace), maps.width, maps.height, maps.layers,
              maps.layers == 1 ? "" : "s", static_cast<double>(maps.lightBytes()) / (1 << 20),
              maps.detail.empty() ? "" : " with detail", static_cast<unsigned long long>(maps.photons),
              maps.quality.c_str(), millisecondsSince(start) / 1000);
  return 0;
}

}  // namespace

void addBakeCommand(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand(
      "bake",
      "Compute a scene's illumination maps (other commands do it by themselves when "
      "needed); where lights or objects changed since the last time, only what they change is baked again");
  auto o = std::make_shared<BakeOptions>();
  addSceneOptions(*command, o->scene);
  command->add_option("-o,--output", o->output, "Map file to write (default: the user's cache folder)");
  command->add_option("--photons", o->scene.photons, "Particles to trace, instead of what the quality says");
  command->add_option(
      "--import", o->importFolder,
      "Folder of another program's lightmaps, NODE.lightmap.jpg (or .png, .hdr, .exr): nodes of that name "
      "take their light from it, through their second UV set; or one such image, for all nodes that have the "
      "set; the rest is baked");
  command
      ->add_option("--import-scale", o->importScale,
                   "Multiplies imported light: irradiance = pi x value x this; 8-bit values are sRGB")
      ->capture_default_str();
  command->add_option(
      "--export", o->exportFile,
      "Also write the lit scene as FILE.glb for Blender, three.js and others, with its irradiance "
      "in FILE.exr beside it (docs/lightmaps.md); alone it takes maps that are already there");
  command->add_flag("--resume", o->resume,
                    "Go on from the checkpoint of a bake that was stopped (the map file's name with .part "
                    "behind it), with the same scene and settings; --threads may differ");
  command
      ->add_option(
          "--checkpoint-seconds", o->checkpointSeconds,
          "Write a checkpoint at the latest every so many seconds; also when stopped (Ctrl-C, SIGTERM)")
      ->check(CLI::Range(0, 86400))
      ->capture_default_str();
  addRunOptions(*command, o->run);
  command->callback([o, &run] { run = [o] { return bake(*o); }; });
}

}  // namespace saccade::app
