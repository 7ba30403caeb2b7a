// Camera, and View: a camera at an image size, the one mapping that rasteriser and tracer share.
#pragma once

#include <optional>
#include <string>

#include "core/math/types.h"

namespace saccade::core {

/// Vertical field of view in degrees, (0, 180). Metres.
struct Camera {
  std::string name;
  Vec3 eye{0, 0, 0};
  Vec3 at{0, 0, -1};
  Vec3 up{0, 1, 0};
  float fovYDegrees = 60;

  /// Same picture: bit-identical eye, at, up and field of view (the name does not count).
  bool samePicture(const Camera& o) const {
    return eye == o.eye && at == o.at && up == o.up && fovYDegrees == o.fovYDegrees;
  }
};

/// Immutable; any thread may read it. The OpenGL image is stored row 0 first = top row: clip-space y points
/// down, so what is read back needs no flip (front faces are then clockwise in GL terms).
class View {
 public:
  View() = default;
  /// Throws core::Error for a degenerate camera (eye = at, up parallel to the line of sight, non-finite
  /// numbers, field of view outside (0, 180)). `scene` sets near and far planes.
  View(const Camera& camera, int width, int height, const Bounds& scene);

  const Camera& camera() const { return camera_; }
  int width() const { return width_; }
  int height() const { return height_; }
  float zNear() const { return zNear_; }
  float zFar() const { return zFar_; }
  /// World to clip space, y down, depth 1 (near) to 0 (far): a float is as precise there at any distance.
  const Mat4& viewProjection() const { return viewProjection_; }

  /// Direction through image position (pixels, +0.5 = centre), scaled so that its component along the line of
  /// sight is 1: eye + t * direction is the point at view depth t.
  Vec3 direction(Vec2 pixel) const;
  /// View depth (metres along the line of sight) of a depth-buffer value: 1 near, 0 far or nothing drawn.
  float viewDepth(float windowDepth) const;
  Vec3 unproject(Vec2 pixel, float windowDepth) const {
    return camera_.eye + viewDepth(windowDepth) * direction(pixel);
  }

  struct Projected {
    Vec2 pixel;       ///< image position, may lie outside the image
    float viewDepth;  ///< metres along the line of sight, > 0
  };
  /// Nothing for a point behind the near plane (w <= 0 included) or non-finite.
  std::optional<Projected> project(const Vec3& world) const;

  /// The same bits for `count` points at once, coordinate by coordinate, in as many vector lanes as there
  /// are. What project() gives nothing for has a view depth that is not in [zNear(), FLT_MAX] or a pixel that
  /// is not finite.
  void project(const float* x, const float* y, const float* z, std::size_t count, float* pixelX,
               float* pixelY, float* viewDepth) const;

 private:
  Camera camera_;
  int width_ = 0, height_ = 0;
  float zNear_ = 0, zFar_ = 0;
  Vec3 right_{1, 0, 0}, up_{0, 1, 0}, forward_{0, 0, -1};
  float tanHalfX_ = 0, tanHalfY_ = 0;
  Mat4 viewProjection_{1};
};

}  // namespace saccade::core
