#include "app/session/visit_end.h"

#include "app/session/corrected_picture.h"
#include "core/content_hash.h"

namespace saccade::app {

std::uint64_t agingHash(const PictureSettings& o) {
  core::ContentHash hash;
  hash.add(o.aging);
  hash.add(o.delta);
  hash.add(o.nMin);
  hash.add(o.maxAge);
  return hash.value();
}

std::uint64_t maskHash(const core::FrameSnapshot& frame) {
  core::ContentHash hash;
  hash.addArray(frame.ids);
  hash.addArray(frame.depth);
  return hash.value();
}

}  // namespace saccade::app
