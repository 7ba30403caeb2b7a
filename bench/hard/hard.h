// The achieved error of the numerical hard cases, from the tests that assert them.
#pragma once

#include "bench/harness/experiment.h"

namespace saccade::bench {

/// One record a clause, "hard/NUMBER/CLAUSE": achieved, allowed, checks, and headroom (allowed / achieved)
/// where both are above 0. The tests are run, not measured again: the test programs that lie beside this
/// program, those named Hard<number> of them; their reports are kept in <folder>/tests. A clause of what is
/// not built yet has a record without values. Throws core::Error where a test failed (its records say so) or
/// a program is missing.
void measureHardCases(Session& session);

}  // namespace saccade::bench
