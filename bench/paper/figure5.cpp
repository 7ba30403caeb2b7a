#include "bench/paper/figure5.h"

#include "bench/paper/lattice.h"
#include "render/splat/correction_layer.h"

namespace saccade::bench {
namespace {

constexpr int kSize = 150;  ///< side of the window
constexpr int kZoom = 3;
constexpr core::Rgba8 kBare{0, 0, 0, 255}, kCentre{255, 255, 255, 255};
/// Levels 1 to 3 as in the paper: red, blue, green.
constexpr core::Rgba8 kLevelColors[core::Lattice::kMaxLevel] = {
    {200, 40, 40, 255},  {50, 80, 200, 255},  {50, 160, 70, 255},  {225, 180, 40, 255},
    {150, 70, 170, 255}, {60, 180, 190, 255}, {130, 130, 130, 255}};

/// One object everywhere. Centres as far outside as the largest splat reaches are part of it.
std::shared_ptr<core::FrameSnapshot> endlessSurface(int side) {
  auto frame = std::make_shared<core::FrameSnapshot>();
  core::Bounds bounds;
  bounds.add(core::Vec3(-1));
  bounds.add(core::Vec3(1));
  frame->view = core::View(core::Camera{}, side, side, bounds);
  frame->baseAndId.assign(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), {0, 0, 0, 1});
  frame->depth.assign(frame->baseAndId.size(), 0.5f);
  core::measureExtents(*frame, 1, 1);
  return frame;
}

void splatLevel(render::CorrectionLayer& layer, int level) {
  const core::PixelBox all{0, 0, layer.width(), layer.height()};
  core::walkLattice(all, core::beginLevel(all, level), all.area(), true, [&](int x, int y) {
    core::Sample sample;
    sample.x = x, sample.y = y;
    sample.id = 1;
    sample.level = static_cast<std::uint8_t>(level);
    layer.splat(sample);
  });
}

}  // namespace

SplatPicture drawSplats(int size, int last, int zoom) {
  // A multiple of every level's period would not do: the window's place on the lattice is what the anchor at
  // pixel (0, 0) gives.
  constexpr int kMargin = render::CorrectionLayer::kMaxFootprint;
  render::CorrectionLayer layer;
  layer.beginFrame(endlessSurface(size + 2 * kMargin));
  for (int level = 1; level <= last; ++level) splatLevel(layer, level);
  SplatPicture picture{core::ImageRgba8(size * zoom, size * zoom)};
  for (int y = 0; y < size * zoom; ++y) {
    for (int x = 0; x < size * zoom; ++x) {
      const int px = kMargin + x / zoom, py = kMargin + y / zoom;
      const render::CorrectionLayer::Splat* shown = layer.shownAt(px, py);
      const bool exact = layer.isExact(px, py);
      picture.image.at(x, y) = exact ? kCentre : shown ? kLevelColors[shown->level - 1] : kBare;
      const bool first = x % zoom == 0 && y % zoom == 0;
      picture.bare += first && !shown;
      picture.samples += first && exact;
    }
  }
  return picture;
}

void drawFigure5(Session& session) {
  for (const int last : {1, 2, 3, 6}) {
    const SplatPicture picture = drawSplats(kSize, last, kZoom);
    const std::string name = "figure5-levels-1-" + std::to_string(last);
    Record record;
    record.key = "figures/splats-" + std::to_string(last);
    record.labels = {{"figure", "5"}, {"levels", last == 1 ? "1" : "1-" + std::to_string(last)}};
    record.values = {{"bare", Value::count(picture.bare, Better::lower)},
                     {"bare_papers_formula", Value::count(barePixels(kSize, last, papersSplatSide))},
                     {"samples", Value::count(picture.samples)}};
    record.files = {{"picture", session.picture(name, picture.image)}};
    session.add(std::move(record), nullptr);
  }
}

}  // namespace saccade::bench
