#include "app/viewer/overlay_view.h"

#include <utility>

namespace saccade::app {

OverlayView::Source OverlayView::sourceOf(Aov aov) const {
  Source source{.aov = aov, .epoch = loop_.frame().epoch};
  switch (aov) {
    case Aov::id:
      break;
    case Aov::saliency:
    case Aov::importance:
      source.analysis = loop_.analyzer().latest();
      break;
    case Aov::rank:
      source.ranks = loop_.ranks();
      break;
    case Aov::validity:
      source.delta = loop_.settings().delta;
      source.cached = loop_.cache().stored();
      [[fallthrough]];
    case Aov::level:
    case Aov::thread:
    case Aov::age:
    case Aov::footprint:
      source.samples = loop_.stats().samplesTraced;
      break;
  }
  return source;
}

void OverlayView::draw(Aov aov, float strength, core::ImageRgba8& picture) {
  Source source = sourceOf(aov);
  if (source_ != source) {
    source_ = std::move(source);
    const AovImage image = aovImage(aov, loop_);
    const AovScale scale(aov, image.values, maxAge_);
    shown_ = {scale, aovLegend(scale, image.values, scene_)};
    colors_ = aovPicture(image, scale);
    ++computed_;
  }
  layOver(colors_, strength, picture);
}

void OverlayView::hide() {
  source_.reset();
  shown_.reset();
}

}  // namespace saccade::app
