// The base layer (Haber 2001, section 4.1, steps 1 to 3): illumination maps and object IDs, drawn with OpenGL
// and read back.
//
// Target: one RGBA32F texture, RGB linear radiance, A the object ID as a float (exact to 2^24; design fact 4,
// in place of the 8-bit stencil buffer), and 32-bit float depth. View's clip space points down, so that row 0
// of what is read is the top row, and front faces are clockwise in GL's terms.
//
// Radiance: emission (front side, unless double-sided) + baseColor * texture * vertex colour
//   * (1 - metallic) * (1 - transmission) * baseDiffuseFactor / pi * irradiance
//   (core/scene/specular_albedo.h);
// alphaMode blend: times coverage; mask: nothing where coverage < cutoff; unlit: baseColor. Where nothing is
// drawn, the scene's environment shows (ID 0, depth 1), or black.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "core/camera.h"
#include "core/corrective/messages.h"
#include "core/maps.h"
#include "core/scene/scene.h"
#include "render/base/draw_list.h"
#include "render/context/gl_context.h"

namespace saccade::render {

/// What the last frame took.
struct DrawStats {
  std::size_t objectsDrawn = 0;
  std::size_t objectsCulled = 0;  ///< outside the frustum
  std::size_t triangles = 0;
  double drawSeconds = 0;     ///< submitting and rasterising, until GL has finished
  double readSeconds = 0;     ///< colour, ID and depth into main memory
  double measureSeconds = 0;  ///< core::measureExtents
};

/// GL thread only, the destructor included. Every function makes the context current.
class BaseRenderer {
 public:
  /// Uploads geometry and textures. `scene` must be charted already (applyCharts) where maps will be shown;
  /// it and the context must outlive the renderer. Throws core::Error: shader or upload failure.
  BaseRenderer(GlContext& context, const core::Scene& scene);
  ~BaseRenderer();

  /// Shows another bake of the same charts; the maps are copied. Null: irradiance pi everywhere, so that a
  /// white Lambertian surface has radiance 1.
  void setMaps(const core::IlluminationMaps* maps);

  /// Draws and reads back. The view's size may differ from frame to frame. Buffers of frames that nobody
  /// holds any more are reused; extents are measured with `nMin` (core::measureExtents). Throws core::Error:
  /// an empty size or one beyond the context's limits, GL errors, lost context.
  std::shared_ptr<core::FrameSnapshot> render(const core::View& view, std::uint64_t epoch, int nMin);

  /// The same without the objects whose entry in `hidden` is not 0 (by object; empty = none): what a light
  /// probe sees. Epoch 0, no extents; lastDraw() stays.
  core::FramePtr renderWithout(const core::View& view, std::span<const char> hidden);
  /// Raised by setMaps: what was derived from frames before shows other light.
  std::uint64_t mapsNumber() const;

  const DrawStats& lastDraw() const;

 private:
  friend class BaseUpload;
  struct State;
  explicit BaseRenderer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Makes a BaseRenderer in portions, most of them a few milliseconds long, so that a window can show frames
/// meanwhile. The longest are a large texture's mipmaps and what a software rasteriser compiles for a
/// program, which is done here and not in the first frame. GL thread only, the destructor included. Every
/// function makes the context current.
class BaseUpload {
 public:
  /// `list`: of the scene, charted for the maps (null: none). Scene and context must outlive the renderer,
  /// the maps this. Throws core::Error, also for what the context cannot take.
  BaseUpload(GlContext& context, const core::Scene& scene, DrawList list, const core::IlluminationMaps* maps);
  ~BaseUpload();
  /// Does one portion, and goes on until the time is up. Returns whether all is there. Throws core::Error:
  /// nothing comes of it then.
  bool goOn(std::chrono::steady_clock::time_point until);
  /// Once all is there: draws what one with the whole constructor and setMaps does. Nothing else may be
  /// called afterwards.
  std::unique_ptr<BaseRenderer> take();

 private:
  std::unique_ptr<BaseRenderer::State> state_;
};

}  // namespace saccade::render
