// Experiments on still views; see docs/benchmarks.md for what their records hold.
#pragma once

#include <cstdint>
#include <functional>

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// "reference": the references themselves and their own estimated errors, the floor of everything measured
/// against them. Keys reference/SCENE.
void runReferences(Session& session);

/// "still": error against seconds of every method. Keys still/SCENE/METHOD@SETTING, for example
/// still/cornell/corrective-attention@125ms. Points that not every repeat reached are left out.
void runStill(Session& session);

/// "order": what of the correction is still missing after so many samples, for every order and weight of
/// attention. Errors are those against the converged picture, so nothing here depends on time or on a
/// reference. Keys order/SCENE/ORDER@1of16 (of all samples), and order/SCENE/ORDER with `samples_to_half`:
/// the samples after which saliency-weighted FLIP has fallen to half of the base's.
void runOrder(Session& session);

/// The least number of samples that is enough, between one that is not and one that is, to a 32nd of their
/// distance.
std::uint64_t fewestSamples(std::uint64_t tooFew, std::uint64_t enough,
                            const std::function<bool(std::uint64_t)>& isEnough);

}  // namespace saccade::bench
