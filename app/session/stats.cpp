#include "app/session/stats.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "core/error.h"

namespace saccade::app {

double RunStats::framePercentileMs(double p) const {
  if (frameMs.empty()) return 0;
  std::vector<double> sorted = frameMs;
  std::sort(sorted.begin(), sorted.end());
  const double rank = std::ceil(p * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::clamp(rank - 1, 0.0, static_cast<double>(sorted.size() - 1)))];
}

std::uint64_t peakBytes() {
  // Not getrusage's, which remembers the process before its exec.
  std::ifstream status("/proc/self/status");
  for (std::string field; status >> field;) {
    std::uint64_t kib = 0;
    if (field == "VmHWM:" && status >> kib) return kib * 1024;
  }
  return 0;
}

void writeStats(const std::filesystem::path& file, const RunStats& s) {
  nlohmann::ordered_json json;
  const double mean = s.frameMs.empty() ? 0
                                        : std::accumulate(s.frameMs.begin(), s.frameMs.end(), 0.0) /
                                              static_cast<double>(s.frameMs.size());
  json["frame_ms"] = {{"mean", mean},
                      {"p50", s.framePercentileMs(0.50)},
                      {"p95", s.framePercentileMs(0.95)},
                      {"p99", s.framePercentileMs(0.99)}};
  json["missed_deadlines"] = s.missedDeadlines;
  json["frames"] = s.frameMs.size();
  json["samples"] = {{"traced", s.samplesTraced},
                     {"reused", s.samplesReused},
                     {"resumed", s.samplesResumed},
                     {"dropped", s.samplesDropped}};
  json["samples_per_frame"] = s.samplesPerFrame;
  for (int level = 1; level <= core::Lattice::kMaxLevel; ++level) {
    json["levels"][std::to_string(level)] = s.levels[static_cast<std::size_t>(level)];
  }
  json["nondiffuse_pixels"] = s.nonDiffusePixels;
  json["from_depth"] = s.fromDepth;
  json["rays"] = s.rays;
  json["rays_per_second"] = s.tracingSeconds > 0 ? static_cast<double>(s.rays) / s.tracingSeconds : 0;
  json["stages_ms"] = s.stageMs;
  json["peak_bytes"] = peakBytes();
  json["converged"] = s.converged;
  if (s.firstFrameMs > 0) json["first_frame_ms"] = s.firstFrameMs;
  if (s.firstWalkMs > 0) json["first_walk_ms"] = s.firstWalkMs;
  if (s.longestWaitMs > 0) json["longest_wait_ms"] = s.longestWaitMs;
  json["seed"] = s.seed;
  json["threads"] = s.threads;
  json["context"] = s.context;
  json["renderer"] = s.renderer;
  std::ofstream stream(file);
  stream << json.dump(2) << '\n';
  if (!stream.flush())
    throw core::Error(file.string() + ": cannot be written; check the folder given to --stats");
}

}  // namespace saccade::app
