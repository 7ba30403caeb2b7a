// From file to first frame: seconds and bytes by stage, per million triangles, beside the bare parse of the
// same file by tinygltf or tinyobjloader (file read, JSON or text parsed, buffers copied; images left
// encoded, and again with its images decoded). Every measurement runs in a process of its own, so that peak
// bytes are its own; medians of REPEATS. Maps are baked (preview) before anything is measured, and read from
// the cache. Usage: bench_load REPEATS SCENE[@UNIT_SCALE]...
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <functional>

#include "bench/common.h"
#include "bench/load/bare_parse.h"

namespace saccade::bench {
namespace {

enum Figure : std::size_t {
  load,
  maps,
  world,
  upload,
  frame,
  total,
  loadBytes,
  totalBytes,
  triangles,
  count
};
using Figures = std::array<double, Figure::count>;

struct Subject {
  std::string file;
  float unitScale = 1;
};

double peakBytes() {
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  return 1024.0 * static_cast<double>(use.ru_maxrss);
}

/// Runs `work` in a child process and returns what it found. Ends the program when the child fails.
Figures inChild(const std::function<Figures()>& work) {
  int ends[2];
  if (pipe(ends) != 0) std::abort();
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    Figures found{};
    try {
      found = work();
    } catch (const std::exception& e) {
      std::fprintf(stderr, "%s\n", e.what());
      _exit(1);
    }
    _exit(write(ends[1], found.data(), sizeof found) == sizeof found ? 0 : 1);
  }
  close(ends[1]);
  Figures found{};
  const bool whole = read(ends[0], found.data(), sizeof found) == sizeof found;
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!whole || status != 0) std::exit(1);
  return found;
}

app::SceneOptions optionsOf(const Subject& s) {
  app::SceneOptions options;
  options.path = s.file;
  options.quality = "preview";
  options.load.unitScale = s.unitScale;
  return options;
}

/// load and loadBytes only.
Figures bare(const Subject& s, bool decodeImages) {
  const double before = peakBytes();
  Figures f{};
  f[load] = timed([&] { parseBare(s.file, decodeImages); });
  f[loadBytes] = peakBytes() - before;
  return f;
}

Figures ours(const Subject& s) {
  const double before = peakBytes();
  const app::SceneOptions options = optionsOf(s);
  app::Workspace w;
  Figures f{};
  f[load] = timed([&] {
    w.scene = core::loadScene(s.file, options.load);
    w.plan = core::makePlan(w.scene);
  });
  f[loadBytes] = peakBytes() - before;
  f[triangles] = static_cast<double>(w.scene.triangleCount());
  f[maps] = timed([&] {
    const std::uint64_t key = core::sceneKey(w.scene);
    w.maps = core::readMaps(app::mapsPath(key, options, {}), key);
    core::applyCharts(w.scene, w.maps.charts);
  });
  f[world] = timed([&] {
    w.world = std::make_unique<raytrace::World>(w.scene, w.plan);
    w.world->setMaps(&w.maps);
  });
  std::unique_ptr<app::Headless> gl;
  f[upload] = timed([&] { gl = std::make_unique<app::Headless>(app::RunOptions{}, w); });
  f[frame] =
      timed([&] { gl->renderer->render(core::View(w.scene.cameras[0], 512, 512, w.scene.bounds), 1, 10); });
  f[total] = f[load] + f[maps] + f[world] + f[upload] + f[frame];
  f[totalBytes] = peakBytes() - before;
  return f;
}

/// Medians, figure by figure.
Figures medianOf(int repeats, const std::function<Figures()>& work) {
  std::vector<Figures> runs;
  runs.reserve(static_cast<std::size_t>(repeats));
  for (int i = 0; i < repeats; ++i) runs.push_back(inChild(work));
  Figures out{};
  for (std::size_t figure = 0; figure < Figure::count; ++figure) {
    std::vector<double> values;
    values.reserve(runs.size());
    for (const Figures& run : runs) values.push_back(run[figure]);
    out[figure] = spread(values).median;
  }
  return out;
}

void measure(const Subject& s, int repeats) {
  inChild([&] {
    app::openWorkspace(optionsOf(s), {.threads = static_cast<int>(std::thread::hardware_concurrency())}, {});
    return Figures{};
  });
  const Figures parse = medianOf(repeats, [&] { return bare(s, false); });
  const bool holdsImages = !s.file.ends_with(".obj");
  const Figures decode = holdsImages ? medianOf(repeats, [&] { return bare(s, true); }) : parse;
  const Figures f = medianOf(repeats, [&] { return ours(s); });
  const double millions = f[triangles] / 1e6, mb = 1e6;
  std::printf("%s: %.0f triangles\n", s.file.substr(s.file.rfind('/') + 1).c_str(), f[triangles]);
  std::printf("  bare parse %.3f s, %.0f MB", parse[load], parse[loadBytes] / mb);
  if (holdsImages) std::printf("; with images decoded %.3f s, %.0f MB", decode[load], decode[loadBytes] / mb);
  std::printf(
      "\n  load %.3f s, %.0f MB (%.2f times the parse%s); maps %.3f s, world %.3f s, upload %.3f s, "
      "first frame %.3f s\n",
      f[load], f[loadBytes] / mb, f[load] / decode[load], holdsImages ? " with images" : "", f[maps],
      f[world], f[upload], f[frame]);
  std::printf("  file to first frame %.3f s (%.2f times the parse), peak %.0f MB\n", f[total],
              f[total] / decode[load], f[totalBytes] / mb);
  std::printf("  per million triangles: bare parse %.3f s, load %.3f s, first frame %.3f s, %.0f MB\n",
              parse[load] / millions, f[load] / millions, f[total] / millions, f[totalBytes] / mb / millions);
}

int run(int argc, char** argv) {
  app::setupLog();
  if (argc < 3) {
    std::fprintf(stderr, "usage: bench_load REPEATS SCENE[@UNIT_SCALE]...\n");
    return 2;
  }
  printProvenance(argc, argv);
  for (int i = 2; i < argc; ++i) {
    const std::string text = argv[i];
    const std::size_t at = text.rfind('@');
    const Subject subject{text.substr(0, at),
                          at == std::string::npos ? 1 : std::strtof(text.c_str() + at + 1, nullptr)};
    measure(subject, std::max(1, std::atoi(argv[1])));
  }
  return 0;
}

}  // namespace
}  // namespace saccade::bench

int main(int argc, char** argv) { return saccade::bench::run(argc, argv); }
