#include "raytrace/reference.h"

#include <algorithm>

#include "raytrace/parallel_rows.h"

namespace saccade::raytrace {

TraceAllResult traceAll(const CorrectiveTracer& tracer, const core::FrameSnapshot& frame, int threads,
                        const core::Progress& progress) {
  struct alignas(64) Tally {
    RayCounters counters;
    std::uint64_t traced = 0, fromDepth = 0;
  };
  const int width = frame.view.width(), height = frame.view.height();
  TraceAllResult result;
  result.corrections.assign(static_cast<std::size_t>(width) * height, core::Vec4(0));
  std::vector<Tally> tallies(std::max(threads, 1));
  parallelRows(height, threads, progress, [&](int y, int worker) {
    Tally& tally = tallies[worker];
    std::vector<core::Pixel> pixels;
    for (int x = 0; x < width; ++x) {
      if (frame.idAt(x, y) != 0) pixels.push_back({x, y});
    }
    std::vector<core::Sample> samples;
    tracer.trace(frame, pixels, core::Lattice::kMaxLevel, tally.counters, samples);
    for (const core::Sample& s : samples) {
      result.corrections[frame.index(s.x, s.y)] = core::Vec4(s.correction, 1);
      ++tally.traced;
      tally.fromDepth += s.fromDepth;
    }
  });
  for (const Tally& t : tallies) {
    result.counters.add(t.counters);
    result.traced += t.traced;
    result.fromDepth += t.fromDepth;
  }
  return result;
}

}  // namespace saccade::raytrace
