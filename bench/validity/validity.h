// How valid are the cached samples that aging keeps (Haber 2001, section 4.5), and how many valid ones does
// it throw away?
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// Bundled scenes and their paths at 256 x 256. Samples are judged at six places of each path; a sample is
/// valid if the correction of its own point, traced for the new eye, differs by at most 0.03 as displayed.
/// The point is the sample's and not the pixel it lands on, and the random numbers are its own: so nothing
/// but the eye differs, and neither a neighbour's texture nor noise passes for age.
///
/// "validity/KIND/TEST@DELTA": precision, recall, reuse (share kept) of a test, error (RMS, displayed, of
/// what it keeps), the same with other tolerances and without noise, and errors of a whole walk (walk_rmse,
/// walk_flip). "validity/KIND/as-haber@DELTA": what `change` keeps with the largest delta of its own whose
/// precision is still that of haber (reuse, recall, times_reuse).
void measureValidity(Session& session);

}  // namespace saccade::bench
