#include "bench/load/load.h"

#include <array>

#include "app/session/headless.h"
#include "app/session/stats.h"
#include "app/session/workspace.h"
#include "bench/load/bare_parse.h"
#include "bench/load/subjects.h"

namespace saccade::bench {
namespace {

constexpr app::ImageSize kSize{512, 512};

/// Else decoding them is not parsing's: an .obj's images lie beside it.
bool holdsImages(const Subject& s) { return !s.file.ends_with(".obj"); }

double peak() { return static_cast<double>(app::peakBytes()); }

/// Figures by name, round by round.
using Rounds = std::map<std::string, std::vector<double>>;
void append(Rounds& rounds, const Figures& figures) {
  for (const auto& [name, value] : figures) rounds[name].push_back(value);
}

Record recordOf(const Subject& s, const Rounds& parse, const Rounds& decode, const Rounds& ours) {
  const std::string name = sceneName(s.file);
  const double triangles = ours.at("triangles").front();
  Record record;
  record.key = "load/" + name;
  record.labels = {{"scene", name}};
  record.values = {
      {"triangles", Value::count(triangles)},
      {"parse", Value::seconds(parse.at("seconds"))},
      {"parse_bytes", Value::bytes(spread(parse.at("bytes")).median)},
      {"parse_images_bytes", Value::bytes(spread(decode.at("bytes")).median)},
      {"load_bytes", Value::bytes(spread(ours.at("load_bytes")).median)},
      {"bytes", Value::bytes(spread(ours.at("bytes")).median)},
      {"load_ratio", Value::ratio(ratios(ours.at("load"), decode.at("seconds")), Better::lower)},
      {"total_ratio", Value::ratio(ratios(ours.at("total"), decode.at("seconds")), Better::lower)}};
  if (holdsImages(s)) record.values["parse_images"] = Value::seconds(decode.at("seconds"));
  for (const char* stage : {"load", "maps", "world", "upload", "frame", "total"})
    record.values[stage] = Value::seconds(ours.at(stage));
  record.values["total_per_million"] = record.values.at("total").times(1e6 / triangles);
  record.values["bytes_per_million"] = record.values.at("bytes").times(1e6 / triangles);
  return record;
}

void measureScene(Session& session, const Subject& s) {
  // So that every process finds the maps in the cache.
  app::openWorkspace(optionsOf(s), {.threads = app::tracerThreads({})}, session.stop());
  const LoadWatch watch;
  std::array<Rounds, 3> rounds;  // bare parse, the same with images, ours
  const auto once = [&](int variant) {
    if (variant == 2) return inChild("load", {s.file, s.unitScale}, session.stop());
    return inChild("parse", {s.file, variant == 1 && holdsImages(s) ? "images" : "encoded"}, session.stop());
  };
  alternate(3, kRepeats, session.stop(), [&](int variant, int round) {
    const Figures figures = once(variant);
    if (round >= 0) append(rounds[static_cast<std::size_t>(variant)], figures);
  });
  session.add(recordOf(s, rounds[0], rounds[1], rounds[2]), &watch);
}

}  // namespace

Figures parseFile(const Arguments& arguments, const std::stop_token&) {
  const double before = peak();
  const double seconds = timed([&] { parseBare(arguments.at(0), arguments.at(1) == "images"); });
  return {{"seconds", seconds}, {"bytes", peak() - before}};
}

Figures loadAndDraw(const Arguments& arguments, const std::stop_token&) {
  const double before = peak();
  const app::SceneOptions options = optionsOf({arguments.at(0), arguments.at(1)});
  app::Workspace w;
  Figures f;
  f["load"] = timed([&] {
    w.scene = core::loadScene(options.path, options.load);
    w.plan = core::makePlan(w.scene);
  });
  f["load_bytes"] = peak() - before;
  f["triangles"] = static_cast<double>(w.scene.triangleCount());
  f["maps"] = timed([&] {
    const std::uint64_t key = core::sceneKey(w.scene);
    w.maps = core::readMaps(app::mapsPath(key, options, {}), key);
    core::applyCharts(w.scene, w.maps.charts);
  });
  f["world"] = timed([&] {
    w.world = std::make_unique<raytrace::World>(w.scene, w.plan);
    w.world->setMaps(&w.maps);
  });
  std::unique_ptr<app::Headless> gl;
  f["upload"] = timed([&] { gl = std::make_unique<app::Headless>(app::RunOptions{}, w); });
  f["frame"] = timed([&] {
    const core::View view(w.scene.cameras[0], kSize.width, kSize.height, w.scene.bounds);
    gl->renderer->render(view, 1, app::CorrectiveOptions{}.nMin);
  });
  f["total"] = f["load"] + f["maps"] + f["world"] + f["upload"] + f["frame"];
  f["bytes"] = peak() - before;
  return f;
}

void measureLoad(Session& session) {
  for (const Subject& subject : subjectsOf(session, "load", {"gallery"})) {
    session.say("load: " + sceneName(subject.file));
    measureScene(session, subject);
  }
}

}  // namespace saccade::bench
