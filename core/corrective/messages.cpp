#include "core/corrective/messages.h"

#include <immintrin.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "core/error.h"

namespace saccade::core {
namespace {

struct Measured {
  std::vector<ObjectExtent>& extents;
  std::uint32_t idCount;

  /// One run of equal IDs in a row.
  void add(float idValue, int x0, int x1, int y) {
    if (!(idValue >= 0 && idValue <= static_cast<float>(idCount))) {
      throw Error("the ID mask names object " + std::to_string(idValue) + " at pixel (" + std::to_string(x0) +
                  ", " + std::to_string(y) + "), but the scene has " + std::to_string(idCount) +
                  " non-diffuse objects");
    }
    ObjectExtent& e = extents[static_cast<std::uint32_t>(idValue)];
    if (e.pixels == 0) e.box = {x0, y, x1, y + 1};
    e.box = {std::min(e.box.x0, x0), e.box.y0, std::max(e.box.x1, x1), y + 1};
    e.pixels += static_cast<std::uint32_t>(x1 - x0);
  }
};

/// Where the run of equal IDs that begins at `start` ends. NaN equals nothing, itself included.
int endOfRun(const float* ids, int width, int start) {
  const __m256 id = _mm256_set1_ps(ids[start]);
  int x = start + 1;
  for (; x + 8 <= width; x += 8) {
    const __m256 differs = _mm256_cmp_ps(_mm256_loadu_ps(ids + x), id, _CMP_NEQ_UQ);
    const auto lanes = static_cast<unsigned>(_mm256_movemask_ps(differs));
    if (lanes != 0) return x + std::countr_zero(lanes);
  }
  while (x < width && ids[x] == ids[start]) ++x;
  return x;
}

void measureBoxes(FrameSnapshot& frame, Measured measured) {
  const int width = frame.view.width(), height = frame.view.height();
  frame.ids.resize(frame.baseAndId.size());
  const Vec4* row = frame.baseAndId.data();
  float* ids = frame.ids.data();
  for (int y = 0; y < height; ++y, row += width, ids += width) {
    for (int x = 0; x < width; ++x) ids[x] = row[x].w;
    for (int x = 0; x < width;) {
      const int end = endOfRun(ids, width, x);
      const float id = ids[x];
      if (id != 0) measured.add(id, x, end, y);
      x = end;
    }
  }
}

/// Lattice points on the masks, counted over the whole image level by level: the levels below kMaxLevel
/// together touch a quarter of the pixels, however many objects there are, and mostly fewer, because objects
/// drop out as their start level is found.
void findStartLevels(FrameSnapshot& frame, int nMin) {
  const auto enough = static_cast<std::uint32_t>(std::max(nMin, 0));
  std::size_t open = 0;
  for (ObjectExtent& e : frame.extents) {
    e.startLevel = Lattice::kMaxLevel;
    if (e.pixels >= enough && e.pixels > 0) ++open;
  }
  const PixelBox image{0, 0, frame.view.width(), frame.view.height()};
  std::vector<std::uint32_t> points(frame.extents.size());
  for (int level = 1; level < Lattice::kMaxLevel && open > 0; ++level) {
    std::fill(points.begin(), points.end(), 0);
    walkLattice(image, beginLevel(image, level), image.area(), false,
                [&](int x, int y) { ++points[frame.idAt(x, y)]; });
    for (std::size_t id = 1; id < points.size(); ++id) {
      ObjectExtent& e = frame.extents[id];
      if (e.pixels == 0 || e.startLevel != Lattice::kMaxLevel || points[id] < enough) continue;
      e.startLevel = level;
      --open;
    }
  }
}

}  // namespace

bool isFinite(const Sample& s) {
  for (const Vec3* v : {&s.correction, &s.position, &s.normal, &s.toEye}) {
    if (!std::isfinite(v->x) || !std::isfinite(v->y) || !std::isfinite(v->z)) return false;
  }
  return std::isfinite(s.cosView) && std::isfinite(s.viewDepth) && std::isfinite(s.changeRate);
}

void measureExtents(FrameSnapshot& frame, std::uint32_t idCount, int nMin) {
  frame.extents.assign(std::size_t{idCount} + 1, ObjectExtent{});
  measureBoxes(frame, {frame.extents, idCount});
  frame.nonDiffusePixels = 0;
  for (const ObjectExtent& e : frame.extents) frame.nonDiffusePixels += e.pixels;
  findStartLevels(frame, nMin);
}

}  // namespace saccade::core
