#include "app/session/visit_end.h"

#include <span>

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
  for (const std::vector<float>* values : {&frame.ids, &frame.depth}) {
    hash.add(
        std::span(reinterpret_cast<const std::uint8_t*>(values->data()), values->size() * sizeof(float)));
  }
  return hash.value();
}

}  // namespace saccade::app
