#include "bench/paper/untraced_walk.h"

#include <algorithm>
#include <deque>

#include "bench/harness/trials.h"

namespace saccade::bench {
namespace {

constexpr app::ImageSize kSize{512, 512};
constexpr int kMinSamples = 10;  // N_min
constexpr double kFrameSeconds = 1.0 / 25;
constexpr int kPlaces = 6;
constexpr int kFrames = 8;         ///< a place
constexpr int kFramesBefore = 35;  ///< more than MAX_AGE
constexpr std::uint64_t kSamplesPerFrame = 12000;
constexpr std::size_t kCacheBytes = std::size_t{64} << 20;

}  // namespace

FrozenCache::FrozenCache(const render::SampleCache& cache, std::size_t samples)
    : cameraAge_(cache.cameraAge()) {
  cache.forEach([&](const core::Sample& sample, std::uint64_t age) {
    if (ages_.empty() || ages_.back().age != age) ages_.push_back({age, {}});
    ages_.back().batch.samples.push_back(sample);
    ++size_;
  });
  dropOldest(size_ - std::min(size_, samples));
}

void FrozenCache::dropOldest(std::size_t excess) {
  size_ -= excess;
  for (Age& a : ages_) {
    const std::size_t n = std::min(excess, a.batch.samples.size());
    a.batch.samples.erase(a.batch.samples.begin(), a.batch.samples.begin() + static_cast<std::ptrdiff_t>(n));
    excess -= n;
  }
}

FrozenCache FrozenCache::youngest(std::size_t samples) const {
  FrozenCache part = *this;
  part.dropOldest(size_ - std::min(size_, samples));
  return part;
}

void FrozenCache::thaw(const core::View& view, render::SampleCache& cache) const {
  while (cache.cameraAge() < cameraAge_) cache.age(view, {});
  for (const Age& a : ages_) cache.add(a.batch, a.age);
}

UntracedWalk::UntracedWalk(const Stage& stage, const app::CameraPath& path)
    : stage_(stage), picture_(*stage.gl->renderer, {.nMin = kMinSamples}) {
  for (int place = 0; place < kPlaces; ++place) {
    const double seconds = path.lengthSeconds() * (2 * place + 1) / (2 * kPlaces);
    app::FrameLoop loop(*stage.workspace, *stage.gl->renderer, {.threads = 0, .seed = stage.seed});
    for (int i = kFramesBefore; i >= 0; --i) {
      loop.step(path.at(std::max(0.0, seconds - i * kFrameSeconds)), kSize,
                app::FrameBudget::firstSamples(kSamplesPerFrame));
    }
    places_.push_back({FrozenCache(loop.cache(), kSamples), {}});
    for (int i = 1; i <= kFrames; ++i)
      places_.back().views.push_back(stage.view(path.at(seconds + i * kFrameSeconds), kSize));
  }
}

std::size_t UntracedWalk::cachedSamples() const {
  std::size_t samples = 0;
  for (const Place& place : places_) samples += place.cache.size();
  return samples;
}

/// A place's caches are made before its first frame: filling them in between would leave the processor's
/// caches to samples and not to what the last frame used.
UntracedFrame UntracedWalk::medians() {
  std::vector<UntracedFrame> frames;
  for (const Place& place : places_) {
    std::deque<render::SampleCache> caches;
    for (const core::View& view : place.views) place.cache.thaw(view, caches.emplace_back(kCacheBytes));
    for (std::size_t i = 0; i < caches.size(); ++i)
      frames.push_back(picture_.draw(place.views[i], caches[i]));
  }
  const auto median = [&](double UntracedFrame::*stage) {
    std::vector<double> values;
    for (const UntracedFrame& f : frames) values.push_back(f.*stage);
    return spread(values).median;
  };
  return {median(&UntracedFrame::age),     median(&UntracedFrame::draw),    median(&UntracedFrame::read),
          median(&UntracedFrame::measure), median(&UntracedFrame::warp),    median(&UntracedFrame::composite),
          median(&UntracedFrame::total),   median(&UntracedFrame::splatted)};
}

double UntracedWalk::bareDraw() {
  std::vector<double> ms;
  for (const Place& place : places_) {
    for (const core::View& view : place.views) {
      stage_.gl->renderer->render(view, 1, kMinSamples);
      ms.push_back(1000 * stage_.gl->renderer->lastDraw().drawSeconds);
    }
  }
  return spread(ms).median;
}

}  // namespace saccade::bench
