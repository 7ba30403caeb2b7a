#include "bench/cache/cache.h"

#include <memory>

#include "app/session/camera_path.h"
#include "bench/cache/bare_warp.h"
#include "bench/harness/method.h"
#include "bench/harness/trials.h"
#include "bench/harness/untraced_frame.h"
#include "bench/paper/untraced_walk.h"

namespace saccade::bench {
namespace {

/// A walk at 512x512 never holds a million: of two samples on one pixel one is dropped.
constexpr app::ImageSize kSize{1280, 1280};
constexpr std::size_t kMost = 1'000'000;
constexpr std::size_t kCacheMb = 1024;
constexpr std::uint64_t kSamplesPerFrame = 90000;
constexpr double kFrameSeconds = 0.2;
constexpr int kFrames = 4;  ///< measured after the walk, for each repeat
/// Nothing leaves by age or angle, or no walk of this picture would hold so many.
constexpr render::AgingOptions kKeepAll{.nMin = 10, .delta = 2, .maxAge = 1'000'000};

/// A walk until the cache holds kMost samples.
struct LongWalk {
  LongWalk(Session& session, const Stage& stage, const app::CameraPath& path) {
    app::FrameLoopOptions options{.threads = 0, .seed = stage.seed};
    options.corrective.delta = kKeepAll.delta;
    options.corrective.maxAge = kKeepAll.maxAge;
    options.corrective.cacheMb = kCacheMb;
    app::FrameLoop loop(*stage.workspace, *stage.gl->renderer, options);
    double seconds = 0;
    for (; loop.cache().size() < kMost; seconds += kFrameSeconds) {
      session.checkStop();
      if (seconds > path.lengthSeconds())
        throw core::Error("the path ends with " + std::to_string(loop.cache().size()) +
                          " of a million samples");
      loop.step(path.at(seconds), kSize, app::FrameBudget::firstSamples(kSamplesPerFrame));
    }
    cameraAge = loop.cache().cameraAge();
    ages = std::make_unique<FrozenCache>(loop.cache(), kMost);
    for (int i = 0; i < kFrames; ++i)
      views.push_back(stage.view(path.at(seconds + i * kFrameSeconds), kSize));
  }
  std::unique_ptr<FrozenCache> ages;
  std::vector<core::View> views;
  std::uint64_t cameraAge = 0;
};

/// One number of samples, repeat by repeat.
struct SizedCache {
  std::size_t samples;
  std::vector<double> age, warp, bare;
  double splatted = 0;
};

void measureOnce(const Stage& stage, const LongWalk& walk, SizedCache& point, bool keep) {
  UntracedPicture picture(*stage.gl->renderer, kKeepAll);
  std::vector<double> age, warp, bare;
  for (const core::View& view : walk.views) {
    render::SampleCache cache(kCacheMb << 20);
    walk.ages->youngest(point.samples).thaw(view, cache);
    BareWarp least;
    cache.forEach([&](const core::Sample& s, std::uint64_t) { least.add(s); });
    const UntracedFrame frame = picture.draw(view, cache);
    age.push_back(frame.age);
    warp.push_back(frame.warp);
    point.splatted = frame.splatted;
    const core::FramePtr target = stage.gl->renderer->render(view, walk.cameraAge + 1, kKeepAll.nMin);
    bare.push_back(1000 * timed([&] { least.warp(*target); }));
  }
  if (!keep) return;
  point.age.push_back(spread(age).median);
  point.warp.push_back(spread(warp).median);
  point.bare.push_back(spread(bare).median);
}

Value perThousand(const std::vector<double>& ms, std::size_t samples) {
  Value value = Value::milliseconds(ms).times(1e6 / static_cast<double>(samples));
  value.unit = "us/1,000";
  return value;
}

Record recordOf(const SizedCache& p) {
  Record record;
  record.key = "cache/" + std::to_string(p.samples);
  record.labels = {{"scene", "gallery"}};
  record.at = {{"samples", static_cast<double>(p.samples)}};
  record.values = {{"aging", Value::milliseconds(p.age)},
                   {"warp_splat", Value::milliseconds(p.warp)},
                   {"bare_warp", Value::milliseconds(p.bare)},
                   {"aging_per_1000", perThousand(p.age, p.samples)},
                   {"warp_splat_per_1000", perThousand(p.warp, p.samples)},
                   {"bare_warp_per_1000", perThousand(p.bare, p.samples)},
                   {"warp_over_bare", Value::ratio(ratios(p.warp, p.bare), Better::lower)},
                   {"splatted", Value::count(p.splatted)}};
  return record;
}

}  // namespace

void measureCache(Session& session) {
  const auto stage = openStage(bundledScene("gallery"), "preview", session.options().seed, session.stop());
  const app::CameraPath path = app::CameraPath::read(bundledPath("gallery"));
  const Pinned main(mainCores());
  session.say("cache: walking the gallery until a million samples are cached");
  const LongWalk walk(session, *stage, path);
  std::vector<SizedCache> points;
  for (const std::size_t n : {50'000, 100'000, 200'000, 400'000, 700'000, 1'000'000}) points.push_back({n});
  session.say("cache: aging and warping, 50,000 to 1,000,000 samples");
  const LoadWatch watch;
  alternate(static_cast<int>(points.size()), kRepeats, session.stop(), [&](int variant, int round) {
    measureOnce(*stage, walk, points[static_cast<std::size_t>(variant)], round >= 0);
  });
  for (const SizedCache& point : points) session.add(recordOf(point), &watch);
}

}  // namespace saccade::bench
