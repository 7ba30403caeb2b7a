#include "app/viewer/window_settings.h"

namespace saccade::app {

namespace {

template <class To, class From>
void apply(To& to, const std::optional<From>& kept, bool given = false) {
  if (kept && !given) to = static_cast<To>(*kept);
}

template <class Kept, class T>
void keep(std::optional<Kept>& kept, const T& start, const T& end) {
  if (end != start) kept = end;
}

}  // namespace

WalkOptions withKept(WalkOptions o, const KeptSettings& kept) {
  apply(o.corrective.attention.attention, kept.attention, o.given.attention);
  apply(o.corrective.delta, kept.delta, o.given.delta);
  apply(o.corrective.approximation, kept.approximation, o.given.approximation);
  apply(o.fps, kept.fps, o.given.fps);
  apply(o.run.exposureEv, kept.exposureEv, o.given.exposure);
  return o;
}

PanelState firstPanel(const WalkOptions& options, const KeptSettings& kept) {
  PanelState panel;
  panel.attention = static_cast<float>(options.corrective.attention.attention);
  panel.fps = static_cast<float>(options.fps);
  panel.exposureEv = options.run.exposureEv;
  panel.delta = options.corrective.delta;
  panel.approximation = options.corrective.approximation;
  if (!options.overlay.empty()) panel.overlay = aovByName(options.overlay);
  apply(panel.visible, kept.panelVisible);
  apply(panel.errorPlotOpen, kept.errorPlotOpen);
  apply(panel.corrections, kept.corrections);
  apply(panel.reuse, kept.reuse);
  return panel;
}

void keepChanges(KeptSettings& kept, const WindowLook& start, const WindowLook& end) {
  keep(kept.attention, start.panel.attention, end.panel.attention);
  keep(kept.fps, start.panel.fps, end.panel.fps);
  keep(kept.exposureEv, start.panel.exposureEv, end.panel.exposureEv);
  keep(kept.delta, start.panel.delta, end.panel.delta);
  keep(kept.panelVisible, start.panel.visible, end.panel.visible);
  keep(kept.errorPlotOpen, start.panel.errorPlotOpen, end.panel.errorPlotOpen);
  keep(kept.corrections, start.panel.corrections, end.panel.corrections);
  keep(kept.reuse, start.panel.reuse, end.panel.reuse);
  keep(kept.approximation, start.panel.approximation, end.panel.approximation);
  keep(kept.fullscreen, start.fullscreen, end.fullscreen);
  if (end.size.width != start.size.width || end.size.height != start.size.height) kept.window = end.size;
}

}  // namespace saccade::app
