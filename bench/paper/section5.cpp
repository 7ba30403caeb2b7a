#include "bench/paper/section5.h"

#include <optional>

#include "app/session/camera_path.h"
#include "bench/harness/method.h"
#include "bench/paper/lattice.h"
#include "bench/paper/untraced_walk.h"

namespace saccade::bench {
namespace {

constexpr app::ImageSize kSize{512, 512};
constexpr double kFrameSeconds = 0.05;  ///< of the paper's count of samples
constexpr double kSlowFrameMs = 1000.0 / 8;

struct Range {
  double low, high;
};

/// The paper's range where it has one.
Record rowOf(const std::string& key, const std::string& what, const Value& ours, std::optional<Range> paper) {
  Record record;
  record.key = "paper/" + key;
  record.labels = {{"what", what}};
  record.values = {{"ours", ours}};
  if (!paper) return record;
  const double middle = (paper->low + paper->high) / 2;
  record.values["paper"] = {middle, paper->low, paper->high, 1, ours.unit, ours.kind, Better::neither};
  // Of two machines: no Kind::ratio, which another run would have to repeat.
  Value ratio = ours.times(1 / middle);
  ratio.unit.clear();
  record.values["ratio"] = ratio;
  return record;
}

Value rate(const std::vector<double>& repeats, const char* unit) {
  Value value = Value::rate(repeats);
  value.unit = unit;
  return value;
}

/// The rows without rays: each repeat is the median of the frames of one pass along the path.
void frameRows(Session& session, const Stage& stage, const app::CameraPath& path) {
  session.say("paper: the frame without correction, 50,000 cached samples");
  const Pinned main(mainCores());
  UntracedWalk walk(stage, path);
  const LoadWatch watch;
  std::vector<double> age, draw, warp, read, rate8, left;
  for (int round = 0; round <= kRepeats; ++round) {
    session.checkStop();
    const UntracedFrame frame = walk.medians();
    if (round == 0) continue;  // warm-up
    age.push_back(frame.age);
    draw.push_back(frame.draw);
    warp.push_back(frame.warp);
    read.push_back(frame.read);
    rate8.push_back(1000 / frame.total);
    left.push_back(kSlowFrameMs - frame.total);
  }
  const auto add = [&](const char* key, const char* what, const Value& ours, Range paper) {
    session.add(rowOf(key, what, ours, paper), &watch);
  };
  add("aging", "aging of 50,000 samples", Value::milliseconds(age), {5, 10});
  add("rendering", "OpenGL rendering, about 90,000 triangles", Value::milliseconds(draw), {40, 50});
  add("warping", "warping and splatting 50,000 samples", Value::milliseconds(warp), {20, 30});
  add("reading", "reading frame buffer and mask", Value::milliseconds(read), {20, 20});
  add("frame-rate", "frames a second without correction", rate(rate8, "1/s"), {10, 14});
  Value forCorrection = Value::milliseconds(left);
  forCorrection.better = Better::higher;
  add("left-at-8fps", "left for correction at 8 frames a second", forCorrection, {25, 50});
}

void attentionRow(Session& session, const Stage& stage, const app::CameraPath& path) {
  session.say("paper: attention model");
  const Pinned main(mainCores());
  app::FrameLoop loop(*stage.workspace, *stage.gl->renderer, {.threads = 0, .seed = stage.seed});
  const LoadWatch watch;
  std::vector<double> ms;
  for (int i = 0; i <= kRepeats; ++i) {
    loop.step(path.at(path.lengthSeconds() * i / kRepeats), kSize, app::FrameBudget::firstSamples(0));
    if (i > 0) ms.push_back(loop.analyzer().latest()->milliseconds);
  }
  session.add(rowOf("attention", "attention model, one frame (the paper: below)", Value::milliseconds(ms),
                    Range{300, 300}),
              &watch);
}

/// The camera moves, so that every frame starts anew; drawing and warping happen outside the 50 ms, as in the
/// paper's figure.
std::vector<double> samplesInFrames(const Stage& stage, const app::CameraPath& path, int tracers,
                                    int frames) {
  const auto loop = pinnedLoop(stage, {.threads = tracers, .seed = stage.seed, .asynchronousAnalysis = true});
  std::vector<double> samples;
  for (int i = 0; i < frames; ++i) {
    const core::Camera camera = path.at(path.lengthSeconds() * i / frames);
    loop->step(camera, kSize, app::FrameBudget::firstSamples(0));  // draw, age and warp; the tracers start
    const std::uint64_t before = loop->stats().samplesTraced;
    loop->step(camera, kSize, app::FrameBudget::untilDeadline(std::chrono::duration<double>(kFrameSeconds)));
    if (i > 0) samples.push_back(static_cast<double>(loop->stats().samplesTraced - before));
  }
  return samples;
}

void tracerRows(Session& session, const Stage& stage, const app::CameraPath& path) {
  constexpr int kFrames = 21;  // the first is the warm-up
  const Pinned main(mainCores());
  const std::pair<int, std::optional<Range>> rows[] = {
      {1, std::nullopt}, {2, Range{500, 800}}, {4, Range{1000, 1500}}, {6, Range{1500, 2500}}};
  for (const auto& [tracers, paper] : rows) {
    session.checkStop();
    const std::string n = std::to_string(tracers);
    session.say("paper: samples in 50 ms with " + n + " tracers");
    const LoadWatch watch;
    const Value samples = rate(samplesInFrames(stage, path, tracers, kFrames), "1/50 ms");
    Record record =
        rowOf("tracers-" + n,
              "samples that reach the frame in 50 ms, " + n + (tracers > 1 ? " tracers" : " tracer"), samples,
              paper);
    record.labels["tracers"] = n;
    session.add(std::move(record), &watch);
  }
}

void latticeRow(Session& session) {
  session.say("paper: lattice, iterative against recursive");
  const core::PixelBox box{0, 0, kSize.width, kSize.height};
  const auto points = static_cast<double>(box.area());
  const LoadWatch watch;
  std::vector<double> fast, slow;
  std::uint64_t kept = 0;  // keeps the work from vanishing
  alternate(2, kRepeats, session.stop(), [&](int variant, int round) {
    const double seconds = variant == 0 ? timed([&] { kept += latticeIterative(box).sum; })
                                        : timed([&] { kept += latticeRecursive(box).sum; });
    if (round >= 0) (variant == 0 ? fast : slow).push_back(1e9 * seconds / points);
  });
  if (kept != 2 * (kRepeats + 1) * latticeIterative(box).sum)
    throw core::Error("the two methods of walking the lattice disagree");
  Record record = rowOf("lattice", "lattice, recursive over iterative",
                        Value::ratio(ratios(slow, fast), Better::higher), Range{8, 8});
  record.values["iterative"] = Value::milliseconds(fast);
  record.values["recursive"] = Value::milliseconds(slow);
  record.values["iterative"].unit = record.values["recursive"].unit = "ns";
  session.add(std::move(record), &watch);
}

}  // namespace

void measureSection5(Session& session) {
  const auto stage = openStage(bundledScene("gallery"), "preview", session.options().seed, session.stop());
  const app::CameraPath path = app::CameraPath::read(bundledPath("gallery"));
  frameRows(session, *stage, path);
  attentionRow(session, *stage, path);
  tracerRows(session, *stage, path);
  latticeRow(session);
}

}  // namespace saccade::bench
