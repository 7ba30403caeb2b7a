#include "render/splat/correction_layer.h"

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace saccade::render {
namespace {

// A pixel's rank, larger wins: lattice level (4 bits; 8 = exact, 0 = nothing), fresh (1), closeness of the
// splat centre (15), youth (11). Signed because AVX2 compares signed integers only.
constexpr int kYouthBits = 11;
constexpr int kFreshShift = kYouthBits + 15;
constexpr int kLevelShift = kFreshShift + 1;
constexpr std::int32_t kMaxYouth = (1 << kYouthBits) - 1;
constexpr std::int32_t kExactLevel = core::Lattice::kMaxLevel + 1;
constexpr std::int32_t kExactRank = kExactLevel << kLevelShift;
/// Rank of pixels of no object and of the tiles' parts outside the image: nothing covers them.
constexpr std::int32_t kClosed = std::numeric_limits<std::int32_t>::max();

constexpr int kHalf = CorrectionLayer::kMaxFootprint / 2;
/// Splats into a tile after which the lowest rank in it is looked up again.
constexpr int kVisitsPerFloor = 4;
/// Lanes of a tile row can lie this far outside the widest footprint.
constexpr int kMargin = 8;
constexpr int kPitch = CorrectionLayer::kMaxFootprint + 2 * kMargin;

/// Closeness of a splat's own centre: the first of all offsets.
constexpr std::int32_t kClosest = CorrectionLayer::kMaxFootprint * CorrectionLayer::kMaxFootprint;

/// Closeness of a pixel to a splat centre by its offset (dx, dy) from it: a total order on the offsets, so
/// that no two centres tie at a pixel. 1 = farthest corner.
class ClosenessTable {
 public:
  ClosenessTable() {
    struct Offset {
      int dx, dy;
    };
    std::vector<Offset> offsets;
    for (int dy = -kHalf; dy <= kHalf; ++dy) {
      for (int dx = -kHalf; dx <= kHalf; ++dx) offsets.push_back({dx, dy});
    }
    // A centre of smaller y lies at larger dy of the pixel: ties in distance go to the smaller lattice index.
    std::sort(offsets.begin(), offsets.end(), [](const Offset& a, const Offset& b) {
      const int da = a.dx * a.dx + a.dy * a.dy, db = b.dx * b.dx + b.dy * b.dy;
      return std::tie(da, b.dy, b.dx) < std::tie(db, a.dy, a.dx);
    });
    auto closeness = static_cast<std::uint16_t>(offsets.size());
    for (const Offset& o : offsets) values_[index(o.dx, o.dy)] = closeness--;
  }
  /// |dy| <= kHalf, |dx| <= kHalf + kMargin; consecutive in dx.
  const std::uint16_t* at(int dx, int dy) const { return &values_[index(dx, dy)]; }

 private:
  static std::size_t index(int dx, int dy) {
    return static_cast<std::size_t>(dy + kHalf) * kPitch + static_cast<std::size_t>(dx + kHalf + kMargin);
  }
  std::array<std::uint16_t, static_cast<std::size_t>(CorrectionLayer::kMaxFootprint) * kPitch> values_{};
};

const ClosenessTable& closeness() {
  static const ClosenessTable table;
  return table;
}

std::int32_t lowestRank(const std::int32_t* rank) {
  __m256i low = _mm256_load_si256(reinterpret_cast<const __m256i*>(rank));
  for (int row = 8; row < 64; row += 8) {
    low = _mm256_min_epi32(low, _mm256_load_si256(reinterpret_cast<const __m256i*>(rank + row)));
  }
  __m128i half = _mm_min_epi32(_mm256_castsi256_si128(low), _mm256_extracti128_si256(low, 1));
  half = _mm_min_epi32(half, _mm_shuffle_epi32(half, 0x4e));
  half = _mm_min_epi32(half, _mm_shuffle_epi32(half, 0xb1));
  return _mm_cvtsi128_si32(half);
}

static_assert(CorrectionLayer::kMaxFootprint * CorrectionLayer::kMaxFootprint < 1 << 15);
static_assert(kExactLevel < 1 << 4);

}  // namespace

void CorrectionLayer::beginFrame(core::FramePtr frame) {
  assert(frame);
  frame_ = std::move(frame);
  exactCount_ = 0;
  splats_.clear();
  if (width_ != frame_->view.width() || height_ != frame_->view.height()) {
    width_ = frame_->view.width();
    height_ = frame_->view.height();
    tilesX_ = (width_ + kTile - 1) / kTile;
    tilesY_ = (height_ + kTile - 1) / kTile;
    tiles_.assign(static_cast<std::size_t>(tilesX_) * tilesY_, Tile{});
    states_.assign(tiles_.size(), TileState{});
    pixels_.assign(static_cast<std::size_t>(width_) * height_, core::Vec4(0));
  }
  std::size_t tile = 0;
  for (int ty = 0; ty < tilesY_; ++ty) {
    for (int tx = 0; tx < tilesX_; ++tx) loadMask(tile++, tx, ty);
  }
}

void CorrectionLayer::loadMask(std::size_t index, int tileX, int tileY) {
  Tile& tile = tiles_[index];
  const int x0 = tileX * kTile, y0 = tileY * kTile;
  const int columns = std::min(kTile, width_ - x0), rows = std::min(kTile, height_ - y0);
  if (columns < kTile || rows < kTile) std::fill(std::begin(tile.id), std::end(tile.id), 0u);
  for (int r = 0; r < rows; ++r) {
    const float* row = &frame_->ids[frame_->index(x0, y0 + r)];
    std::uint32_t* id = tile.id + r * kTile;
    if (columns == kTile) {
      for (int c = 0; c < kTile; ++c) id[c] = static_cast<std::uint32_t>(static_cast<std::int32_t>(row[c]));
    } else {
      for (int c = 0; c < columns; ++c) id[c] = static_cast<std::uint32_t>(row[c]);
    }
  }
  std::int32_t floor = kClosed;
  for (int i = 0; i < kTile * kTile; ++i) {
    tile.rank[i] = tile.id[i] == 0 ? kClosed : 0;
    floor = std::min(floor, tile.rank[i]);
  }
  states_[index] = {floor, 0, states_[index].lit, states_[index].lit};
}

void CorrectionLayer::splat(const core::Sample& sample) {
  assert(sample.level >= 1 && sample.level <= core::Lattice::kMaxLevel);
  const std::int32_t base = (sample.level << kLevelShift) | (1 << kFreshShift) | kMaxYouth;
  const int side = core::Lattice::splatSide(sample.level);
  const Splat splat{
      sample.correction, sample.x, sample.y, 0, sample.level, sample.thread, static_cast<std::uint8_t>(side)};
  // A splat of one pixel is nothing but its exact pixel.
  const bool spread = side > 1 && stamp(splat, sample.id, sample.x, sample.y, base);
  const bool exact = setExact(splat, sample.id);
  if (spread || exact) splats_.push_back(splat);
}

void CorrectionLayer::splatWarped(const Splat& warped, std::uint32_t id, core::Vec2 pixel) {
  assert(warped.level >= 1 && warped.level <= core::Lattice::kMaxLevel);
  assert(warped.footprint <= kMaxFootprint && warped.footprint % 2 == 1);
  const auto reach = static_cast<float>(kMaxFootprint);
  const bool near = pixel.x > -reach && pixel.y > -reach && pixel.x < static_cast<float>(width_) + reach &&
                    pixel.y < static_cast<float>(height_) + reach;
  if (!near) return;  // NaN included
  const std::int32_t youth = kMaxYouth - 1 - std::min<std::int32_t>(warped.ageFrames, kMaxYouth - 1);
  const std::int32_t base = (core::effectiveLevel(warped.level, warped.ageFrames) << kLevelShift) | youth;
  const int cx = static_cast<int>(std::floor(pixel.x)), cy = static_cast<int>(std::floor(pixel.y));
  const bool reached =
      warped.footprint == 1 ? stampPixel(warped, id, cx, cy, base) : stamp(warped, id, cx, cy, base);
  if (reached) splats_.push_back(warped);
}

/// stamp() for a splat of a single pixel: most of what a camera at rest leaves behind.
bool CorrectionLayer::stampPixel(const Splat& splat, std::uint32_t id, int x, int y, std::int32_t base) {
  if (id == 0 || x < 0 || y < 0 || x >= width_ || y >= height_) return false;
  const std::size_t index = tileIndex(x, y);
  Tile& tile = tiles_[index];
  const int i = inTile(x, y);
  const std::int32_t rank = base + (kClosest << kYouthBits);
  if (tile.id[i] != id || tile.rank[i] > rank) return false;
  if (tile.rank[i] == rank && !preferred(splat, splats_[tile.shown[i]])) return false;
  tile.rank[i] = rank;
  tile.shown[i] = static_cast<std::uint32_t>(splats_.size());
  states_[index].changed = true;
  return true;
}

/// Stamps what will be the next of splats_ into all tiles of its footprint; whether it reached a pixel.
bool CorrectionLayer::stamp(const Splat& splat, std::uint32_t id, int cx, int cy, std::int32_t base) {
  const int half = splat.footprint / 2;
  const Stamp s{base,
                id,
                static_cast<std::uint32_t>(splats_.size()),
                cx,
                cy,
                std::max(cx - half, 0),
                std::max(cy - half, 0),
                std::min(cx + half + 1, width_),
                std::min(cy + half + 1, height_)};
  if (s.id == 0 || s.x0 >= s.x1 || s.y0 >= s.y1) return false;
  // Per tile column, how far its pixel nearest to the centre lies from the centre: if even that pixel of a
  // tile is outranked, the tile is.
  const int tx0 = s.x0 / kTile, tx1 = (s.x1 - 1) / kTile;
  std::array<std::int32_t, kMaxFootprint / kTile + 3> nearX;
  for (int tx = tx0; tx <= tx1; ++tx) {
    nearX[static_cast<std::size_t>(tx - tx0)] =
        std::clamp(cx, std::max(s.x0, tx * kTile), std::min(s.x1, (tx + 1) * kTile) - 1) - cx;
  }
  bool reached = false;
  for (int ty = s.y0 / kTile; ty <= (s.y1 - 1) / kTile; ++ty) {
    const int nearY = std::clamp(cy, std::max(s.y0, ty * kTile), std::min(s.y1, (ty + 1) * kTile) - 1);
    const std::uint16_t* close = closeness().at(0, nearY - cy);
    const std::size_t row = static_cast<std::size_t>(ty) * tilesX_ + tx0;
    for (std::size_t k = 0; k <= static_cast<std::size_t>(tx1 - tx0); ++k) {
      if (base + (close[nearX[k]] << kYouthBits) < states_[row + k].floor) continue;
      const int tx = tx0 + static_cast<int>(k);
      const Stamped stamped = stampTile(s, row + k, tx, ty);
      reached |= stamped.reached;
      if (stamped.tied) reached |= settleTies(s, splat, row + k, tx, ty);
    }
  }
  return reached;
}

CorrectionLayer::Stamped CorrectionLayer::stampTile(const Stamp& s, std::size_t index, int tileX, int tileY) {
  Tile& tile = tiles_[index];
  const int left = tileX * kTile, top = tileY * kTile;
  const int x0 = std::max(s.x0, left), x1 = std::min(s.x1, left + kTile);
  const int y0 = std::max(s.y0, top), y1 = std::min(s.y1, top + kTile);
  // Lanes outside the footprint want id 0, which only closed pixels have.
  const __m256i columns =
      _mm256_add_epi32(_mm256_set1_epi32(left), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
  const __m256i inside = _mm256_andnot_si256(_mm256_cmpgt_epi32(_mm256_set1_epi32(x0), columns),
                                             _mm256_cmpgt_epi32(_mm256_set1_epi32(x1), columns));
  const __m256i wanted = _mm256_and_si256(inside, _mm256_set1_epi32(static_cast<int>(s.id)));
  const __m256i base = _mm256_set1_epi32(s.base), splat = _mm256_set1_epi32(static_cast<int>(s.splat));
  __m256i won = _mm256_setzero_si256(), tied = won;
  const std::uint16_t* close = closeness().at(left - s.cx, y0 - s.cy);
  for (int row = (y0 - top) * kTile; row < (y1 - top) * kTile; row += kTile, close += kPitch) {
    auto* rankAt = reinterpret_cast<__m256i*>(tile.rank + row);
    auto* shownAt = reinterpret_cast<__m256i*>(tile.shown + row);
    const __m256i near = _mm256_cvtepu16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(close)));
    const __m256i rank = _mm256_add_epi32(base, _mm256_slli_epi32(near, kYouthBits));
    const __m256i old = _mm256_load_si256(rankAt);
    const __m256i mine =
        _mm256_cmpeq_epi32(_mm256_load_si256(reinterpret_cast<const __m256i*>(tile.id + row)), wanted);
    const __m256i wins = _mm256_and_si256(mine, _mm256_cmpgt_epi32(rank, old));
    tied = _mm256_or_si256(tied, _mm256_and_si256(mine, _mm256_cmpeq_epi32(rank, old)));
    won = _mm256_or_si256(won, wins);
    _mm256_store_si256(rankAt, _mm256_blendv_epi8(old, rank, wins));
    _mm256_store_si256(shownAt, _mm256_blendv_epi8(_mm256_load_si256(shownAt), splat, wins));
  }
  TileState& state = states_[index];
  const bool reached = !_mm256_testz_si256(won, won);
  state.changed |= reached;
  // Only now and then, while the tile is in the nearest cache: an old floor is too low, which is harmless.
  if (++state.visits >= kVisitsPerFloor) {
    state.floor = lowestRank(tile.rank);
    state.visits = 0;
  }
  return {reached, !_mm256_testz_si256(tied, tied)};
}

/// Two samples of one level and age with the same centre pixel: rare, so once more pixel by pixel.
bool CorrectionLayer::settleTies(const Stamp& s, const Splat& splat, std::size_t index, int tileX,
                                 int tileY) {
  Tile& tile = tiles_[index];
  bool won = false;
  for (int y = std::max(s.y0, tileY * kTile); y < std::min(s.y1, (tileY + 1) * kTile); ++y) {
    for (int x = std::max(s.x0, tileX * kTile); x < std::min(s.x1, (tileX + 1) * kTile); ++x) {
      const int i = inTile(x, y);
      const std::int32_t rank = s.base + (*closeness().at(x - s.cx, y - s.cy) << kYouthBits);
      if (tile.id[i] != s.id || tile.rank[i] != rank) continue;
      // What this very splat has just won is a tie with itself.
      if (tile.shown[i] == s.splat || !preferred(splat, splats_[tile.shown[i]])) continue;
      tile.shown[i] = s.splat;
      won = states_[index].changed = true;
    }
  }
  return won;
}

bool CorrectionLayer::setExact(const Splat& splat, std::uint32_t id) {
  if (id == 0 || splat.x < 0 || splat.y < 0 || splat.x >= width_ || splat.y >= height_) return false;
  const std::size_t index = tileIndex(splat.x, splat.y);
  Tile& tile = tiles_[index];
  const int i = inTile(splat.x, splat.y);
  if (tile.id[i] != id) return false;
  if (tile.rank[i] == kExactRank && !preferred(splat, splats_[tile.shown[i]])) return false;
  if (tile.rank[i] != kExactRank) ++exactCount_;
  tile.rank[i] = kExactRank;
  tile.shown[i] = static_cast<std::uint32_t>(splats_.size());
  states_[index].changed = true;
  return true;
}

/// A total order among samples of equal rank: the traced pixel decides; the rest only tells apart what should
/// not occur, one pixel traced twice.
bool CorrectionLayer::preferred(const Splat& a, const Splat& b) {
  return std::tie(a.y, a.x, b.level, a.thread, a.correction.x, a.correction.y, a.correction.z) <
         std::tie(b.y, b.x, a.level, b.thread, b.correction.x, b.correction.y, b.correction.z);
}

bool CorrectionLayer::isExact(int x, int y) const {
  assert(x >= 0 && y >= 0 && x < width_ && y < height_);
  return tiles_[tileIndex(x, y)].rank[inTile(x, y)] == kExactRank;
}

const CorrectionLayer::Splat* CorrectionLayer::shownAt(int x, int y) const {
  assert(x >= 0 && y >= 0 && x < width_ && y < height_);
  const Tile& tile = tiles_[tileIndex(x, y)];
  const std::int32_t rank = tile.rank[inTile(x, y)];
  return rank == 0 || rank == kClosed ? nullptr : &splats_[tile.shown[inTile(x, y)]];
}

std::uint32_t CorrectionLayer::coveredCount() const {
  std::uint32_t count = 0;
  for (const Tile& tile : tiles_) {
    for (const std::int32_t rank : tile.rank) count += rank != 0 && rank != kClosed;
  }
  return count;
}

std::vector<std::uint8_t> CorrectionLayer::levels() const {
  std::vector<std::uint8_t> levels(static_cast<std::size_t>(width_) * height_);
  std::size_t index = 0;
  for (int top = 0; top < height_; top += kTile) {
    for (int left = 0; left < width_; left += kTile, ++index) {
      const int rows = std::min(kTile, height_ - top), columns = std::min(kTile, width_ - left);
      for (int r = 0; r < rows; ++r) {
        const std::int32_t* rank = tiles_[index].rank + r * kTile;
        std::uint8_t* level = &levels[static_cast<std::size_t>(top + r) * width_ + left];
        for (int c = 0; c < columns; ++c)
          level[c] = static_cast<std::uint8_t>(rank[c] == kClosed ? 0 : rank[c] >> kLevelShift);
      }
    }
  }
  return levels;
}

void CorrectionLayer::listUncovered(std::vector<core::Pixel>& pixels) {
  pixels.clear();
  for (std::size_t index = 0; index < tiles_.size(); ++index) {
    TileState& state = states_[index];
    if (state.floor > 0) continue;
    const Tile& tile = tiles_[index];
    state.floor = lowestRank(tile.rank);
    if (state.floor > 0) continue;
    const int x0 = static_cast<int>(index) % tilesX_ * kTile, y0 = static_cast<int>(index) / tilesX_ * kTile;
    for (int i = 0; i < kTile * kTile; ++i) {
      const int x = i / 4 % (kTile / 2) * 2 + i % 2, y = i / (2 * kTile) * 2 + i / 2 % 2;
      if (tile.rank[y * kTile + x] == 0) pixels.push_back({x0 + x, y0 + y});
    }
  }
}

std::span<const core::Vec4> CorrectionLayer::pixels() {
  std::size_t tile = 0;
  for (int ty = 0; ty < tilesY_; ++ty) {
    for (int tx = 0; tx < tilesX_; ++tx, ++tile) {
      if (states_[tile].changed) resolveTile(tile, tx, ty);
    }
  }
  return pixels_;
}

void CorrectionLayer::resolveTile(std::size_t index, int tileX, int tileY) {
  const Tile& tile = tiles_[index];
  bool lit = false;
  for (int y = tileY * kTile; y < std::min((tileY + 1) * kTile, height_); ++y) {
    for (int x = tileX * kTile; x < std::min((tileX + 1) * kTile, width_); ++x) {
      const int i = inTile(x, y);
      const bool shows = tile.rank[i] != 0 && tile.rank[i] != kClosed;
      pixels_[static_cast<std::size_t>(y) * width_ + x] =
          shows ? core::Vec4(splats_[tile.shown[i]].correction, 0) : core::Vec4(0);
      lit |= shows;
    }
  }
  states_[index].lit = lit;
  states_[index].changed = false;
}

}  // namespace saccade::render
