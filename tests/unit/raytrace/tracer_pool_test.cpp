// The reference over all pixels, and the pool of tracers against it.
#include "raytrace/tracer_pool.h"

#include <gtest/gtest.h>

#include <map>

#include "core/error.h"
#include "raytrace/corrective_tracer.h"
#include "raytrace/reference.h"
#include "tests/unit/raytrace/corrective_scenes.h"

namespace saccade::raytrace {
namespace {

using namespace tests;

/// Corrections by pixel.
using ByPixel = std::map<std::pair<int, int>, Vec3>;

TEST(Reference, ProgressEndsAtOneAndStopThrows) {
  const SceneMaker m = room();
  const World world(m.scene, planOf());
  const CorrectiveTracer tracer(world, {});
  const auto frame = frameOf(world, cameraAt({0, 0, 2.9f}, Vec3(0)), 20, 20);
  double last = 0;
  core::Progress progress;
  progress.report = [&](double f) {
    EXPECT_GE(f, last);
    last = f;
  };
  traceAll(tracer, *frame, 2, progress);
  EXPECT_EQ(last, 1);
  std::stop_source source;
  source.request_stop();
  progress.stop = source.get_token();
  EXPECT_THROW(traceAll(tracer, *frame, 2, progress), core::Error);
}

TEST(TracerPool, GivesWhatTheReferenceGivesOnAnyNumberOfThreads) {
  const SceneMaker m = room();
  const World world(m.scene, planOf());
  const CorrectiveTracer tracer(world, {});
  const core::FramePtr frame = frameOf(world, cameraAt({0, 0, 2.9f}, Vec3(0)), 60, 50);
  const TraceAllResult reference = traceAll(tracer, *frame, 0, {});
  for (int threads : {0, 1, 2, 8}) {
    core::RegionQueue regions(64);
    core::SampleQueue samples;
    regions.beginFrame(frame);
    TracerPool pool(tracer, regions, samples, threads);
    ByPixel found;
    while (found.size() < reference.traced) {
      if (threads == 0) {
        ASSERT_TRUE(pool.runOne());
      }
      while (const auto batch =
                 samples.popUntil(std::chrono::steady_clock::now() + std::chrono::milliseconds(5))) {
        EXPECT_EQ(batch->epoch, 7u);
        for (const core::Sample& s : batch->samples) found[{s.x, s.y}] = s.correction;
        if (threads == 0) break;
      }
      pool.check();
    }
    for (const auto& [pixel, correction] : found) {
      ASSERT_EQ(correction, Vec3(reference.corrections[frame->index(pixel.first, pixel.second)]));
    }
    EXPECT_GE(pool.samples(), reference.traced);
    EXPECT_GE(pool.rays(), pool.samples());
  }
}

TEST(TracerPool, EstimatesChangeRatesWhereTheyAreRead) {
  const SceneMaker m = room();
  const World world(m.scene, planOf());
  const CorrectiveTracer tracer(world, {});
  for (const bool rates : {false, true}) {
    core::RegionQueue regions(64);
    core::SampleQueue samples;
    regions.beginFrame(frameOf(world, cameraAt({0, 0, 2.9f}, Vec3(0)), 60, 50));
    TracerPool pool(tracer, regions, samples, 0, rates);
    ASSERT_TRUE(pool.runOne());
    const auto batch = samples.tryPop();
    ASSERT_TRUE(batch && !batch->samples.empty());
    for (const core::Sample& s : batch->samples) EXPECT_EQ(s.changeRate > 0, rates);
  }
}

TEST(TracerPool, ClosesWithAFullQueueAndWithAnEmptyOne) {
  const SceneMaker m = room();
  const World world(m.scene, planOf());
  const CorrectiveTracer tracer(world, {});
  const core::FramePtr frame = frameOf(world, cameraAt({0, 0, 2.9f}, Vec3(0)), 60, 50);
  for (bool full : {true, false}) {
    core::RegionQueue regions(16);
    core::SampleQueue samples(1);  // the second batch finds it full
    if (full) regions.beginFrame(frame);
    TracerPool pool(tracer, regions, samples, 4);
    while (full && pool.samples() < 3) std::this_thread::yield();
    pool.close();
    pool.close();
    EXPECT_FALSE(pool.runOne());
  }
}

TEST(TracerPool, AWorkersExceptionReachesTheOwner) {
  const SceneMaker m = room();
  const World world(m.scene, planOf());
  const CorrectiveTracer tracer(world, {});
  auto frame = frameOf(world, cameraAt({0, 0, 2.9f}, Vec3(0)), 20, 20);
  for (core::Vec4& p : frame->baseAndId) p.w = 9;  // no such object
  core::measureExtents(*frame, 9, 10);
  core::RegionQueue regions(16);
  core::SampleQueue samples;
  regions.beginFrame(frame);
  TracerPool pool(tracer, regions, samples, 2);
  const auto wait = [&] {
    while (true) {
      pool.check();
      std::this_thread::yield();
    }
  };
  EXPECT_THROW(wait(), core::Error);
}

}  // namespace
}  // namespace saccade::raytrace
