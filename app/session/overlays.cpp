#include "app/session/overlays.h"

#include <algorithm>

#include "core/error.h"
#include "core/metrics/colormap.h"

namespace saccade::app {

const std::vector<std::string>& aovNames() {
  static const std::vector<std::string> names{"id", "saliency", "level", "thread", "age"};
  return names;
}

Aov aovByName(const std::string& name) {
  const auto& names = aovNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<Aov>(found - names.begin());
  std::string known;
  for (const std::string& n : names) known += (known.empty() ? "" : ", ") + n;
  throw core::UsageError("no overlay '" + name + "'; there are: " + known);
}

namespace {

core::ImageGray saliencyValues(const FrameLoop& loop) {
  const auto analysis = loop.analyzer().latest();
  const core::FrameSnapshot& frame = loop.frame();
  // The analyzer may not have seen a frame of this size yet.
  if (!analysis || analysis->saliency.width() != frame.view.width() ||
      analysis->saliency.height() != frame.view.height()) {
    return {frame.view.width(), frame.view.height()};
  }
  return analysis->saliency;
}

float shownValue(Aov aov, const render::CorrectionLayer::Splat* splat) {
  switch (aov) {
    case Aov::level:
      return splat ? splat->level : 0;
    case Aov::thread:
      return splat ? static_cast<float>(splat->thread + 1) : 0;
    default:
      return splat ? splat->ageFrames : -1;
  }
}

}  // namespace

core::ImageGray aovValues(Aov aov, const FrameLoop& loop) {
  if (aov == Aov::saliency) return saliencyValues(loop);
  const core::FrameSnapshot& frame = loop.frame();
  core::ImageGray values(frame.view.width(), frame.view.height());
  for (int y = 0; y < values.height(); ++y) {
    for (int x = 0; x < values.width(); ++x) {
      values.at(x, y) =
          aov == Aov::id ? static_cast<float>(frame.idAt(x, y)) : shownValue(aov, loop.layer().shownAt(x, y));
    }
  }
  return values;
}

core::ImageRgba8 aovPicture(Aov aov, const core::ImageGray& values, int maxAge) {
  const auto color = [&](float value) -> core::Rgba8 {
    if (aov == Aov::saliency) return core::rampColor(value);
    if (aov == Aov::age) {
      return value < 0 ? core::Rgba8{} : core::rampColor(1 - value / static_cast<float>(std::max(1, maxAge)));
    }
    return value <= 0 ? core::Rgba8{} : core::paletteColor(static_cast<std::uint32_t>(value));
  };
  core::ImageRgba8 picture(values.width(), values.height());
  std::transform(values.pixels().begin(), values.pixels().end(), picture.pixels().begin(), color);
  return picture;
}

const char* aovLegend(Aov aov) {
  switch (aov) {
    case Aov::id:
      return "a colour for each non-diffuse object; black = diffuse";
    case Aov::saliency:
      return "bright = salient";
    case Aov::level:
      return "lattice level shown, 1 (coarse) to 7 (every pixel); black = not corrected";
    case Aov::thread:
      return "a colour for each tracer thread; black = not corrected";
    case Aov::age:
      return "bright = traced for this frame, dark = old; black = no sample";
  }
  return "";
}

}  // namespace saccade::app
