// Haber et al. 2001, Figure 6: warping old samples for reuse, on a chrome-plated duck.
#pragma once

#include "bench/harness/experiment.h"
#include "core/corrective/messages.h"

namespace saccade::bench {

/// Four pictures and records, "figures/duck-a" to "-d": the converged view; zoomed in with warped samples
/// only; with new samples of levels 1 and 2; with level 3 too. Sample counts beside the paper's, errors
/// against the ray-traced zoomed view. Says so and does nothing where the shared folder has no duck.
void drawFigure6(Session& session);

/// The points of lattice levels first..last on an object's mask, without those of coarser levels:
/// visit(x, y, level), level by level.
template <class Visit>
void forEachNewPoint(const core::FrameSnapshot& frame, std::uint32_t id, int first, int last, Visit&& visit) {
  const core::PixelBox& box = frame.extents[id].box;
  for (int level = first; level <= last; ++level) {
    core::walkLattice(box, core::beginLevel(box, level), box.area(), true, [&](int x, int y) {
      if (frame.idAt(x, y) == id) visit(x, y, level);
    });
  }
}

}  // namespace saccade::bench
