#include "bench/harness/machine.h"

#include <sched.h>
#include <sys/resource.h>
#include <sys/sysinfo.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <numeric>
#include <sstream>
#include <thread>

#include "app/session/stats.h"

namespace saccade::bench {
namespace {

constexpr double kShortestWatch = 0.2;  ///< seconds; the kernel counts in hundredths

std::string cpuName() { return firstLineOf("sed -n 's/^model name[^:]*: //p' /proc/cpuinfo"); }

std::string packageVersion(const std::string& package) {
  return firstLineOf("dpkg-query -W -f='${Version}' " + package + " 2>/dev/null");
}

std::string utcNow() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

double secondsOf(const rusage& r) {
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(r.ru_utime) + seconds(r.ru_stime);
}

std::vector<int> allowedCores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  std::vector<int> cores;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return cores;
  for (int i = 0; i < CPU_SETSIZE; ++i) {
    if (CPU_ISSET(i, &set)) cores.push_back(i);
  }
  return cores;
}

void setCores(const std::vector<int>& cores) {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int core : cores) CPU_SET(core, &set);
  // Where the system forbids it the measurement goes on unpinned: its spread says so.
  if (!cores.empty()) sched_setaffinity(0, sizeof set, &set);
}

/// Asked once, before anything is pinned.
const std::vector<int>& allCores() {
  static const std::vector<int> cores = allowedCores();
  return cores;
}

}  // namespace

std::string firstLineOf(const std::string& command) {
  char line[256] = "";
  if (FILE* pipe = popen(command.c_str(), "r")) {
    if (!std::fgets(line, sizeof line, pipe)) line[0] = '\0';
    pclose(pipe);
  }
  std::string text = line;
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

RunInfo describeRun(const std::string& command, std::uint32_t seed) {
  const std::string git = "git -C '" SACCADE_SOURCE_DIR "' ";
  RunInfo run;
  run.commit = firstLineOf(git + "rev-parse --short HEAD 2>/dev/null");
  if (run.commit.empty()) run.commit = "unknown";
  run.dirty = !firstLineOf(git + "status --porcelain --untracked-files=no 2>/dev/null").empty();
  run.command = command;
  run.seed = seed;
  run.started = utcNow();
  run.cpu = cpuName();
  run.cores = static_cast<int>(std::thread::hardware_concurrency());
  run.os = firstLineOf("sed -n 's/^PRETTY_NAME=\"\\(.*\\)\"/\\1/p' /etc/os-release");
  utsname system{};
  if (uname(&system) == 0) run.kernel = system.release;
  struct sysinfo memory {};
  if (sysinfo(&memory) == 0) run.memoryBytes = std::uint64_t{memory.totalram} * memory.mem_unit;
  run.software = {{"embree", packageVersion("libembree3-3")},
                  {"mesa", packageVersion("libosmesa6")},
                  {"opencv", packageVersion("libopencv-core406")},
                  {"compiler", "g++ " __VERSION__}};
  return run;
}

PeakMemory::PeakMemory() {
  std::ofstream("/proc/self/clear_refs") << "5";  // proc(5): resets the peak resident set size
}

std::uint64_t PeakMemory::bytes() const { return app::peakBytes(); }

LoadWatch::LoadWatch() : start_(now()) {}

std::optional<LoadWatch::Ticks> LoadWatch::now() {
  std::ifstream stat("/proc/stat");
  std::string line, name;
  if (!std::getline(stat, line)) return std::nullopt;
  std::istringstream fields(line);
  std::array<double, 8> ticks{};  // user nice system idle iowait irq softirq steal
  fields >> name;
  for (double& t : ticks) fields >> t;
  if (!fields || name != "cpu") return std::nullopt;
  const auto perSecond = static_cast<double>(sysconf(_SC_CLK_TCK));
  const double total = std::accumulate(ticks.begin(), ticks.end(), 0.0);
  rusage self{}, children{};
  getrusage(RUSAGE_SELF, &self);
  getrusage(RUSAGE_CHILDREN, &children);
  return Ticks{(total - ticks[3] - ticks[4]) / perSecond, total / perSecond,
               secondsOf(self) + secondsOf(children)};
}

std::optional<double> LoadWatch::othersShare() const {
  const std::optional<Ticks> end = now();
  if (!start_ || !end || end->total - start_->total < kShortestWatch) return std::nullopt;
  const double others = (end->busy - start_->busy) - (end->own - start_->own);
  return std::clamp(others / (end->total - start_->total), 0.0, 1.0);
}

Pinned::Pinned(const std::vector<int>& cores) {
  allCores();
  before_ = allowedCores();
  setCores(cores);
}

Pinned::~Pinned() { setCores(before_); }

std::vector<int> mainCores() {
  const std::vector<int>& all = allCores();
  return all.empty() ? all : std::vector<int>{all.front()};
}

std::vector<int> workerCores(int workers) {
  const std::vector<int>& all = allCores();
  if (workers >= static_cast<int>(all.size())) return all;
  return {all.begin() + 1, all.end()};
}

}  // namespace saccade::bench
