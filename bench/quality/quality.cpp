// How far is the converged picture from the path-traced one, and what is the rest made of?
// For a scene at 256x256: `corrective --converge` against `path`, as FLIP and relative MSE, then with one
// cause after another taken away: glossy noise (64 sub-samples), aliasing (rendered four times as large and
// box-filtered down), and the base layer alone against the path tracer's diffuse transport, on diffuse pixels
// (the maps). Usage: bench_quality SCENE.glb [PATH_SPP] [QUALITY]
#include <cstdlib>

#include "bench/common.h"
#include "core/composite.h"
#include "core/metrics/comparison.h"
#include "raytrace/path_tracer.h"
#include "raytrace/reference.h"

namespace saccade::bench {
namespace {

constexpr int kSide = 256;
constexpr int kOversampling = 4;

core::ImageRgb boxFiltered(const core::ImageRgb& large, int factor) {
  core::ImageRgb small(large.width() / factor, large.height() / factor);
  for (int y = 0; y < large.height(); ++y) {
    for (int x = 0; x < large.width(); ++x)
      small.at(x / factor, y / factor) += large.at(x, y) / static_cast<float>(factor * factor);
  }
  return small;
}

struct Renderer {
  const app::Workspace& workspace;
  app::Headless gl;
  core::Camera camera;
  int threads;

  core::FramePtr base(int side) {
    return gl.renderer->render(core::View(camera, side, side, workspace.scene.bounds), 1, 10);
  }

  core::ImageRgb converged(int side, int subSamples) {
    app::FrameLoopOptions options;
    options.threads = threads;
    options.corrective.samplesPerPixel = subSamples;
    app::FrameLoop loop(workspace, *gl.renderer, options);
    loop.step(camera, {side, side}, app::FrameBudget::untilConverged());
    return loop.linear();
  }

  core::ImageRgb path(int samples, raytrace::Transport transport) {
    raytrace::PathOptions options;
    options.samplesPerPixel = samples;
    options.transport = transport;
    options.threads = threads;
    app::ProgressBar bar("path tracing");
    return raytrace::tracePaths(*workspace.world, core::View(camera, kSide, kSide, workspace.scene.bounds),
                                options, {[&](double f) { bar.show(f); }, app::interruptToken()})
        .radiance;
  }
};

void print(const char* what, const core::Comparison& c) {
  std::printf("%-64s FLIP %.4f  relative MSE %.5f\n", what, c.flip, c.relmse);
}

/// Both pictures with the non-diffuse pixels black, so that only the maps are compared.
core::ImageRgb diffuseOnly(const core::FrameSnapshot& frame, core::ImageRgb image) {
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (frame.idAt(x, y) != 0) image.at(x, y) = core::Vec3(0);
    }
  }
  return image;
}

int run(int argc, char** argv) {
  app::setupLog();
  printProvenance(argc, argv);
  const std::string scene = argc > 1 ? argv[1] : bundledScene("cornell");
  const int spp = argc > 2 ? std::atoi(argv[2]) : 1024;
  const auto workspace = openScene(scene, argc > 3 ? argv[3] : "medium");
  Renderer r{*workspace, app::Headless({}, *workspace), workspace->scene.cameras[0],
             static_cast<int>(std::thread::hardware_concurrency())};
  const core::ImageRgb reference = r.path(spp, raytrace::Transport::all);
  const core::ImageRgb half = r.path(std::max(1, spp / 4), raytrace::Transport::all);
  std::printf("%s, %dx%d, reference of %d samples a pixel\n", scene.c_str(), kSide, kSide, spp);
  print("the reference's own noise (a quarter of its samples against it)",
        core::compareLinear(reference, half));
  print("corrective --converge", core::compareLinear(reference, r.converged(kSide, 1)));
  print("  without glossy noise (--spp 64)", core::compareLinear(reference, r.converged(kSide, 64)));
  const core::ImageRgb smooth = boxFiltered(r.converged(kSide * kOversampling, 4), kOversampling);
  print("  without aliasing either (4x4 as large, box filter)", core::compareLinear(reference, smooth));
  const core::FramePtr frame = r.base(kSide);
  const core::ImageRgb base = core::compositeLinear(kSide, kSide, frame->baseAndId, {});
  print("maps: base against all light, diffuse pixels only",
        core::compareLinear(diffuseOnly(*frame, reference), diffuseOnly(*frame, base)));
  std::printf("lobes left out: mean albedo %.4f of the objects treated as diffuse\n",
              workspace->plan.diffuseEnergyLeftOut);
  return 0;
}

}  // namespace
}  // namespace saccade::bench

int main(int argc, char** argv) { return saccade::bench::run(argc, argv); }
