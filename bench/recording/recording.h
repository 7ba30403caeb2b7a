// What does recording a walk cost?
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// The gallery walk at 25 frames a second, by turns with and without --record: "recording/gallery". Share of
/// the frame's budget that the frame loop spends on handing over, processor time of the writing thread,
/// bytes.
void measureRecording(Session& session);

}  // namespace saccade::bench
