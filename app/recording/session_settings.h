// The settings of a frame by name, as recorded sessions keep them.
#pragma once

#include "app/session/corrected_picture.h"

namespace saccade::app {

/// Settings of a frame: those of the picture, and attention, which decides what was traced.
struct FrameSettings {
  PictureSettings picture;
  float attention = 0.5f;

  bool operator==(const FrameSettings&) const = default;
};

/// Calls visit(name, value) for every setting that is a number (float, int or bool); the aging test's name
/// stands apart (agingTests()).
template <class Settings, class Visit>
void forEachNumber(Settings& s, Visit&& visit) {
  visit("delta", s.picture.delta);
  visit("nmin", s.picture.nMin);
  visit("max_age", s.picture.maxAge);
  visit("cache_mb", s.picture.cacheMb);
  visit("exposure", s.picture.exposureEv);
  visit("corrections", s.picture.corrections);
  visit("reuse", s.picture.reuse);
  visit("approximation", s.picture.approximation);
  visit("attention", s.attention);
}

/// A frame of a session, as shown, without its samples.
struct RecordedFrame {
  double seconds = 0;  ///< of the session
  bool newView = true;
  core::Camera camera;
  ImageSize size;
  std::uint64_t epoch = 0;
  FrameSettings settings;
  std::uint64_t hash = 0;           ///< frameHash of the display
  std::vector<std::uint8_t> tiles;  ///< tileMeans of the display
};

}  // namespace saccade::app
