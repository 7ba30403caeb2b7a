#include "app/recording/session_check.h"

#include <algorithm>
#include <cstdlib>

#include "app/recording/session_format.h"

namespace saccade::app {

std::optional<std::string> SessionCheck::difference(const RecordedFrame& frame,
                                                    const core::ImageRgba8& display) {
  if (frameHash(display) == frame.hash) {
    ++equal_;
    return {};
  }
  if (sameMachine_) return "its picture has another hash";
  const std::vector<std::uint8_t> tiles = tileMeans(display);
  if (tiles.size() != frame.tiles.size()) return "its recorded tiles are not those of its size";
  int worst = 0;
  for (std::size_t i = 0; i < tiles.size(); ++i) worst = std::max(worst, std::abs(tiles[i] - frame.tiles[i]));
  largest_ = std::max(largest_, worst);
  if (worst > kTileTolerance)
    return "a tile's mean differs by " + std::to_string(worst) + " of 255, " +
           std::to_string(kTileTolerance) + " are allowed on another machine";
  ++similar_;
  return {};
}

}  // namespace saccade::app
