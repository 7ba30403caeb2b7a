#include "bench/load/first_frame.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/session/workspace.h"
#include "bench/harness/process.h"
#include "bench/load/subjects.h"
#include "core/error.h"

namespace saccade::bench {
namespace {

/// The window's own figures, seconds by metric.
using Times = std::map<std::string, double>;

/// Opens the scene in a window of the usual size, with nobody's kept settings, and closes it again.
Times openInWindow(const Subject& s, const std::filesystem::path& folder, const std::stop_token& stop) {
  const std::filesystem::path stats = folder / "first-frame.json";
  outputOf("walk " + sceneName(s.file),
           {"env", "XDG_CONFIG_HOME=" + folder.string(), std::filesystem::read_symlink("/proc/self/exe"),
            "walk", s.file, "--unit-scale", s.unitScale, "--quality", kSubjectQuality, "--exit-after", "0.1",
            "--stats", stats.string()},
           stop);
  const nlohmann::json json = nlohmann::json::parse(std::ifstream(stats));
  std::filesystem::remove(stats);
  Times out;
  for (const char* name : {"first_frame", "first_walk", "longest_wait"})
    out[name] = json.at(std::string(name) + "_ms").get<double>() / 1000;
  return out;
}

void measureScene(Session& session, const Subject& s, const std::filesystem::path& folder) {
  // So that every window finds the maps in the cache.
  const std::size_t triangles =
      app::openWorkspace(optionsOf(s), {.threads = app::tracerThreads({})}, session.stop())
          ->scene.triangleCount();
  const LoadWatch watch;
  std::map<std::string, std::vector<double>> rounds;
  alternate(1, kRepeats, session.stop(), [&](int, int round) {
    const Times times = openInWindow(s, folder, session.stop());
    if (round < 0) return;
    for (const auto& [name, seconds] : times) rounds[name].push_back(seconds);
  });
  Record record;
  record.key = "first-frame/" + sceneName(s.file);
  record.labels = {{"scene", sceneName(s.file)}};
  record.values["triangles"] = Value::count(static_cast<double>(triangles));
  for (const auto& [name, seconds] : rounds) record.values[name] = Value::seconds(seconds);
  session.add(record, &watch);
}

}  // namespace

void measureFirstFrame(Session& session) {
  const char* display = std::getenv("DISPLAY");
  if (!display || !*display) {
    session.say("first-frame: no display for the window; left out (run it under xvfb-run, or see 'load')");
    return;
  }
  const std::filesystem::path folder = session.options().folder / "first-frame";
  std::filesystem::create_directories(folder);
  for (const Subject& subject : subjectsOf(session, "first-frame", {"cornell", "table", "gallery"})) {
    session.say("first-frame: " + sceneName(subject.file));
    measureScene(session, subject, folder);
  }
  std::filesystem::remove_all(folder);
}

}  // namespace saccade::bench
