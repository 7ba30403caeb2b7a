// Rows of an image over threads: the result depends on the row alone, never on who computes it.
#pragma once

#include <functional>

#include "core/progress.h"

namespace saccade::raytrace {

/// Calls row(y, worker) once for each y in [0, height), worker in [0, max(threads, 1)). `threads` 0 = on the
/// calling thread. Rethrows the first exception. Throws core::Error when progress.stop was requested before
/// all rows were done.
void parallelRows(int height, int threads, const core::Progress& progress,
                  const std::function<void(int y, int worker)>& row);

}  // namespace saccade::raytrace
