#include "bench/validity/judged_samples.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>

#include "bench/validity/walk_error.h"
#include "core/image_io.h"

namespace saccade::bench {
namespace {

constexpr float kAnyChange = 1e6f;
constexpr int kFrames = 30;  ///< as many as MAX_AGE lets live
constexpr std::size_t kBytes = std::size_t{64} << 20;
constexpr float kMirrorAlpha = 0.01f;
constexpr int kNoiselessEach = 4;  ///< one sample in so many

/// A pixel is traced at most once for a camera.
std::uint64_t keyOf(const core::Sample& s, std::uint64_t age) {
  return age << 32 | static_cast<std::uint64_t>(s.y) << 16 | static_cast<std::uint64_t>(s.x);
}

float displayedDifference(const core::Vec3& base, const core::Vec3& a, const core::Vec3& b) {
  float largest = 0;
  for (int c = 0; c < 3; ++c)
    largest = std::max(largest, std::abs(core::encodeSrgb(std::clamp(base[c] + a[c], 0.0f, 1.0f)) -
                                         core::encodeSrgb(std::clamp(base[c] + b[c], 0.0f, 1.0f))));
  return largest;
}

}  // namespace

std::string nameOf(ObjectKind kind) {
  return kind == ObjectKind::mirror ? "mirror" : kind == ObjectKind::glossy ? "glossy" : "glass";
}

ObjectKind kindOf(const raytrace::World& world, std::uint32_t id) {
  const raytrace::CompiledMaterial& m = world.materialOf(world.objectOfId(id));
  if (m.transmission > 0) return ObjectKind::glass;
  const bool smooth = !m.extension && m.roughness * m.roughness < kMirrorAlpha;
  return smooth ? ObjectKind::mirror : ObjectKind::glossy;
}

JudgedPlace::JudgedPlace(const Stage& stage, const app::CameraPath& path, double seconds)
    : view_(stage.view(path.at(seconds), kValiditySize)) {
  app::FrameLoopOptions options{.threads = 0, .seed = stage.seed};
  // Nothing ages but beyond MAX_AGE.
  options.corrective.aging = app::AgingTest::change;
  options.corrective.delta = kAnyChange;
  app::FrameLoop loop(*stage.workspace, *stage.gl->renderer, options);
  std::map<std::uint64_t, core::Vec3> eyes;  // by camera age
  for (int i = kFrames; i >= 1; --i) {
    const core::Camera camera = path.at(std::max(0.0, seconds - i * kValidityFrameSeconds));
    loop.step(camera, kValiditySize, app::FrameBudget::firstSamples(kValiditySamples));
    eyes[loop.cache().cameraAge()] = camera.eye;
  }
  cache_ = std::make_unique<FrozenCache>(loop.cache(), std::numeric_limits<std::size_t>::max());

  const raytrace::World& world = *stage.workspace->world;
  const raytrace::CorrectiveTracer fine(world, {.seed = stage.seed, .samplesPerPixel = kSubSamples});
  raytrace::RayCounters counters;
  const core::Vec3 eye = view_.camera().eye;
  int serial = 0;
  loop.cache().forEach([&](const core::Sample& s, std::uint64_t age) {
    if (s.fromDepth) return;  // of no ray that could be aimed again
    const auto now = loop.tracer().revisit(s, eye, counters);
    if (!now) return;
    JudgedSample judged{keyOf(s, age), kindOf(world, s.id), 0, -1, 0};
    judged.error = displayedDifference(now->shown, s.correction, now->correction);
    if (serial++ % kNoiselessEach == 0) {
      const auto then = fine.revisit(s, eyes[age], counters), later = fine.revisit(s, eye, counters);
      if (then && later)
        judged.noiseless = displayedDifference(later->shown, then->correction, later->correction);
    }
    judged.expected = s.changeRate * glm::length(glm::normalize(eye - s.position) - s.toEye);
    samples_.push_back(judged);
  });
}

JudgedPlace::Aged JudgedPlace::aged(const render::AgingOptions& options) const {
  using Clock = std::chrono::steady_clock;
  render::SampleCache cache(kBytes);
  cache_->thaw(view_, cache);
  Aged aged;
  const Clock::time_point start = Clock::now();
  cache.age(view_, options);
  aged.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  cache.forEach([&](const core::Sample& s, std::uint64_t age) { aged.kept.insert(keyOf(s, age)); });
  return aged;
}

}  // namespace saccade::bench
