#include "bench/growth/frame.h"

#include <algorithm>
#include <functional>
#include <random>

#include "app/session/headless.h"
#include "app/session/stats.h"
#include "bench/harness/trials.h"
#include "bench/harness/untraced_frame.h"
#include "core/error.h"
#include "core/scene/plan.h"
#include "render/splat/sample_cache.h"

namespace saccade::bench {
namespace {

using core::Vec2;
using core::Vec3;

constexpr int kWarmUpFrames = 2;
constexpr int kFrames = 9;
/// Nothing is to leave the cache by age or by angle while its size is measured.
constexpr render::AgingOptions kKeepAll{.nMin = 10, .delta = 2, .maxAge = 1'000'000};

/// Every fifth sample is of the next coarser level, as in the lattice.
std::uint8_t levelFor(std::mt19937& engine) {
  int level = core::Lattice::kMaxLevel;
  while (level > 1 && engine() % 5 == 0) --level;
  return static_cast<std::uint8_t>(level);
}

/// Samples anywhere on the mirrors that a frame shows.
core::SampleBatch samplesOn(const core::FrameSnapshot& frame, const core::Scene& scene, std::size_t count) {
  if (frame.nonDiffusePixels == 0) throw core::Error("growth: no mirror is in view");
  std::vector<const core::Object*> objectOf(scene.idCount() + 1);
  for (const core::Object& o : scene.objects) objectOf[o.id] = &o;
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> x(0, static_cast<float>(frame.view.width())),
      y(0, static_cast<float>(frame.view.height()));
  core::SampleBatch batch;
  while (batch.samples.size() < count) {
    const Vec2 pixel(x(engine), y(engine));
    core::Sample s;
    s.x = std::min(static_cast<int>(pixel.x), frame.view.width() - 1);
    s.y = std::min(static_cast<int>(pixel.y), frame.view.height() - 1);
    s.id = frame.idAt(s.x, s.y);
    if (s.id == 0) continue;
    const float depth = frame.depth[frame.index(s.x, s.y)];
    s.position = frame.view.unproject(pixel, depth);
    s.normal = glm::normalize(s.position - objectOf[s.id]->bounds.center());
    s.cosView = glm::dot(s.normal, glm::normalize(frame.view.camera().eye - s.position));
    s.viewDepth = frame.view.viewDepth(depth);
    s.level = levelFor(engine);
    s.correction = Vec3(0.1f);
    batch.samples.push_back(s);
  }
  return batch;
}

/// A renderer of its own, and a cache that is filled once.
class Frames {
 public:
  Frames(const core::Scene& scene, const FrameSize& size)
      : scene_(scene),
        size_(size),
        context_(makeContext()),
        renderer_(*context_, scene),
        cache_(2 * size.samples * sizeof(core::Sample) + (1u << 20)),
        picture_(renderer_, kKeepAll) {
    renderer_.setMaps(nullptr);
    fill();
  }

  UntracedFrame next() { return picture_.draw(view(++number_), cache_); }

 private:
  static std::unique_ptr<render::GlContext> makeContext() {
    render::setSoftwareRasterThreads(app::rasterThreads(1));
    return render::makeHeadlessContext(render::ContextKind::osmesa);
  }

  void fill() {
    const core::View first = view(0);
    cache_.age(first, kKeepAll);
    const auto frame = renderer_.render(first, cache_.cameraAge(), kKeepAll.nMin);
    cache_.add(samplesOn(*frame, scene_, size_.samples), cache_.cameraAge());
  }

  /// To and fro sideways, by a hundredth of the distance to the balls.
  core::View view(int number) const {
    core::Camera camera = scene_.cameras[0];
    const float step = 0.01f * glm::length(camera.at - camera.eye);
    const Vec3 aside(step * std::sin(static_cast<float>(number)), 0, 0);
    camera.eye += aside;
    camera.at += aside;
    return {camera, size_.side, size_.side, scene_.bounds};
  }

  const core::Scene& scene_;
  const FrameSize& size_;
  int number_ = 0;
  std::unique_ptr<render::GlContext> context_;
  render::BaseRenderer renderer_;
  render::SampleCache cache_;
  UntracedPicture picture_;
};

/// NAME, NAME_min and NAME_max of one stage.
void addStage(Figures& figures, const std::string& name, const std::vector<UntracedFrame>& frames,
              const std::function<double(const UntracedFrame&)>& ms) {
  std::vector<double> values(frames.size());
  std::transform(frames.begin(), frames.end(), values.begin(), ms);
  const Spread s = spread(values);
  figures[name] = s.median;
  figures[name + "_min"] = s.min;
  figures[name + "_max"] = s.max;
}

}  // namespace

Arguments FrameSize::arguments() const {
  return {std::to_string(scene.triangles), std::to_string(scene.balls), scene.instanced ? "1" : "0",
          std::to_string(samples), std::to_string(side)};
}

FrameSize FrameSize::of(const Arguments& a) {
  if (a.size() != 5) throw core::UsageError("frame: TRIANGLES BALLS INSTANCED SAMPLES SIDE");
  FrameSize size;
  size.scene = {std::stoul(a[0]), std::stoul(a[1]), a[2] == "1"};
  size.samples = std::stoul(a[3]);
  size.side = std::stoi(a[4]);
  return size;
}

Figures frameWithoutTracing(const Arguments& arguments, const std::stop_token& stop) {
  const FrameSize size = FrameSize::of(arguments);
  const Clock::time_point start = Clock::now();
  const core::Scene scene = makeBallScene(size.scene);
  const raytrace::World world(scene, core::makePlan(scene));
  Figures f = {{"build", secondsSince(start)}, {"scene_bytes", static_cast<double>(app::peakBytes())}};
  Frames frames(scene, size);
  std::vector<UntracedFrame> drawn;
  for (int i = -kWarmUpFrames; i < kFrames; ++i) {
    if (stop.stop_requested()) throw core::Error("stopped on request");
    const UntracedFrame frame = frames.next();
    if (i >= 0) drawn.push_back(frame);
  }
  addStage(f, "age", drawn, [](const UntracedFrame& t) { return t.age; });
  addStage(f, "draw", drawn, [](const UntracedFrame& t) { return t.draw + t.read + t.measure; });
  addStage(f, "warp", drawn, [](const UntracedFrame& t) { return t.warp; });
  addStage(f, "composite", drawn, [](const UntracedFrame& t) { return t.composite; });
  addStage(f, "frame", drawn, [](const UntracedFrame& t) { return t.total; });
  f["frames"] = kFrames;
  f["bytes"] = static_cast<double>(app::peakBytes());
  f["triangles"] = static_cast<double>(scene.triangleCount());
  f["stored_triangles"] = static_cast<double>(scene.storedTriangleCount());
  f["objects"] = static_cast<double>(scene.objects.size());
  f["samples"] = drawn.back().splatted;
  f["pixels"] = static_cast<double>(size.side) * size.side;
  return f;
}

}  // namespace saccade::bench
