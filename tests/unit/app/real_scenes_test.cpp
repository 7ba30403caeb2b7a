// Other people's scenes load, bake and walk.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/session/camera_path.h"
#include "tests/unit/app/fixtures.h"

namespace saccade {
namespace {

struct RealScene {
  const char* file;
  float unitScale;
  bool corrections;  ///< something in it is not diffuse
};

void PrintTo(const RealScene& s, std::ostream* os) { *os << s.file; }

class RealScenes : public testing::TestWithParam<RealScene> {};

TEST_P(RealScenes, LoadBakeAndWalk) {
  SACCADE_SHARED_FILE(file, GetParam().file);
  const app::Workspace& workspace = tests::workspaceOf(file, GetParam().unitScale);
  app::Headless gl(tests::runOn("osmesa"), workspace);
  app::FrameLoop loop(workspace, *gl.renderer, {.threads = 0});
  const app::CameraPath path = app::CameraPath::orbit(workspace.scene.cameras[0], 12);
  for (int i = 0; i < 4; ++i) {
    loop.step(path.at(i / 25.0), {160, 120}, app::FrameBudget::untilDeadline(std::chrono::milliseconds(4)));
  }
  EXPECT_EQ(loop.stats().samplesTraced > 0, GetParam().corrections);
  const core::ImageRgb picture = loop.linear();
  int lit = 0;
  for (const core::Vec3& pixel : picture.pixels()) {
    ASSERT_TRUE(std::isfinite(pixel.x) && std::isfinite(pixel.y) && std::isfinite(pixel.z));
    lit += core::luminance(pixel) > 1e-3f ? 1 : 0;
  }
  EXPECT_GT(lit, 160 * 120 / 50);
}

INSTANTIATE_TEST_SUITE_P(Shared, RealScenes,
                         testing::Values(RealScene{"scenes/cornell/CornellBox-Original.obj", 1, false},
                                         RealScene{"scenes/cornell/CornellBox-Mirror.obj", 1, true},
                                         RealScene{"scenes/cornell/CornellBox-Sphere.obj", 1, true},
                                         RealScene{"scenes/conference/conference.obj", 0.003f, true},
                                         RealScene{"scenes/rooms/vr-gallery.glb", 1, false},
                                         RealScene{"scenes/rooms/glass-table.glb", 1, true},
                                         RealScene{"references/cycles/cornell_glossy.glb", 1, true}));

}  // namespace
}  // namespace saccade
