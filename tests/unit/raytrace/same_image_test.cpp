// Numerics 28 of the hard cases: the same image for any number of threads, flush-to-zero on or off.
#include <gtest/gtest.h>
#include <xmmintrin.h>

#include "raytrace/corrective_tracer.h"
#include "raytrace/path_tracer.h"
#include "raytrace/reference.h"
#include "tests/hard_case.h"
#include "tests/unit/raytrace/corrective_scenes.h"

namespace saccade::raytrace {
namespace {

using namespace tests;

/// Subnormal results and operands become 0, as Embree recommends; threads inherit it.
class FlushToZero {
 public:
  FlushToZero() { _mm_setcsr(before_ | kFlush | kDenormalsAreZero); }
  ~FlushToZero() { _mm_setcsr(before_); }
  FlushToZero(const FlushToZero&) = delete;
  FlushToZero& operator=(const FlushToZero&) = delete;

 private:
  static constexpr unsigned kFlush = 0x8000, kDenormalsAreZero = 0x0040;
  unsigned before_ = _mm_getcsr();
};

core::View roomView(const core::Scene& scene, int width, int height) {
  return {cameraAt({0, 0, 2.9f}, Vec3(0)), width, height, scene.bounds};
}

PathResult pathsOnThreads(const World& world, int threads) {
  PathOptions o;
  o.samplesPerPixel = 4;
  o.bounces = 6;
  o.variance = true;
  o.threads = threads;
  return tracePaths(world, roomView(world.scene(), 40, 30), o, {});
}

TEST(PathTracer, Hard28TheSameForAnyNumberOfThreads) {
  const SceneMaker m = room();
  const World world(m.scene, planOf());
  const PathResult one = pathsOnThreads(world, 0);
  HardCase changed =
      HardCase::counting("path-traced pixels on 1, 2 and 8 threads that differ from 0", "pixels");
  for (int threads : {1, 2, 8}) {
    const PathResult many = pathsOnThreads(world, threads);
    EXPECT_TRUE(changed.within(differing(one.radiance.pixels(), many.radiance.pixels()), 0)) << threads;
    EXPECT_TRUE(changed.within(differing(one.variance.pixels(), many.variance.pixels()), 0)) << threads;
    EXPECT_EQ(one.counters.rays, many.counters.rays);
  }
}

TEST(Reference, Hard28TheSameForAnyNumberOfThreadsAndForTheSingleSample) {
  const SceneMaker m = room();
  World world(m.scene, planOf());
  const core::IlluminationMaps maps = constantMaps(kHalfOne);
  world.setMaps(&maps);
  const CorrectiveTracer tracer(world, {});
  const auto frame = frameOf(world, cameraAt({0, 0, 2.9f}, Vec3(0)), 60, 50);
  const TraceAllResult inlined = traceAll(tracer, *frame, 0, {});
  EXPECT_EQ(inlined.traced, frame->nonDiffusePixels);
  EXPECT_GT(inlined.traced, 300u);
  EXPECT_EQ(inlined.counters.nonFinite, 0u);
  HardCase changed = HardCase::counting("corrections on 1, 2 and 8 threads that differ from 0", "pixels");
  for (int threads : {1, 2, 8}) {
    const TraceAllResult r = traceAll(tracer, *frame, threads, {});
    EXPECT_TRUE(changed.within(differing(r.corrections, inlined.corrections), 0)) << threads;
    EXPECT_EQ(r.counters.rays, inlined.counters.rays);
  }
  RayCounters counters;
  double energy = 0;
  for (int y = 0; y < 50; ++y) {
    for (int x = 0; x < 60; ++x) {
      if (frame->idAt(x, y) == 0) continue;
      const Vec3 c = tracer.trace(*frame, x, y, 1, counters).correction;
      ASSERT_EQ(c, Vec3(inlined.corrections[frame->index(x, y)]));
      energy += std::fabs(c.x);
    }
  }
  EXPECT_GT(energy, 1);
}

TEST(FlushToZero, ItIsOnHere) {
  volatile float smallest = std::numeric_limits<float>::min();
  EXPECT_GT(smallest / 2, 0);
  const FlushToZero flush;
  EXPECT_EQ(smallest / 2, 0);
}

TEST(FlushToZero, Hard28PathsAndCorrectionsAreTheSame) {
  const SceneMaker m = room();
  HardCase paths = HardCase::counting("path-traced pixels that differ with flush-to-zero", "pixels"),
           corrections = HardCase::counting("corrections that differ with flush-to-zero", "pixels");
  const core::IlluminationMaps maps = constantMaps(kHalfOne);
  World plain(m.scene, planOf());
  plain.setMaps(&maps);
  const auto frame = frameOf(plain, cameraAt({0, 0, 2.9f}, Vec3(0)), 60, 50);
  const PathResult expected = pathsOnThreads(plain, 0);
  const TraceAllResult traced = traceAll(CorrectiveTracer(plain, {}), *frame, 0, {});
  const FlushToZero flush;
  World flushed(m.scene, planOf());  // Embree's tree is built with it, too
  flushed.setMaps(&maps);
  for (int threads : {0, 2}) {
    EXPECT_TRUE(paths.within(
        differing(pathsOnThreads(flushed, threads).radiance.pixels(), expected.radiance.pixels()), 0));
    const TraceAllResult again = traceAll(CorrectiveTracer(flushed, {}), *frame, threads, {});
    EXPECT_TRUE(corrections.within(differing(again.corrections, traced.corrections), 0));
  }
}

}  // namespace
}  // namespace saccade::raytrace
