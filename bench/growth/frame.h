// The frame without tracing, at a size of one's own choice.
#pragma once

#include "bench/growth/ball_scene.h"
#include "bench/harness/child.h"

namespace saccade::bench {

struct FrameSize {
  BallScene scene;
  std::size_t samples = 50'000;  ///< cached
  int side = 512;                ///< of the square picture, pixels

  Arguments arguments() const;
  static FrameSize of(const Arguments& arguments);
};

/// Child job. UntracedPicture (bench/harness/untraced_frame.h); the camera moves a little before each frame.
/// Samples lie on the mirrors, most of them of the finest level, as a walk leaves them. Figures: STAGE,
/// STAGE_min, STAGE_max for age, draw, warp, composite and frame, ms over `frames` frames; bytes (peak of the
/// process: scene, OpenGL's copy, rays' trees, cache), scene_bytes (before OpenGL and the cache); triangles,
/// stored_triangles, objects, samples (those splatted in the last frame), pixels; build (s: scene, trees).
Figures frameWithoutTracing(const Arguments& arguments, const std::stop_token& stop);

}  // namespace saccade::bench
