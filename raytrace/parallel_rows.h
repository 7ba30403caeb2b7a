// Rows of an image over threads: the result depends on the row alone, never on who computes it.
#pragma once

#include <functional>

#include "core/progress.h"

namespace saccade::raytrace {

/// Calls row(y, worker) once for each y from 0 on, worker in [0, max(threads, 1)), until all of [0, height)
/// are done or progress.stop was requested; at least one row is done even then. Returns how many: exactly the
/// rows below were called and are finished. `threads` 0 = on the calling thread. Rethrows the first
/// exception.
int rowsUntilStopped(int height, int threads, const core::Progress& progress,
                     const std::function<void(int y, int worker)>& row);

/// All rows; throws core::Error when progress.stop was requested before they were done.
void parallelRows(int height, int threads, const core::Progress& progress,
                  const std::function<void(int y, int worker)>& row);

}  // namespace saccade::raytrace
