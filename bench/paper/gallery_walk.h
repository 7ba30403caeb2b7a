// Does the frame rate hold in the museum hall?
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// 512x512, moving along the bundled path, at the paper's 8 frames a second ("gallery-walk/8fps") and at 25
/// ("gallery-walk/25fps"), by turns with the bare draw and read-back of the same frames without tracers.
/// Where a frame at 25 goes: "gallery-walk/stages". What is walked through: "gallery-walk/scene".
void measureGalleryWalk(Session& session);

}  // namespace saccade::bench
