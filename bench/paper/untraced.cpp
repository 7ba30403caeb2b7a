#include "bench/paper/untraced.h"

#include "bench/paper/untraced_walk.h"

namespace saccade::bench {
namespace {

Value stage(const std::vector<UntracedFrame>& passes, double UntracedFrame::*which) {
  std::vector<double> ms;
  for (const UntracedFrame& pass : passes) ms.push_back(pass.*which);
  return Value::milliseconds(ms);
}

}  // namespace

void measureUntraced(Session& session) {
  session.say("untraced: walking the gallery until 50,000 samples are cached");
  const auto opened = openStage(bundledScene("gallery"), "preview", session.options().seed, session.stop());
  const app::CameraPath path = app::CameraPath::read(bundledPath("gallery"));
  const Pinned main(mainCores());
  UntracedWalk walk(*opened, path);
  session.say("untraced: the frame without tracing beside its bare draw");
  const LoadWatch watch;
  std::vector<double> bare, total;
  std::vector<UntracedFrame> passes;
  alternate(2, kRepeats, session.stop(), [&](int variant, int round) {
    if (variant == 0) {
      const double ms = walk.bareDraw();
      if (round >= 0) bare.push_back(ms);
    } else {
      const UntracedFrame pass = walk.medians();
      if (round < 0) return;
      passes.push_back(pass);
      total.push_back(pass.total);
    }
  });
  Record record;
  record.key = "untraced/gallery";
  record.labels = {{"scene", "gallery"}};
  record.values = {{"bare_draw", Value::milliseconds(bare)},
                   {"frame", Value::milliseconds(total)},
                   {"ratio", Value::ratio(ratios(total, bare), Better::lower)},
                   {"aging", stage(passes, &UntracedFrame::age)},
                   {"draw", stage(passes, &UntracedFrame::draw)},
                   {"read", stage(passes, &UntracedFrame::read)},
                   {"measure", stage(passes, &UntracedFrame::measure)},
                   {"warp_splat", stage(passes, &UntracedFrame::warp)},
                   {"composite", stage(passes, &UntracedFrame::composite)},
                   {"cached", Value::count(static_cast<double>(walk.cachedSamples()) / walk.places())},
                   {"splatted", Value::count(passes.front().splatted)}};
  session.add(std::move(record), &watch);
}

}  // namespace saccade::bench
