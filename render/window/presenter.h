// Puts a finished 8-bit image on the screen: upload, one quad. Compositing and tone mapping were done on the
// CPU (core/composite.h).
#pragma once

#include <memory>

#include "core/image.h"
#include "render/context/gl_context.h"

namespace saccade::render {

/// Framebuffer pixels, y down from the top.
struct PixelRect {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const PixelRect&) const = default;
};

/// The largest rectangle of the image's shape centred in `area`; the image's own size where it fits exactly.
/// Empty for an empty image or area. Any thread.
PixelRect letterbox(const PixelRect& area, int imageWidth, int imageHeight);

/// GL thread only, the destructor included.
class Presenter {
 public:
  explicit Presenter(GlContext& context);
  ~Presenter();

  /// Draws into the framebuffer bound now (the window's, or an OffscreenSurface), whose size is given: black,
  /// then the image letterboxed into `area`, one texel a pixel where the sizes agree, else filtered. An empty
  /// framebuffer (minimised window) draws nothing. Throws core::Error on GL errors.
  void present(const core::ImageRgba8& image, const PixelRect& area, int framebufferWidth,
               int framebufferHeight);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace saccade::render
