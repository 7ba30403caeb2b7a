// What the threads send each other. Everything carries the camera epoch. Immutable once sent.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/camera.h"
#include "core/corrective/known_levels.h"
#include "core/corrective/lattice.h"
#include "core/image.h"
#include "core/math/types.h"

namespace saccade::core {

/// Where an object stands in a frame's ID mask.
struct ObjectExtent {
  PixelBox box;              ///< tight
  std::uint32_t pixels = 0;  ///< on the mask
  int startLevel = 1;        ///< first level with at least N_min lattice points on the mask (else kMaxLevel)
};

/// One rendered base layer as read back. Main thread makes it, any thread reads it.
struct FrameSnapshot {
  std::uint64_t epoch = 0;  ///< camera epoch: raised whenever camera, scene or settings change
  View view;
  /// Per pixel: linear base radiance RGB and, as a float, the ID (0 = diffuse or background). Row 0 = top.
  std::vector<Vec4> baseAndId;
  /// The IDs of baseAndId side by side: who asks for the mask alone touches a quarter of the memory.
  /// measureExtents fills it.
  std::vector<float> ids;
  std::vector<float> depth;           ///< depth buffer, View::viewDepth; 0 = nothing drawn
  std::vector<ObjectExtent> extents;  ///< by id; [0] unused
  std::uint32_t nonDiffusePixels = 0;

  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * view.width() + x; }
  std::uint32_t idAt(int x, int y) const { return static_cast<std::uint32_t>(ids[index(x, y)]); }
};
using FramePtr = std::shared_ptr<const FrameSnapshot>;

/// What the analyzer looks at: the frame and the picture as displayed (base + corrections, after the display
/// transform).
struct AnalysisInput {
  FramePtr frame;
  std::shared_ptr<const ImageRgba8> display;
};

/// Fills ids, extents (idCount + 1 entries) and nonDiffusePixels from baseAndId. One pass for boxes and
/// counts, lattice points counted per level for the start level with N_min (Haber 2001, section 4.5; design
/// fact 3).
void measureExtents(FrameSnapshot& frame, std::uint32_t idCount, int nMin);

/// One corrective sample (Haber 2001, sections 4.3 and 4.5).
struct Sample {
  std::int32_t x = 0, y = 0;  ///< pixel it was traced for
  std::uint32_t id = 0;       ///< object
  std::uint8_t level = 1;     ///< lattice level it was traced at
  std::uint8_t thread = 0;    ///< tracer that made it (overlay)
  bool fromDepth = false;     ///< the ray missed the named object; the point of the depth buffer was shaded
  Vec3 correction{0};         ///< full radiance - base, linear, signed
  Vec3 position{0};           ///< world, on the object
  Vec3 normal{0};             ///< shading normal, unit
  float cosView = 0;          ///< <normal, v>, v = unit vector from position to eye
  float viewDepth = 0;        ///< metres along the line of sight
  Vec3 toEye{0};              ///< unit vector from position to the eye it was traced for
  /// Expected change of the correction, as displayed (0 to 1), for each radian by which the direction to the
  /// eye turns; 0: not estimated. core/corrective/change_rate.h.
  float changeRate = 0;
};

/// None of its numbers is NaN or infinite.
bool isFinite(const Sample& sample);

struct SampleBatch {
  std::uint64_t epoch = 0;
  std::uint64_t sequence =
      0;  ///< number of the job in the order in which jobs were handed out within the epoch
  std::vector<Sample> samples;  ///< in lattice order
};

/// One piece of work for a tracer: at most `points` lattice points of one level in one object's box.
struct Job {
  FramePtr frame;
  std::uint32_t id = 0;
  LatticeCursor begin;
  std::int64_t points = 0;   ///< lattice points in the box, mask or not
  bool omitCoarser = false;  ///< coarser levels have been walked before this one
  std::uint64_t sequence = 0;
  float priority = 0;
  KnownLevels known;  ///< of the frame's pixels; a pixel waits for the first level finer than what is known
  bool refresh = false;  ///< after the last level: the pixels known as well as a fresh sample of that level

  /// Whether a lattice point of the job's level is this job's. Of all levels' jobs and the refreshing ones
  /// every pixel on the mask is due in just one.
  bool due(int x, int y) const {
    const int level = begin.level;
    const int best = known ? (*known)[frame->index(x, y)] : 0;
    if (refresh) return best >= Lattice::kMaxLevel;
    if (best + 1 >= level) return best + 1 == level;
    return !omitCoarser || !Lattice::contains(level - 1, x, y);
  }
};

/// Calls visit(x, y) for each pixel of the job: lattice points on the object's mask that are due. The mask is
/// read a few points behind the walk: points lie far apart, and each waits for memory.
template <class Visit>
void forEachPixel(const Job& job, Visit&& visit) {
  constexpr std::size_t kBehind = 8;
  const FrameSnapshot& frame = *job.frame;
  Pixel pending[kBehind];
  std::size_t walked = 0;
  const auto look = [&](const Pixel& p) {
    if (frame.idAt(p.x, p.y) == job.id && (!job.known || job.due(p.x, p.y))) visit(p.x, p.y);
  };
  // Where something is known, a point of a coarser level may still be due.
  const bool omitCoarser = job.omitCoarser && !job.known;
  walkLattice(frame.extents[job.id].box, job.begin, job.points, omitCoarser, [&](int x, int y) {
    __builtin_prefetch(&frame.ids[frame.index(x, y)]);
    Pixel& slot = pending[walked % kBehind];
    if (walked++ >= kBehind) look(slot);
    slot = {x, y};
  });
  for (std::size_t i = walked - std::min(walked, kBehind); i < walked; ++i) look(pending[i % kBehind]);
}

}  // namespace saccade::core
