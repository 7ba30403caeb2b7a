#include "render/splat/sample_cache.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "core/corrective/change_rate.h"

namespace saccade::render {
namespace {

constexpr int kMaxLevel = core::Lattice::kMaxLevel;
/// Splats between the fetch of a tile and its use.
constexpr std::size_t kAhead = 8;
constexpr float kLargest = std::numeric_limits<float>::max();

float pixelsPerRadianOf(const core::View& view) {
  const float halfAngle = 0.5f * view.camera().fovYDegrees * core::kPi / 180;
  return 0.5f * static_cast<float>(view.height()) / std::tan(halfAngle);
}

/// The depth test of a warp, in inverse view depth: that is affine in window depth, exactly linear across a
/// plane's picture, and needs no division.
class DepthTest {
 public:
  explicit DepthTest(const core::FrameSnapshot& frame)
      : depth_(frame.depth.data()),
        width_(frame.view.width()),
        height_(frame.view.height()),
        inverseNear_(1 / frame.view.zNear()),
        inverseFar_(1 / frame.view.zFar()),
        radiansPerPixel_(1 / pixelsPerRadianOf(frame.view)) {}

  bool agrees(core::Vec2 pixel, std::size_t index, float viewDepth) const {
    const float w = inverse(index);
    const float difference = std::abs(viewDepth * w - 1) * w;
    if (difference <= radiansPerPixel_ * w) return true;
    return difference <= radiansPerPixel_ * w + slope(w, index, static_cast<int>(pixel.x), width_, 1) +
                             slope(w, index, static_cast<int>(pixel.y), height_, width_);
  }

 private:
  float inverse(std::size_t index) const {
    return depth_[index] * inverseNear_ + (1 - depth_[index]) * inverseFar_;
  }
  /// Change of inverse depth across a pixel along one axis: of the two neighbours the one that differs less,
  /// so that the edge of an occluder beside the pixel does not pass for a steep surface.
  float slope(float w, std::size_t index, int at, int size, int stride) const {
    const float before = at > 0 ? std::abs(inverse(index - stride) - w) : core::kInfinity;
    const float after = at + 1 < size ? std::abs(inverse(index + stride) - w) : core::kInfinity;
    const float smaller = std::min(before, after);
    return smaller < core::kInfinity ? smaller : 0;
  }

  const float* depth_;
  int width_, height_;
  float inverseNear_, inverseFar_, radiansPerPixel_;
};

/// Odd side of a splat that covers, magnified, what its level's covers at magnification 1. A thousandth is
/// given away so that rounding of depths does not widen a splat that has not grown.
int scaledFootprint(int level, float magnification) {
  const float side = static_cast<float>(core::Lattice::splatSide(level)) * magnification * 0.999f;
  const float capped = std::min(side, static_cast<float>(CorrectionLayer::kMaxFootprint));
  return 2 * static_cast<int>(std::ceil(std::max(capped - 1, 0.0f) / 2)) + 1;
}

}  // namespace

void SampleCache::Page::set(int i, const core::Sample& s) {
  px[i] = s.position.x, py[i] = s.position.y, pz[i] = s.position.z;
  nx[i] = s.normal.x, ny[i] = s.normal.y, nz[i] = s.normal.z;
  cosView[i] = s.cosView;
  viewDepth[i] = s.viewDepth;
  vx[i] = s.toEye.x, vy[i] = s.toEye.y, vz[i] = s.toEye.z;
  changeRate[i] = s.changeRate > 0 ? s.changeRate : core::kUnknownChangeRate;
  id[i] = s.id;
  correction[i] = s.correction;
  x[i] = static_cast<std::uint16_t>(s.x);
  y[i] = static_cast<std::uint16_t>(s.y);
  level[i] = s.level;
  thread[i] = s.thread;
  fromDepth[i] = s.fromDepth;
}

core::Sample SampleCache::Page::get(int i) const {
  core::Sample s;
  s.x = x[i], s.y = y[i];
  s.id = id[i];
  s.level = level[i];
  s.thread = thread[i];
  s.fromDepth = fromDepth[i];
  s.correction = correction[i];
  s.position = position(i);
  s.normal = {nx[i], ny[i], nz[i]};
  s.cosView = cosView[i];
  s.viewDepth = viewDepth[i];
  s.toEye = {vx[i], vy[i], vz[i]};
  s.changeRate = changeRate[i];
  return s;
}

SampleCache::SampleCache(std::size_t maxBytes) : maxPages_(maxBytes / sizeof(Page)) {}

std::uint32_t SampleCache::count(std::uint32_t id, int level) const {
  assert(level >= 1 && level <= kMaxLevel);
  return id < counts_.size() ? counts_[id][static_cast<std::size_t>(level)] : 0;
}

void SampleCache::clear() {
  generations_.clear();
  freePages_.clear();
  counts_.clear();
  allocatedPages_ = size_ = 0;
}

std::size_t SampleCache::add(const core::SampleBatch& batch, std::uint64_t cameraAge) {
  assert(cameraAge <= cameraAge_);
  std::size_t stored = 0;
  for (const core::Sample& s : batch.samples) {
    assert(s.level >= 1 && s.level <= kMaxLevel);
    if (!core::isFinite(s)) continue;
    // Looked up anew for every sample: making room may remove generations.
    Generation* g = &generation(cameraAge);
    if (g->pages.empty() || g->pages.back()->count == Page::kCapacity) {
      PagePtr page = takePage(cameraAge);
      g = &generation(cameraAge);
      if (!page) break;
      g->pages.push_back(std::move(page));
    }
    Page& page = *g->pages.back();
    page.arrival[page.count] = g->arrivals++;
    page.set(page.count++, s);
    if (s.id >= counts_.size()) counts_.resize(s.id + std::size_t{1});
    ++counts_[s.id][s.level];
    ++size_;
    ++stored;
  }
  stored_ += stored;
  return stored;
}

std::size_t SampleCache::restore(const core::SampleBatch& batch, std::uint64_t cameraAge,
                                 float pixelsPerRadian) {
  assert(cameraAge > cameraAge_);
  cameraAge_ = cameraAge;
  pixelsPerRadian_ = pixelsPerRadian;
  return add(batch, cameraAge);
}

/// The generation of an age, made where there is none.
SampleCache::Generation& SampleCache::generation(std::uint64_t age) {
  auto it = generations_.end();
  while (it != generations_.begin() && std::prev(it)->age >= age) --it;
  if (it == generations_.end() || it->age != age)
    it = generations_.insert(it, Generation{age, pixelsPerRadian_, {}});
  return *it;
}

/// A page for samples of an age: a free one, a new one, or the last of the oldest generation. Null
/// where there is none.
SampleCache::PagePtr SampleCache::takePage(std::uint64_t forAge) {
  if (freePages_.empty() && allocatedPages_ == maxPages_) {
    while (!generations_.empty() && generations_.front().pages.empty() && generations_.front().age < forAge) {
      generations_.pop_front();
    }
    if (generations_.empty() || generations_.front().age >= forAge) return nullptr;
    dropPageOfOldest();
  }
  if (freePages_.empty()) {
    ++allocatedPages_;
    return std::make_unique<Page>();
  }
  PagePtr page = std::move(freePages_.back());
  freePages_.pop_back();
  return page;
}

/// The page of those that arrived last, which is the least salient.
void SampleCache::dropPageOfOldest() {
  Generation& g = generations_.front();
  if (!g.inOrder) sortByArrival(g);
  releasePage(std::move(g.pages.back()));
  g.pages.pop_back();
  if (g.pages.empty()) generations_.pop_front();
}

/// At most once a generation and camera change: only deletions disturb the order.
void SampleCache::sortByArrival(Generation& g) {
  struct Arrived {
    std::uint32_t arrival;
    core::Sample sample;
  };
  std::vector<Arrived> all;
  for (const PagePtr& page : g.pages) {
    for (int i = 0; i < page->count; ++i) all.push_back({page->arrival[i], page->get(i)});
  }
  std::sort(all.begin(), all.end(), [](const Arrived& a, const Arrived& b) { return a.arrival < b.arrival; });
  auto next = all.begin();
  for (const PagePtr& page : g.pages) {
    for (int i = 0; i < page->count; ++i, ++next) {
      page->arrival[i] = next->arrival;
      page->set(i, next->sample);
    }
  }
  g.inOrder = true;
}

/// Keeps a page for reuse, with whatever lives on it forgotten.
void SampleCache::releasePage(PagePtr page) {
  for (int i = 0; i < page->count; ++i) forget(*page, i);
  page->count = 0;
  freePages_.push_back(std::move(page));
}

SampleCache::AgingResult SampleCache::age(const core::View& view, const AgingOptions& options) {
  assert(options.nMin >= 0 && options.maxAge >= 0);
  ++cameraAge_;
  pixelsPerRadian_ = pixelsPerRadianOf(view);
  const std::size_t before = size_;
  // The starting levels come first, as in the paper: samples beyond MAX_AGE still count for them.
  const std::vector<std::uint8_t> tested = testedLevels(options.nMin);
  const auto maxAge = static_cast<std::uint64_t>(options.maxAge);
  if (cameraAge_ > maxAge) dropGenerations(cameraAge_ - maxAge);
  const core::Vec3& eye = view.camera().eye;
  for (Generation& g : generations_) {
    const std::size_t dead = options.test == AgingTest::haber ? invalidate(g, eye, options.delta, tested)
                                                              : removeChanged(g, eye, options.delta);
    if (dead > 0) compact(g);
  }
  return {size_, before - size_};
}

void SampleCache::dropGenerations(std::uint64_t olderThan) {
  while (!generations_.empty() && generations_.front().age < olderThan) {
    for (PagePtr& page : generations_.front().pages) releasePage(std::move(page));
    generations_.pop_front();
  }
}

/// By id, a bit for each level whose samples are tested: that of the paper's l0, all where no level has nMin
/// samples.
std::vector<std::uint8_t> SampleCache::testedLevels(int nMin) const {
  std::vector<std::uint8_t> tested(counts_.size(), 0xff);
  for (std::size_t id = 0; id < counts_.size(); ++id) {
    for (int level = kMaxLevel; level >= 1; --level) {
      const std::uint32_t n = counts_[id][static_cast<std::size_t>(level)];
      if (n > 0 && n >= static_cast<std::uint32_t>(nMin)) tested[id] = static_cast<std::uint8_t>(1u << level);
    }
  }
  return tested;
}

/// Marks as dead the samples that are expected to have changed by more than delta; their number.
std::size_t SampleCache::removeChanged(Generation& g, const core::Vec3& eye, float delta) {
  std::size_t dead = 0;
  for (const PagePtr& page : g.pages) {
    Page& p = *page;
    alignas(32) float squared[Page::kCapacity];  // of the expected change
    for (int i = 0; i < p.count; ++i) {
      const float x = eye.x - p.px[i], y = eye.y - p.py[i], z = eye.z - p.pz[i];
      const float scale = 1 / std::sqrt(x * x + y * y + z * z);
      const float dx = x * scale - p.vx[i], dy = y * scale - p.vy[i], dz = z * scale - p.vz[i];
      squared[i] = p.changeRate[i] * p.changeRate[i] * (dx * dx + dy * dy + dz * dz);
    }
    for (int i = 0; i < p.count; ++i) {
      if (squared[i] <= delta * delta) continue;  // an eye on the sample gives NaN: invalid
      forget(p, i);
      p.level[i] = 0;
      ++dead;
    }
  }
  return dead;
}

/// Marks as dead the samples of those objects that fail the test in this generation; their number.
std::size_t SampleCache::invalidate(Generation& g, const core::Vec3& eye, float delta,
                                    const std::vector<std::uint8_t>& tested) {
  total_.assign(counts_.size(), 0);
  invalid_.assign(counts_.size(), 0);
  for (const PagePtr& page : g.pages) {
    const Page& p = *page;
    for (int i = 0; i < p.count; ++i) {
      if (!(tested[p.id[i]] >> p.level[i] & 1)) continue;
      const core::Vec3 v = eye - p.position(i);
      const float cosNew = (p.nx[i] * v.x + p.ny[i] * v.y + p.nz[i] * v.z) / std::sqrt(glm::dot(v, v));
      ++total_[p.id[i]];
      // An eye on the sample has no direction: NaN, invalid.
      if (!(std::abs(cosNew - p.cosView[i]) <= delta)) ++invalid_[p.id[i]];
    }
  }
  std::size_t dead = 0;
  for (std::size_t id = 0; id < total_.size(); ++id) dead += 2 * std::uint64_t{invalid_[id]} > total_[id];
  if (dead == 0) return 0;
  dead = 0;
  for (const PagePtr& page : g.pages) {
    for (int i = 0; i < page->count; ++i) {
      const std::uint32_t id = page->id[i];
      if (2 * std::uint64_t{invalid_[id]} <= total_[id]) continue;
      forget(*page, i);
      page->level[i] = 0;
      ++dead;
    }
  }
  return dead;
}

/// Removes dead samples: the generation's last ones move into their places.
void SampleCache::compact(Generation& g) {
  for (std::size_t p = 0; p < g.pages.size(); ++p) {
    Page& page = *g.pages[p];
    for (int i = 0; i < page.count; ++i) {
      if (page.level[i] != 0) continue;
      dropDeadEnd(g);
      if (p >= g.pages.size() || i >= page.count) break;
      Page& last = *g.pages.back();
      page.arrival[i] = last.arrival[last.count - 1];
      page.set(i, last.get(--last.count));
      g.inOrder = false;
    }
  }
  dropDeadEnd(g);
}

/// Takes dead samples off a generation's end, and pages that are empty then.
void SampleCache::dropDeadEnd(Generation& g) {
  while (!g.pages.empty()) {
    Page& last = *g.pages.back();
    while (last.count > 0 && last.level[last.count - 1] == 0) --last.count;
    if (last.count > 0) return;
    releasePage(std::move(g.pages.back()));
    g.pages.pop_back();
  }
}

SampleCache::WarpResult SampleCache::warp(const core::FrameSnapshot& frame, CorrectionLayer& layer) {
  WarpResult result;
  claimed_.assign(frame.depth.size(), 0);
  for (auto& list : visible_) list.clear();
  for (std::size_t i = generations_.size(); i-- > 0;) {
    if (generations_[i].age != frame.epoch) findVisible(generations_[i], frame, result);
  }
  // The picture does not depend on the order. Fine before coarse and young before old lets the layer pass
  // over whole tiles of the large splats.
  for (int level = kMaxLevel; level >= 1; --level) {
    const std::vector<Visible>& list = visible_[static_cast<std::size_t>(level)];
    for (std::size_t k = 0; k < list.size(); ++k) {
      if (k + kAhead < list.size()) layer.prefetch(list[k + kAhead].pixel);
      const Visible& v = list[k];
      const Page& p = *v.page;
      const auto i = static_cast<std::size_t>(v.slot);
      layer.splatWarped({p.correction[i], p.x[i], p.y[i], v.ageFrames, p.level[i], p.thread[i], v.footprint},
                        p.id[i], v.pixel);
    }
    result.splatted += list.size();
  }
  if (result.dropped > 0) {
    for (Generation& g : generations_) compact(g);
  }
  return result;
}

/// Projects and tests a generation, younger ones before; appends to visible_, marks what they make
/// superfluous.
void SampleCache::findVisible(Generation& g, const core::FrameSnapshot& frame, WarpResult& result) {
  const DepthTest depthTest(frame);
  const float focalGrowth = g.pixelsPerRadian > 0 ? pixelsPerRadianOf(frame.view) / g.pixelsPerRadian : 1;
  const auto ageFrames = static_cast<std::uint16_t>(std::min<std::uint64_t>(cameraAge_ - g.age, 0xffff));
  std::array<std::size_t, kMaxLevel + 1> first;
  for (std::size_t level = 0; level < first.size(); ++level) first[level] = visible_[level].size();

  std::array<Landing, Page::kCapacity> landings;
  for (const PagePtr& page : g.pages) {
    const int inside = projectPage(*page, frame, landings);
    result.offscreen += static_cast<std::size_t>(page->count - inside);
    for (int k = 0; k < inside; ++k) {
      const Landing& at = landings[static_cast<std::size_t>(k)];
      const std::uint8_t level = page->level[at.slot];
      const auto index = static_cast<std::size_t>(at.pixelIndex);
      if (static_cast<std::uint32_t>(frame.ids[index]) != page->id[at.slot] ||
          !depthTest.agrees(at.pixel, index, at.viewDepth)) {
        ++result.hidden;
      } else if (claimed_[index] != 0 && claimed_[index] <= level) {
        ++result.dropped;
        forget(*page, at.slot);
        page->level[at.slot] = 0;
      } else {
        const int side = scaledFootprint(level, page->viewDepth[at.slot] / at.viewDepth * focalGrowth);
        // Member by member: an aggregate built elsewhere and copied stalls on its own stores.
        Visible& v = visible_[level].emplace_back();
        v.page = page.get();
        v.pixel = at.pixel;
        v.pixelIndex = at.pixelIndex;
        v.ageFrames = ageFrames;
        v.slot = at.slot;
        v.footprint = static_cast<std::uint8_t>(side);
      }
    }
  }
  // Only now: samples of one age do not drop each other, or the picture would depend on their order.
  for (std::size_t level = 1; level < first.size(); ++level) {
    for (std::size_t v = first[level]; v < visible_[level].size(); ++v) {
      std::uint8_t& claim = claimed_[static_cast<std::size_t>(visible_[level][v].pixelIndex)];
      if (claim == 0 || level < claim) claim = static_cast<std::uint8_t>(level);
    }
  }
}

/// Where the samples of a page land; only those inside the image, their number. The pixels they will be
/// tested against are fetched meanwhile: neighbours of a coarse level never share a cache line.
int SampleCache::projectPage(const Page& page, const core::FrameSnapshot& frame,
                             std::array<Landing, Page::kCapacity>& landings) {
  alignas(32) float x[Page::kCapacity], y[Page::kCapacity], depth[Page::kCapacity];
  frame.view.project(page.px, page.py, page.pz, static_cast<std::size_t>(page.count), x, y, depth);
  const auto width = static_cast<float>(frame.view.width()), height = static_cast<float>(frame.view.height());
  const float zNear = frame.view.zNear();
  int inside = 0;
  for (int i = 0; i < page.count; ++i) {
    // Written so that NaN fails.
    if (!(depth[i] >= zNear && depth[i] <= kLargest)) continue;
    if (!(x[i] >= 0 && y[i] >= 0 && x[i] < width && y[i] < height)) continue;
    const std::size_t index = frame.index(static_cast<int>(x[i]), static_cast<int>(y[i]));
    __builtin_prefetch(&frame.ids[index]);
    __builtin_prefetch(&frame.depth[index]);
    Landing& at = landings[static_cast<std::size_t>(inside++)];
    at.pixel = {x[i], y[i]};
    at.viewDepth = depth[i];
    at.pixelIndex = static_cast<std::int32_t>(index);
    at.slot = static_cast<std::uint8_t>(i);
  }
  return inside;
}

}  // namespace saccade::render
