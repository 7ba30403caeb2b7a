// Independent pieces of a bake on several threads, each stage with its share of the progress bar.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/progress.h"
#include "raytrace/parallel_rows.h"

namespace saccade::raytrace {

/// The share [from, to] of a bake's progress that one stage makes up.
struct ProgressShare {
  double from = 0, to = 1;
};

/// Texels are worked on in blocks of so many: what a bake can stop after and go on from.
inline constexpr std::size_t kTexelsPerBlock = 4096;

/// Blocks [first, last) of an atlas.
struct BlockRange {
  std::size_t first = 0, last = 0;
};

inline BlockRange allBlocks(std::size_t texels) {
  return {0, (texels + kTexelsPerBlock - 1) / kTexelsPerBlock};
}

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

/// work(texel) once for every texel < `texels` of the blocks.
template <class Work>
void parallelTexels(int threads, BlockRange blocks, std::size_t texels, const core::Progress& progress,
                    ProgressShare share, Work&& work) {
  parallelFor(threads, blocks.last - blocks.first, progress, share, [&](std::size_t i) {
    const std::size_t begin = (blocks.first + i) * kTexelsPerBlock;
    for (std::size_t t = begin; t < std::min(texels, begin + kTexelsPerBlock); ++t) work(t);
  });
}

}  // namespace saccade::raytrace
