// Does it pay to correct first what attracts the eye, while the camera walks?
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// Walks of three stretches of every scene's path at 512 x 512 with so many new samples a frame, by order of
/// correction, inline: the same figures on any machine and load. Errors are those against the converged
/// picture of the same camera: what is left is due to order alone, and not to noise or maps.
///
/// "walk-order/SCENE/ORDER@SAMPLES": rmse, rmse_salient (of displayed values), flip, flip_salient; stretches
/// are the repeats, each with its own seed. "walk-order/SCENE/against@SAMPLES": flip_salient_over_ORDER and
/// rmse_over_ORDER, the usual order's error over that of another (below 1 it pays), stretch by stretch. The
/// same of all stretches of the bundled scenes and of those kept apart (WalkedScene): SCENE is "bundled" or
/// "kept-apart".
void measureWalkOrder(Session& session);

}  // namespace saccade::bench
