// What the benchmark programs share: repeats, medians, scenes, and the line that says where numbers come
// from.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "app/cli/console.h"
#include "app/session/camera_path.h"
#include "app/session/frame_loop.h"
#include "app/session/headless.h"
#include "app/session/workspace.h"

namespace saccade::bench {

using Clock = std::chrono::steady_clock;

inline double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Wall seconds of one call.
template <class F>
double timed(F&& f) {
  const Clock::time_point start = Clock::now();
  f();
  return secondsSince(start);
}

/// Lower median and range of at least one value.
struct Spread {
  double median = 0, min = 0, max = 0;
};
inline Spread spread(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {values[(values.size() - 1) / 2], values.front(), values.back()};
}

inline std::string firstLineOf(const std::string& command) {
  char line[256] = "";
  if (FILE* pipe = popen(command.c_str(), "r")) {
    if (!std::fgets(line, sizeof line, pipe)) line[0] = '\0';
    pclose(pipe);
  }
  std::string text = line;
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

inline void printProvenance(int argc, char** argv) {
  std::string command = argv[0];
  command = command.substr(command.rfind('/') + 1);
  for (int i = 1; i < argc; ++i) command += std::string(" ") + argv[i];
  const std::string cpu = firstLineOf("grep -m1 'model name' /proc/cpuinfo | cut -d: -f2");
  const std::string commit = firstLineOf("git -C '" SACCADE_SOURCE_DIR "' describe --always --dirty");
  double load = 0;
  std::ifstream("/proc/loadavg") >> load;
  std::printf("# %s; commit %s;%s, %u cores, load at start %.1f\n", command.c_str(), commit.c_str(),
              cpu.c_str(), std::thread::hardware_concurrency(), load);
}

inline std::string bundledScene(const std::string& name) {
  return std::string(SACCADE_SOURCE_DIR) + "/data/scenes/" + name + ".glb";
}
inline std::string bundledPath(const std::string& name) {
  return std::string(SACCADE_SOURCE_DIR) + "/data/paths/" + name + ".json";
}

inline std::unique_ptr<app::Workspace> openScene(const std::string& file,
                                                 const std::string& quality = "preview") {
  app::SceneOptions options;
  options.path = file;
  options.quality = quality;
  return app::openWorkspace(options, {.threads = static_cast<int>(std::thread::hardware_concurrency())}, {});
}

}  // namespace saccade::bench
