#include "app/cli/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <map>
#include <thread>

#include "core/error.h"
#include "raytrace/bake/quality.h"

namespace saccade::app {

CLI::Option* addSceneOptions(CLI::App& command, SceneOptions& o) {
  const std::string group = "Scene";
  CLI::Option* scene = command.add_option("SCENE", o.path, "glTF (.glb, .gltf) or OBJ file")->required();
  std::vector<std::string> qualities;
  for (const raytrace::Quality& q : raytrace::qualities()) qualities.emplace_back(q.name);
  command.add_option("--maps", o.mapsFile, "Illumination map file to use (default: the user's cache folder)")
      ->group(group);
  command
      .add_option(
          "--quality", o.quality,
          "Quality of the maps when they have to be baked: wished for are errors of 10 %, 5 % or 2 % of the "
          "mean light")
      ->check(CLI::IsMember(qualities))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--maps-mb", o.mapsMegabytes,
                  "Most memory for the texels of illumination maps, MiB, when they have to be baked")
      ->check(CLI::Range(1, 192))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--light", o.load.lights,
                  "Add a light: point:pos=x,y,z,power=r,g,b | spot:... | directional:... | "
                  "panel:at=x,y,z,size=w,h,radiance=r,g,b")
      ->allow_extra_args(false)  // or it would swallow the scene's name behind it
      ->group(group);
  command
      .add_option("--environment", o.load.environment,
                  "Light the scene from all around by this equirectangular image, OpenEXR or Radiance .hdr; "
                  "it shows behind the scene")
      ->option_text("FILE")
      ->group(group);
  command
      .add_option("--environment-rotation", o.load.environmentOptions.rotationDegrees,
                  "Turn the environment about the vertical axis: degrees, counter-clockwise seen from above "
                  "(0: its middle lies along -Z)")
      ->option_text("DEGREES [0]")
      ->group(group);
  command
      .add_option("--environment-scale", o.load.environmentOptions.scale,
                  "Multiply the environment's radiance by this")
      ->check(CLI::NonNegativeNumber)
      ->option_text("FACTOR [1]")
      ->group(group);
  command.add_option("--unit-scale", o.load.unitScale, "Metres per unit of the file")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--nondiffuse", o.load.nonDiffuseThreshold,
                  "An object is corrected when the albedo of its lobes other than Lambert exceeds this")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str()
      ->group(group);
  command
      .add_option_function<double>(
          "--max-memory",
          [&o](double mebibytes) {
            o.load.limits.memoryBytes = static_cast<std::uint64_t>(mebibytes * (1u << 20));
          },
          "MiB that reading the scene's files may take (default: half of the machine's, at most 8192)")
      ->check(CLI::Range(1.0, 1e9))
      ->group(group);
  command
      .add_option("--max-load-seconds", o.load.limits.seconds,
                  "Seconds that reading the scene's files may take")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group(group);
  command.add_option("--scene", o.load.scene, "glTF scene index (default: the file's own choice)")
      ->group(group);
  command
      .add_option("--time", o.load.timeSeconds, "Time in seconds at which the file's animations are shown")
      ->capture_default_str()
      ->group(group);
  return scene;
}

void addCameraOptions(CLI::App& command, CameraOptions& o) {
  const std::string group = "Camera";
  command.add_option("--camera", o.camera, "Camera of the file, by name or number from 0")->group(group);
  command.add_option("--eye", o.eye, "Eye position x,y,z in metres")
      ->delimiter(',')
      ->expected(3)
      ->group(group);
  command.add_option("--at", o.at, "Point looked at x,y,z")->delimiter(',')->expected(3)->group(group);
  command.add_option("--up", o.up, "Up direction x,y,z")->delimiter(',')->expected(3)->group(group);
  command.add_option("--fov", o.fovDegrees, "Vertical field of view in degrees")
      ->check(CLI::Range(0.1, 179.9))
      ->group(group);
}

void addRunOptions(CLI::App& command, RunOptions& o) {
  const std::string group = "Running";
  command.add_option("--context", o.context, "OpenGL off screen: osmesa or egl")
      ->check(CLI::IsMember({"osmesa", "egl"}))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--threads", o.threads,
                  "Ray-tracing threads; 0 runs every stage inline with a virtual clock "
                  "(default: one less than the cores)")
      ->check(CLI::Range(0, 256))
      ->group(group);
  command.add_option("--seed", o.seed, "Seed of all random numbers")->capture_default_str()->group(group);
  command.add_option("--exposure", o.exposureEv, "Display exposure in EV (x 2^EV)")
      ->check(CLI::Range(-32.0, 32.0))
      ->capture_default_str()
      ->group(group);
  command.add_option("--stats", o.statsFile, "Write counts and times to this JSON file")->group(group);
}

const std::map<std::string, AgingTest>& agingTests() {
  static const std::map<std::string, AgingTest> kTests{{"haber", AgingTest::haber},
                                                       {"change", AgingTest::change}};
  return kTests;
}

void addSaliencyOptions(CLI::App& command, attention::SaliencyOptions& o) {
  const std::string group = "Saliency";
  using attention::Normalisation;
  static const std::map<std::string, Normalisation> kNormalisations{{"max", Normalisation::max},
                                                                    {"dog", Normalisation::dog}};
  command
      .add_option(
          "--normalise", o.normalise,
          "How maps with few strong peaks are promoted: max (Itti, Koch and Niebur 1998) or dog (Itti "
          "and Koch 2001: sparser, slower)")
      ->transform(CLI::CheckedTransformer(kNormalisations))
      ->option_text("NAME [max]")
      ->group(group);
  command
      .add_flag("--orientation", o.orientation,
                "Edges and lines of odd orientation are salient, too (Itti, Koch and Niebur 1998; Haber 2001 "
                "leaves them out)")
      ->group(group);
}

void addCorrectiveOptions(CLI::App& command, CorrectiveOptions& o) {
  const std::string group = "Corrections";
  using attention::Order;
  static const std::map<std::string, Order> kOrders{
      {"attention", Order::attention}, {"importance", Order::importance}, {"gain", Order::gain},
      {"task", Order::task},           {"random", Order::random},         {"scanline", Order::scanline},
      {"largest", Order::largest}};
  command
      .add_option("--attention", o.attention.attention, "0 = saliency decides, 1 = task importance decides")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str()
      ->group(group);
  command
      .add_option(
          "--order", o.attention.order,
          "What is corrected first: attention (importance times what samples have changed there so far), "
          "importance (saliency and task alone, the paper's), gain (what samples changed alone), task, "
          "random, scanline, largest")
      ->transform(CLI::CheckedTransformer(kOrders))
      ->option_text("NAME [attention]")
      ->group(group);
  command
      .add_option(
          "--inhibition", o.inhibition,
          "Inhibition of return: the share of its priority that an object loses with each level of "
          "samples; 0 = winner takes all (the first in the order is corrected until it has converged), "
          "0.1 = the paper's 10 % rule, 0.9 = level by level, whatever the order")
      ->check(CLI::Range(0.0, 0.9))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--aging", o.aging,
                  "Test that cached samples must pass: haber (the paper's section 4.5: change of <normal, "
                  "view direction>) or change (expected change of what is displayed, sample by sample)")
      ->transform(CLI::CheckedTransformer(agingTests()))
      ->option_text("NAME [haber]")
      ->group(group);
  command
      .add_option(
          "--delta", o.delta,
          "Aging: tolerated change; of <normal, view direction> for haber, as displayed (0 to 1) for change")
      ->check(CLI::Range(0.0, 2.0))
      ->capture_default_str()
      ->group(group);
  command.add_option("--nmin", o.nMin, "Fewest samples of the level an object starts at")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str()
      ->group(group);
  command.add_option("--max-age", o.maxAge, "Samples older than this many camera changes are dropped")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str()
      ->group(group);
  command
      .add_option(
          "--cache-mb", o.cacheMb,
          "Memory for cached samples, MB; when it is used up the oldest, least salient ones leave. 0 turns "
          "reuse off")
      ->check(CLI::Range(0, 65536))
      ->capture_default_str()
      ->group(group);
  command.add_option("--job-size", o.jobSize, "Samples a tracer computes before it asks for the next region")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str()
      ->group(group);
  static const std::map<std::string, bool> kApproximations{{"probe", true}, {"none", false}};
  command
      .add_option("--approximation", o.approximation,
                  "What shows where nothing is corrected yet: probe (light probes, drawn from the maps) or "
                  "none (the base layer alone). The converged picture is the same")
      ->transform(CLI::CheckedTransformer(kApproximations))
      ->option_text(o.approximation ? "NAME [probe]" : "NAME [none]")
      ->group(group);
  command
      .add_option("--spp", o.samplesPerPixel,
                  "Sub-samples a pixel (corrective, raytrace: averaged at the pixel centre; path: "
                  "over the pixel's square)")
      ->check(CLI::Range(1, 1 << 20))
      ->group(group);
  addSaliencyOptions(command, o.attention.saliency);
}

void addSizeOption(CLI::App& command, ImageSize& size) {
  command
      .add_option_function<std::string>(
          "--size",
          [&size](const std::string& text) {
            const std::size_t x = text.find('x');
            const char* end = text.data() + text.size();
            auto bad = [&] {
              throw CLI::ValidationError("--size", "expected WIDTHxHEIGHT such as 512x512, got " + text);
            };
            if (x == std::string::npos) bad();
            const auto first = std::from_chars(text.data(), text.data() + x, size.width);
            const auto second = std::from_chars(text.data() + x + 1, end, size.height);
            if (first.ptr != text.data() + x || second.ptr != end || size.width < 1 || size.height < 1) bad();
          },
          "Image size WIDTHxHEIGHT")
      ->default_str("512x512");
}

namespace {

core::Vec3 toVec3(const std::vector<float>& v) { return {v[0], v[1], v[2]}; }

const core::Camera& cameraByName(const core::Scene& scene, const std::string& name) {
  for (const core::Camera& camera : scene.cameras) {
    if (camera.name == name) return camera;
  }
  std::size_t index = 0;
  const auto parsed = std::from_chars(name.data(), name.data() + name.size(), index);
  if (parsed.ptr == name.data() + name.size() && index < scene.cameras.size()) return scene.cameras[index];
  std::string known;
  for (const core::Camera& camera : scene.cameras) known += (known.empty() ? "" : ", ") + camera.name;
  throw core::UsageError("no camera '" + name + "' in " + scene.path + "; it has: " + known);
}

}  // namespace

core::Camera chooseCamera(const core::Scene& scene, const CameraOptions& o) {
  core::Camera camera = o.camera.empty() ? scene.cameras.at(0) : cameraByName(scene, o.camera);
  const core::Vec3 sight = camera.at - camera.eye;
  if (!o.eye.empty()) {
    camera.eye = toVec3(o.eye);
    camera.at = camera.eye + sight;
  }
  if (!o.at.empty()) camera.at = toVec3(o.at);
  if (!o.up.empty()) camera.up = toVec3(o.up);
  if (o.fovDegrees) camera.fovYDegrees = *o.fovDegrees;
  return camera;
}

int tracerThreads(const RunOptions& options) {
  if (options.threads >= 0) return options.threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()) - 1);
}

}  // namespace saccade::app
