// Independent pieces of a bake on several threads, each stage with its share of the progress bar.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>

#include "core/progress.h"
#include "raytrace/parallel_rows.h"

namespace saccade::raytrace {

/// The share [from, to] of a bake's progress that one stage makes up.
struct ProgressShare {
  double from = 0, to = 1;
};

/// Texels are worked on in blocks of so many: what a bake can pause after and go on from.
inline constexpr std::size_t kTexelsPerBlock = 256;

/// Blocks [first, last) of an atlas, in the order of parallelTexels.
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

/// Blocks in an order whose every beginning is spread evenly over the atlas (multiples of the golden ratio),
/// so that the time which some took tells how long the rest will take.
class BlockOrder {
 public:
  explicit BlockOrder(std::size_t count) : count_(count) {
    if (count < 2) return;
    stride_ = static_cast<std::size_t>(0.6180339887 * static_cast<double>(count));
    while (std::gcd(stride_, count) != 1) ++stride_;
  }
  std::size_t at(std::size_t i) const { return i * stride_ % count_; }

 private:
  std::size_t count_;
  std::size_t stride_ = 1;
};

/// work(texel) once for every texel < `texels` of the blocks, until all are done or a stop was requested (at
/// least one block is done even then). Returns the first block that is not done; all before it are.
template <class Work>
std::size_t parallelTexels(int threads, BlockRange blocks, std::size_t texels, const core::Progress& progress,
                           Work&& work) {
  const BlockOrder order(allBlocks(texels).last);
  const int done =
      rowsUntilStopped(static_cast<int>(blocks.last - blocks.first), threads, progress, [&](int i, int) {
        const std::size_t begin = order.at(blocks.first + static_cast<std::size_t>(i)) * kTexelsPerBlock;
        for (std::size_t t = begin; t < std::min(texels, begin + kTexelsPerBlock); ++t) work(t);
      });
  return blocks.first + static_cast<std::size_t>(done);
}

}  // namespace saccade::raytrace
