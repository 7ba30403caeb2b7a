#include "bench/attention/attention.h"

#include <cmath>
#include <ctime>
#include <functional>
#include <memory>

#include "attention/plain_saliency.h"
#include "attention/saliency.h"
#include "bench/attention/scores.h"
#include "bench/harness/method.h"
#include "core/image_io.h"

namespace saccade::bench {
namespace {

using attention::Normalisation;
using attention::SaliencyModel;
using attention::SaliencyOptions;

constexpr int kSide = 512;
constexpr int kLeastPlain = 256;  ///< the plain version wants nine levels

/// A rendered scene, converged.
core::ImageRgba8 renderedScene(Session& session) {
  const auto stage = openStage(bundledScene("gallery"), "preview", session.options().seed, session.stop());
  const Pinned main(mainCores());
  const auto loop = pinnedLoop(*stage, {.threads = stage->tracers, .seed = stage->seed});
  loop->step(stage->workspace->scene.cameras[0], {kSide, kSide}, app::FrameBudget::untilConverged(),
             session.stop());
  return core::toDisplay(loop->linear(), 0);
}

/// The picture side by side with itself, or its corner.
core::ImageRgba8 tiled(const core::ImageRgba8& picture, int side) {
  core::ImageRgba8 out(side, side);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) out.at(x, y) = picture.at(x % picture.width(), y % picture.height());
  }
  return out;
}

struct Variant {
  std::string name;
  std::function<void(const core::ImageRgba8&)> compute;
};

Variant modelVariant(const std::string& name, const SaliencyOptions& options) {
  const auto model = std::make_shared<SaliencyModel>(options);
  return {name, [model](const core::ImageRgba8& picture) { model->compute(picture); }};
}

Variant plainVariant() {
  return {"plain OpenCV", [](const core::ImageRgba8& picture) { attention::plainSaliency(picture); }};
}

/// Of this thread, which computes every map alone: what others take of the core does not count.
double processorSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Milliseconds of processor time of a map by variant and repeat. A repeat lasts some tens of milliseconds.
std::vector<std::vector<double>> timesOf(const std::vector<Variant>& variants,
                                         const core::ImageRgba8& picture, const std::stop_token& stop) {
  constexpr double kPixelsPerRepeat = 4e6;
  const int calls = 1 + static_cast<int>(kPixelsPerRepeat / static_cast<double>(picture.pixels().size()));
  std::vector<std::vector<double>> times(variants.size());
  const Pinned oneCore({0});
  alternate(static_cast<int>(variants.size()), kRepeats, stop, [&](int variant, int round) {
    const double start = processorSeconds();
    for (int i = 0; i < calls; ++i) variants[variant].compute(picture);
    const double seconds = processorSeconds() - start;
    if (round >= 0) times[variant].push_back(1000 * seconds / calls);
  });
  return times;
}

void measureVariants(Session& session, const core::ImageRgba8& picture) {
  const std::vector<Variant> variants{
      modelVariant("max", {}), modelVariant("dog", {Normalisation::dog, false}),
      modelVariant("max, orientation", {Normalisation::max, true}),
      modelVariant("dog, orientation", {Normalisation::dog, true}), plainVariant()};
  const LoadWatch watch;
  const auto times = timesOf(variants, picture, session.stop());
  for (std::size_t i = 0; i < variants.size(); ++i) {
    Record record;
    record.key = "attention/cost-" + keyOf(variants[i].name);
    record.labels = {{"what", "cost"}, {"model", variants[i].name}};
    record.values = {{"ms", Value::milliseconds(times[i])},
                     {"over_plain", Value::ratio(ratios(times[i], times.back()), Better::lower)},
                     {"over_max", Value::ratio(ratios(times[i], times.front()), Better::lower)}};
    session.add(record, &watch);
  }
}

void measureSizes(Session& session, const core::ImageRgba8& picture) {
  for (const int side : {128, 256, 512, 1024, 2048, 4096}) {
    session.checkStop();
    const core::ImageRgba8 sized = tiled(picture, side);
    std::vector<Variant> variants{modelVariant("max", {})};
    if (side >= kLeastPlain) variants.push_back(plainVariant());
    const LoadWatch watch;
    const auto times = timesOf(variants, sized, session.stop());
    Record record;
    record.key = "attention/size@" + std::to_string(side);
    record.labels = {{"what", "size"}};
    record.at = {{"side", side}};
    record.values = {{"ms", Value::milliseconds(times[0])}};
    Value perPixel = record.values.at("ms").times(1e6 / static_cast<double>(sized.pixels().size()));
    perPixel.unit = "ns";
    record.values["ns_a_pixel"] = perPixel;
    if (times.size() > 1) {
      record.values["plain"] = Value::milliseconds(times[1]);
      record.values["over_plain"] = Value::ratio(ratios(times[0], times[1]), Better::lower);
    }
    session.add(record, &watch);
  }
}

/// The picture, its map, and the map with orientation, side by side.
void drawMaps(Session& session, const core::ImageRgba8& picture) {
  core::ImageRgba8 strip(3 * kSide, kSide);
  const auto put = [&](int place, const auto& at) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) strip.at(place * kSide + x, y) = at(x, y);
    }
  };
  put(0, [&](int x, int y) { return picture.at(x, y); });
  int place = 1;
  for (const bool orientation : {false, true}) {
    const core::ImageGray map = attention::saliencyOf(picture, {Normalisation::max, orientation});
    put(place++, [&](int x, int y) {
      const auto code = static_cast<std::uint8_t>(std::lround(255 * map.at(x, y)));
      return core::Rgba8{code, code, code, 255};
    });
  }
  Record record;
  record.key = "attention/maps";
  record.labels = {{"what", "picture, map, map with orientation"}};
  record.files = {{"picture", session.picture("attention-maps", strip)}};
  session.add(record, nullptr);
}

}  // namespace

void measureAttention(Session& session) {
  const core::ImageRgba8 picture = renderedScene(session);
  drawMaps(session, picture);
  session.say("attention: what the model costs");
  measureVariants(session, picture);
  measureSizes(session, picture);
  scoreModels(session);
}

}  // namespace saccade::bench
