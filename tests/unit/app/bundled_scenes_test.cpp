// What the bundled scenes promise (data/README.md), counted in what the viewer draws.
#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "core/scene/load.h"
#include "tests/unit/app/fixtures.h"

namespace saccade {
namespace {

core::FramePtr firstFrame(const app::Workspace& workspace) {
  app::Headless gl(tests::runOn("osmesa"), workspace);
  return gl.renderer->render(core::View(workspace.scene.cameras[0], 512, 512, workspace.scene.bounds), 1, 10);
}

int visibleIds(const core::FrameSnapshot& frame) {
  int n = 0;
  for (const core::ObjectExtent& extent : frame.extents) n += extent.pixels > 0 ? 1 : 0;
  return n;
}

TEST(BundledScenes, GalleryIsAMuseumHallFullOfWhatIsNotDiffuse) {
  const app::Workspace& workspace = tests::workspaceOf(tests::bundled("gallery.glb"));
  EXPECT_GE(workspace.scene.triangleCount(), 88000u);
  EXPECT_GE(workspace.scene.textures.size(), 100u);
  const core::FramePtr frame = firstFrame(workspace);
  EXPECT_GE(visibleIds(*frame), 60);
  EXPECT_GE(frame->nonDiffusePixels, 512u * 512u / 5);
}

TEST(BundledScenes, CornellHasAMirrorAGlassAndAGlossyObject) {
  const app::Workspace& workspace = tests::workspaceOf(tests::bundled("cornell.glb"));
  EXPECT_EQ(visibleIds(*firstFrame(workspace)), 3);
  EXPECT_TRUE(workspace.plan.refraction);
  EXPECT_TRUE(workspace.plan.glossy);
}

TEST(BundledScenes, TableCarriesTwoGlassesAndAMug) {
  const app::Workspace& workspace = tests::workspaceOf(tests::bundled("table.glb"));
  EXPECT_EQ(visibleIds(*firstFrame(workspace)), 3);
  int closedGlasses = 0;
  for (const core::Object& object : workspace.scene.objects) {
    const core::Material& material = workspace.scene.materials[static_cast<std::size_t>(object.material)];
    closedGlasses += material.transmission > 0 && object.closed ? 1 : 0;
  }
  EXPECT_EQ(closedGlasses, 2);
}

TEST(BundledScenes, WardHoldsLobesOfManyWidths) {
  const core::Scene scene = core::loadScene(tests::bundled("ward.glb"), {});
  EXPECT_TRUE(scene.warnings.empty());
  std::set<std::pair<float, float>> widths;
  int isotropic = 0, along = 0, across = 0;
  for (const core::Object& object : scene.objects) {
    const core::Material& material = scene.materials[static_cast<std::size_t>(object.material)];
    if (!material.ward) continue;
    const auto [it, isNew] = widths.emplace(material.ward->alphaX, material.ward->alphaY);
    isotropic += it->first == it->second;
    along += it->first < it->second;
    across += it->first > it->second;
    EXPECT_EQ(scene.meshOf(object).tangents.empty(), it->first == it->second) << object.name;
  }
  EXPECT_EQ(widths.size(), 7u);
  EXPECT_GE(isotropic, 2);
  EXPECT_GE(along, 2);
  EXPECT_GE(across, 1);
}

}  // namespace
}  // namespace saccade
