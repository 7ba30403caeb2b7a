// Independent pieces of a bake on several threads, each stage with its share of the progress bar.
#pragma once

#include <cstddef>
#include <utility>

#include "core/progress.h"
#include "raytrace/parallel_rows.h"

namespace saccade::raytrace {

/// The share [from, to] of a bake's progress that one stage makes up.
struct ProgressShare {
  double from = 0, to = 1;
};

/// parallelRows for pieces: work(i) once for every i in [0, count), count < 2^31; the order is not defined,
/// so results must not depend on it.
template <class Work>
void parallelFor(int threads, std::size_t count, const core::Progress& progress, ProgressShare share,
                 Work&& work) {
  core::Progress stage{{}, progress.stop};
  if (progress.report) {
    stage.report = [&](double fraction) { progress.report(share.from + (share.to - share.from) * fraction); };
  }
  parallelRows(static_cast<int>(count), threads, stage,
               [&](int i, int) { work(static_cast<std::size_t>(i)); });
}

}  // namespace saccade::raytrace
