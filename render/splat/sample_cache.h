// The cache of corrective samples: reuse from camera to camera.
// Haber et al. 2001, "Perceptually Guided Corrective Splatting", section 4.5 and step 5 of section 4.1.
//
// Departure from the paper: not nested linked lists by object and level, but one generation per camera age,
// each a list of pages of 256 samples in structure-of-arrays order, with counts by object and level beside.
// Aging deletes by object and age, MAX_AGE and the memory bound delete whole ages: all of them the oldest end
// or one generation, and every pass reads memory in order.
//
// What leaves when the memory is used up: of the oldest age the samples that were traced last. The region
// queue hands out the most salient work first (priority, less with each level), so an age's samples
// arrive in the order of their salience; nothing else has to be told to the cache, and a replay drops the
// same.
//
// How it stays small at rest: nothing is warped while the camera stands, and the next warp drops a sample
// that lies on the same pixel (same object, visible) as a sample of a younger age whose level is the same or
// coarser: the younger one knows that point better and covers at least as much. A pixel thus keeps at most
// one age per level, in practice little more than one sample.
//
// Main thread only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "core/corrective/messages.h"
#include "render/splat/aging.h"
#include "render/splat/correction_layer.h"

namespace saccade::render {

class SampleCache {
 public:
  /// Keeps at most `maxBytes` of samples; less than one page (19 KiB) keeps nothing.
  explicit SampleCache(std::size_t maxBytes);

  struct AgingResult {
    std::size_t kept = 0, deleted = 0;
  };
  struct WarpResult {
    std::size_t splatted = 0;   ///< handed to the layer
    std::size_t offscreen = 0;  ///< behind the camera or outside the image; kept
    std::size_t hidden = 0;     ///< another object's pixel, or depth disagrees; kept
    std::size_t dropped = 0;    ///< a younger sample lies on the same pixel; deleted
  };

  /// The camera's age: 0 until the first call of age().
  std::uint64_t cameraAge() const { return cameraAge_; }

  /// Stores a batch traced for the camera of age `cameraAge` (<= cameraAge(); late batches are welcome). When
  /// the memory is used up the oldest samples leave, of one age those that arrived last; samples as old as
  /// the oldest stored are then refused. Samples that are not finite (core::isFinite) are ignored. Returns
  /// how many were stored.
  std::size_t add(const core::SampleBatch& batch, std::uint64_t cameraAge);

  /// Takes over samples of an earlier run: before the first age(), age by age, oldest first, with what
  /// forEachAge and forEach gave. The camera is of the last age given from then on. As add() otherwise.
  std::size_t restore(const core::SampleBatch& batch, std::uint64_t cameraAge, float pixelsPerRadian);

  /// Step 2 of the loop: to be called once for every new camera, the first included. Raises the camera age,
  /// then the paper's pseudo code. Two additions where the paper says nothing: v is normalised (fact 15), and
  /// all samples of an object none of whose levels has N_min of them are tested together. Or, in place of the
  /// paper's test, AgingTest::change: a sample leaves whose changeRate times the angle (its chord) by which
  /// the direction to the eye has turned since it was traced exceeds delta. Either leaves the same samples in
  /// whatever order they came.
  AgingResult age(const core::View& view, const AgingOptions& options);

  /// Step 5: projects all samples into the frame and splats the visible ones as placeholders; those traced
  /// for this very frame (its epoch is their camera's age) are exact and none of its business. A sample is
  /// visible if its object has the pixel it falls on and its view depth agrees with the depth buffer there:
  /// the difference is at most one pixel's footprint at that depth plus the change of depth of the buffer
  /// across the pixel in x and in y (fact 12). Footprints grow and shrink with the magnification, so that an
  /// object that comes nearer stays covered.
  WarpResult warp(const core::FrameSnapshot& frame, CorrectionLayer& layer);

  std::size_t size() const { return size_; }
  /// Samples that add() has ever stored. Between two cameras the cache changes with this number only.
  std::uint64_t stored() const { return stored_; }
  /// Memory of the pages, those kept for reuse included; <= maxBytes.
  std::size_t bytes() const { return allocatedPages_ * sizeof(Page); }
  /// Samples of an object's level.
  std::uint32_t count(std::uint32_t id, int level) const;
  void clear();

  /// Calls visit(std::uint64_t cameraAge, float pixelsPerRadian, std::size_t samples) for every age of which
  /// there are samples and for the camera's, oldest first. The second is the view's, at the image's centre.
  template <class Visit>
  void forEachAge(Visit&& visit) const {
    bool present = false;
    for (const Generation& g : generations_) {
      std::size_t samples = 0;
      for (const auto& page : g.pages) samples += static_cast<std::size_t>(page->count);
      present = g.age == cameraAge_;
      if (samples > 0 || present) visit(g.age, g.pixelsPerRadian, samples);
    }
    if (!present) visit(cameraAge_, pixelsPerRadian_, std::size_t{0});
  }

  /// Calls visit(const core::Sample&, std::uint64_t cameraAge) for every sample, oldest age first.
  template <class Visit>
  void forEach(Visit&& visit) const {
    for (const Generation& g : generations_) {
      for (const auto& page : g.pages) {
        for (int i = 0; i < page->count; ++i) visit(page->get(i), g.age);
      }
    }
  }

 private:
  struct Page {
    static constexpr int kCapacity = 256;
    float px[kCapacity], py[kCapacity], pz[kCapacity];
    float nx[kCapacity], ny[kCapacity], nz[kCapacity];
    float cosView[kCapacity];
    float viewDepth[kCapacity];
    float vx[kCapacity], vy[kCapacity], vz[kCapacity];  ///< toEye
    float changeRate[kCapacity];
    std::uint32_t id[kCapacity];
    core::Vec3 correction[kCapacity];
    std::uint16_t x[kCapacity], y[kCapacity];
    std::uint8_t level[kCapacity];  ///< 0 = dead, removed by the next compact()
    std::uint8_t thread[kCapacity];
    bool fromDepth[kCapacity];
    std::uint32_t arrival[kCapacity];  ///< number within the age
    int count = 0;

    core::Vec3 position(int i) const { return {px[i], py[i], pz[i]}; }
    void set(int i, const core::Sample& s);
    core::Sample get(int i) const;
  };
  using PagePtr = std::unique_ptr<Page>;

  /// All samples of one camera age. All pages but the last are full.
  struct Generation {
    std::uint64_t age = 0;
    float pixelsPerRadian = 0;  ///< of the view it was traced in, at the image's centre
    std::vector<PagePtr> pages;
    std::uint32_t arrivals = 0;  ///< so far
    bool inOrder = true;         ///< the samples lie in the order of their arrival
  };

  /// Where a sample falls in a new image.
  struct Landing {
    core::Vec2 pixel;
    float viewDepth;
    std::int32_t pixelIndex;
    std::uint8_t slot;
  };
  /// A sample that passed the tests of a warp.
  struct Visible {
    const Page* page;
    core::Vec2 pixel;
    std::int32_t pixelIndex;
    std::uint16_t ageFrames;
    std::uint8_t slot;
    std::uint8_t footprint;
  };

  Generation& generation(std::uint64_t age);
  PagePtr takePage(std::uint64_t forAge);
  void dropPageOfOldest();
  static void sortByArrival(Generation& g);
  void releasePage(PagePtr page);
  void forget(const Page& page, int slot) { --counts_[page.id[slot]][page.level[slot]], --size_; }
  void dropGenerations(std::uint64_t olderThan);
  std::vector<std::uint8_t> testedLevels(int nMin) const;
  std::size_t removeChanged(Generation& g, const core::Vec3& eye, float delta);
  std::size_t invalidate(Generation& g, const core::Vec3& eye, float delta,
                         const std::vector<std::uint8_t>& tested);
  void compact(Generation& g);
  void dropDeadEnd(Generation& g);
  static int projectPage(const Page& page, const core::FrameSnapshot& frame,
                         std::array<Landing, Page::kCapacity>& landings);
  void findVisible(Generation& g, const core::FrameSnapshot& frame, WarpResult& result);

  const std::size_t maxPages_;
  std::size_t allocatedPages_ = 0;
  std::size_t size_ = 0;
  std::uint64_t stored_ = 0;
  std::uint64_t cameraAge_ = 0;
  float pixelsPerRadian_ = 0;
  std::deque<Generation> generations_;  ///< oldest first
  std::vector<PagePtr> freePages_;
  /// By id and level; [0] unused.
  std::vector<std::array<std::uint32_t, core::Lattice::kMaxLevel + 1>> counts_;

  // Scratch of age() and warp(), kept to save allocations.
  std::vector<std::uint32_t> total_, invalid_;
  std::vector<std::uint8_t> claimed_;  ///< per pixel: coarsest level of a visible sample of a younger age
  std::array<std::vector<Visible>, core::Lattice::kMaxLevel + 1> visible_;
};

}  // namespace saccade::render
