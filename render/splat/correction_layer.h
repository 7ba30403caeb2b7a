// The correction layer: what the samples of a frame add to its base, pixel by pixel.
// Haber et al. 2001, "Perceptually Guided Corrective Splatting", sections 4.1 (steps 5 and 6) and 4.3.
//
// Departure from the paper: splats are not drawn level by level by the graphics hardware. Samples arrive out
// of order (a level's last job may still be running when the next level is queued), so every pixel remembers
// the rank of what it shows and a splat only covers what ranks lower. The picture is a function of the set of
// samples, whatever their order. From the best:
//   1. an exact sample, at its own pixel;
//   2. the finer lattice level, of a warped sample the effective one (core/corrective/known_levels.h);
//   3. a sample traced for this frame before one warped from an older camera;
//   4. the nearer splat centre (Euclidean), then the centre of the smaller lattice index y * width + x;
//   5. (same centre) the younger sample, then the smaller lattice index of the pixel it was traced for.
// All of 1 to 5 but the last clause is one 31-bit integer a pixel, so that a row of eight pixels is one
// compare. The stencil test is a comparison with the frame's integer ids: any number of objects.
//
// Main thread only. No OpenGL: core/composite.h adds pixels() to the base in main memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/corrective/messages.h"

namespace saccade::render {

class CorrectionLayer {
 public:
  /// Largest side of a splat in pixels: that of lattice level 1.
  static constexpr int kMaxFootprint = 161;

  /// One accepted sample, as overlays see it.
  struct Splat {
    core::Vec3 correction{0};     ///< linear, signed
    std::int32_t x = 0, y = 0;    ///< pixel it was traced for (in its own frame)
    std::uint16_t ageFrames = 0;  ///< camera changes since it was traced; 0 = this frame
    std::uint8_t level = 0;       ///< lattice level it was traced at
    std::uint8_t thread = 0;      ///< tracer that made it
    std::uint8_t footprint = 1;   ///< side of the square it was splatted with, pixels
  };

  /// Begins a frame; every splat of the last one goes. The frame must not be null; it is kept alive.
  void beginFrame(core::FramePtr frame);

  /// Splats a sample that was traced for exactly this frame's epoch, with the footprint of its level, centred
  /// at (x, y), clipped to the image and to the pixels of its id. Its own pixel becomes exact. A second exact
  /// sample for a pixel is not counted again.
  void splat(const core::Sample& sample);

  /// Splats a sample of an older camera, a placeholder: never exact. `pixel` is where it lies in this image
  /// (pixel centres at +0.5; may lie outside: what overlaps the image is drawn). `warped.footprint` is an odd
  /// side in [1, kMaxFootprint]. The caller has tested mask and depth at the centre (fact 12).
  void splatWarped(const Splat& warped, std::uint32_t id, core::Vec2 pixel);

  /// Fetches what splatWarped will look at first for a centre inside the image.
  void prefetch(core::Vec2 pixel) const {
    const int x = static_cast<int>(pixel.x), y = static_cast<int>(pixel.y);
    const Tile& tile = tiles_[tileIndex(x, y)];
    const int i = inTile(x, y);
    __builtin_prefetch(&tile.rank[i]);
    __builtin_prefetch(&tile.id[i]);
    __builtin_prefetch(&tile.shown[i]);
  }

  const core::FramePtr& frame() const { return frame_; }
  int width() const { return width_; }
  int height() const { return height_; }

  /// Pixels that show an exact sample.
  std::uint32_t exactCount() const { return exactCount_; }
  /// Every non-diffuse pixel of the frame is exact. False before the first frame.
  bool converged() const { return frame_ && exactCount_ == frame_->nonDiffusePixels; }
  bool isExact(int x, int y) const;
  /// What a pixel shows, or null where nothing covers it. Valid until the next splat or beginFrame.
  const Splat* shownAt(int x, int y) const;
  /// Pixels that show any splat; one pass over the image.
  std::uint32_t coveredCount() const;
  /// width * height, row 0 = top: the level that ranks what a pixel shows, kMaxLevel + 1 where it is exact, 0
  /// where nothing covers it.
  std::vector<std::uint8_t> levels() const;

  /// The pixels on the mask that show no splat, by aligned blocks of 2 x 2. Tiles that are known to be
  /// covered are passed over: once all are, a call looks at no pixel.
  void listUncovered(std::vector<core::Pixel>& pixels);

  /// width * height corrections, RGB and w = 0, row 0 = top; zero where nothing covers. Brings the changed
  /// tiles up to date; the span is valid until the next call of a non-const function.
  std::span<const core::Vec4> pixels();

 private:
  static constexpr int kTile = 8;
  /// 8 x 8 pixels, so that a splat touches few cache lines and whole tiles that outrank it are passed over.
  struct alignas(64) Tile {
    std::int32_t rank[kTile * kTile];    ///< of what the pixel shows; see correction_layer.cpp
    std::uint32_t id[kTile * kTile];     ///< the mask; 0 outside the image
    std::uint32_t shown[kTile * kTile];  ///< index into splats_, valid where something is shown
  };
  /// Apart from the tiles, so that passing over many of them stays within the first-level cache.
  struct TileState {
    std::int32_t floor = 0;   ///< no rank in the tile is below this
    std::uint8_t visits = 0;  ///< splats into the tile since floor was taken
    bool changed = false;     ///< pixels_ does not yet show the tile
    bool lit = false;         ///< pixels_ is not zero in the tile
  };
  /// A splat on its way into the tiles.
  struct Stamp {
    std::int32_t base;  ///< rank without closeness
    std::uint32_t id;
    std::uint32_t splat;  ///< index into splats_
    int cx, cy;           ///< centre pixel
    int x0, y0, x1, y1;   ///< footprint clipped to the image, exclusive end
  };

  std::size_t tileIndex(int x, int y) const {
    return static_cast<std::size_t>(y / kTile) * tilesX_ + static_cast<std::size_t>(x / kTile);
  }
  static int inTile(int x, int y) { return (y % kTile) * kTile + x % kTile; }

  void loadMask(std::size_t tile, int tileX, int tileY);
  bool stampPixel(const Splat& splat, std::uint32_t id, int x, int y, std::int32_t base);
  bool stamp(const Splat& splat, std::uint32_t id, int cx, int cy, std::int32_t base);
  struct Stamped {
    bool reached, tied;
  };
  Stamped stampTile(const Stamp& s, std::size_t index, int tileX, int tileY);
  bool settleTies(const Stamp& s, const Splat& splat, std::size_t index, int tileX, int tileY);
  bool setExact(const Splat& splat, std::uint32_t id);
  static bool preferred(const Splat& a, const Splat& b);
  void resolveTile(std::size_t tile, int tileX, int tileY);

  core::FramePtr frame_;
  int width_ = 0, height_ = 0;
  int tilesX_ = 0, tilesY_ = 0;
  std::uint32_t exactCount_ = 0;
  std::vector<Tile> tiles_;
  std::vector<TileState> states_;
  std::vector<Splat> splats_;  ///< those that reached at least one pixel
  std::vector<core::Vec4> pixels_;
};

}  // namespace saccade::render
