// Where the base layer draws: depth, IDs, culling, instances.
#include <glm/gtc/matrix_transform.hpp>

#include "core/scene/instances.h"
#include "tests/hard_case.h"
#include "tests/unit/render/base_layer_fixture.h"

namespace saccade::tests {
namespace {

using core::Scene;
using core::Vec3;
using core::View;

class BaseGeometry : public BaseLayer {};
SACCADE_EACH_CONTEXT(BaseGeometry);

TEST_P(BaseGeometry, RowZeroIsTheTopAndColumnZeroTheLeft) {
  Scene scene;
  scene.materials.push_back(lambert(Vec3(1)));
  addObject(scene, makeQuad({0.2f, 0.2f, -2}, {0.6f, 0, 0}, {0, 0.6f, 0}, 0, 5));  // up and to the right
  const auto frame = draw(scene);
  const core::PixelBox box = frame->extents[5].box;
  EXPECT_GE(box.x0, 16);
  EXPECT_LE(box.y1, 16);
  EXPECT_EQ(frame->extents[5].pixels, frame->nonDiffusePixels);
  EXPECT_GT(frame->nonDiffusePixels, 0u);
}

TEST_P(BaseGeometry, DepthIsTheDistanceAlongTheLineOfSight) {
  Scene scene;
  scene.materials.push_back(lambert(Vec3(1)));
  const Vec3 corner(-4, -3, -2), a(8, 0, -6), b(0, 6, 0);  // a slanted wall that fills the picture
  addObject(scene, makeQuad(corner, a, b));
  const auto frame = draw(scene, nullptr, 33, 21);
  const Vec3 normal = glm::normalize(glm::cross(a, b));
  int seen = 0;
  for (int y = 0; y < 21; ++y) {
    for (int x = 0; x < 33; ++x) {
      const float stored = frame->depth[frame->index(x, y)];
      if (stored == 0) continue;
      ++seen;
      const Vec3 direction = frame->view.direction({x + 0.5f, y + 0.5f});
      const float expected = glm::dot(normal, corner) / glm::dot(normal, direction);
      EXPECT_NEAR(frame->view.viewDepth(stored), expected, 1e-3f * expected) << x << ", " << y;
    }
  }
  EXPECT_GT(seen, 300);
}

/// Two walls across the line of sight, the farther one `gap` metres behind the nearer, which covers the left
/// half of it; the stride of a room before them.
Scene wallsAt(float distance, float gap) {
  Scene scene;
  scene.materials.push_back(lambert(Vec3(1)));
  const float wide = 2 * distance;
  addObject(scene, makeQuad({-wide, -wide, -distance}, {wide, 0, 0}, {0, 2 * wide, 0}, 0, 1));
  addObject(scene, makeQuad({-wide, -wide, -distance - gap}, {2 * wide, 0, 0}, {0, 2 * wide, 0}, 0, 2));
  addObject(scene, makeQuad({-1, -2, -3}, {2, 0, 0}, {0, 0.1f, 0}, 0, 3));
  return scene;
}

TEST_P(BaseGeometry, Hard23DepthAtOneKilometre) {
  // The near plane stands at 5 cm, closer than the case's 0.1. Depth runs from 1 to 0, so that a float's step
  // is the same share of it everywhere: matrix, projection, interpolation and storing cost a few.
  constexpr float kDistance = 1000;
  const Scene scene = wallsAt(kDistance, 0.01f);
  const auto frame = draw(scene, nullptr, 64, 64);
  HardCase near("near plane at 1 km", "m"), depth("depth at 1 km, near 0.05", "m"),
      wrong = HardCase::counting("pixels of the farther of two walls 1 cm apart at 1 km", "pixels");
  EXPECT_TRUE(near.within(frame->view.zNear(), 0.1));
  int behind = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const std::uint32_t id = frame->idAt(x, y);
      if (id == 3) continue;
      behind += id != (x < 32 ? 1u : 2u);
      const float truth = id == 1 ? kDistance : kDistance + 0.01f;
      EXPECT_TRUE(depth.near(frame->view.viewDepth(frame->depth[frame->index(x, y)]), truth,
                             8 * 0x1p-23 * kDistance));
    }
  }
  EXPECT_TRUE(wrong.within(behind, 0));
}

TEST_P(BaseGeometry, ThousandObjectsKeepTheirIds) {
  constexpr int kSide = 32;  // 1,024 objects
  Scene scene;
  scene.materials.push_back(lambert(Vec3(1)));
  const float cell = 2.0f / kSide;
  for (int i = 0; i < kSide * kSide; ++i) {
    const Vec3 corner(-1 + cell * (i % kSide), 1 - cell * (i / kSide + 1), -1);
    addObject(scene, makeQuad(corner, {cell, 0, 0}, {0, cell, 0}, 0, static_cast<std::uint32_t>(i + 1)));
  }
  core::Camera camera;
  camera.fovYDegrees = 90;
  const auto frame = draw(scene, nullptr, 4 * kSide, 4 * kSide, camera);
  ASSERT_EQ(frame->extents.size(), 1025u);
  for (int i = 0; i < kSide * kSide; ++i) {
    EXPECT_EQ(frame->idAt(4 * (i % kSide) + 2, 4 * (i / kSide) + 2), static_cast<std::uint32_t>(i + 1));
    EXPECT_EQ(frame->extents[static_cast<std::size_t>(i) + 1].pixels, 16u);
  }
}

TEST_P(BaseGeometry, LargeIdsAreExact) {
  constexpr std::uint32_t kLarge = (1u << 20) + 1;  // neither 16 bits nor a half float hold it
  const Scene scene = oneQuad(lambert(Vec3(1)), kLarge);
  render::BaseRenderer renderer(*context_, scene);
  EXPECT_EQ(renderer.render(View({}, 4, 4, scene.bounds), 1, kNMin)->idAt(2, 2), kLarge);
}

void addHierarchy(Scene& scene) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    scene.hierarchy.push_back({});
    scene.hierarchy.back().bounds = scene.objects[i].bounds;
    scene.hierarchy.back().object = static_cast<int>(i);
  }
  // Pairs, pairs of pairs, ... up to one root, which must stand first.
  std::vector<int> level(scene.hierarchy.size());
  for (std::size_t i = 0; i < level.size(); ++i) level[i] = static_cast<int>(i);
  while (level.size() > 1) {
    std::vector<int> above;
    for (std::size_t i = 0; i < level.size(); i += 2) {
      if (i + 1 == level.size()) {
        above.push_back(level[i]);
        continue;
      }
      core::HierarchyNode node;
      node.child[0] = level[i];
      node.child[1] = level[i + 1];
      node.bounds = scene.hierarchy[static_cast<std::size_t>(level[i])].bounds;
      node.bounds.add(scene.hierarchy[static_cast<std::size_t>(level[i + 1])].bounds);
      above.push_back(static_cast<int>(scene.hierarchy.size()));
      scene.hierarchy.push_back(node);
    }
    level = above;
  }
  const core::HierarchyNode root = scene.hierarchy.back();
  scene.hierarchy.insert(scene.hierarchy.begin(), root);
  for (core::HierarchyNode& node : scene.hierarchy) {
    for (int& child : node.child) child += child >= 0 ? 1 : 0;
  }
}

TEST_P(BaseGeometry, CullingLeavesTheImageAlone) {
  Scene open = surroundings(), culled = surroundings();
  addHierarchy(culled);
  for (core::Object& object : open.objects) object.closed = false;  // back faces drawn as well
  std::size_t outside = 0;
  for (int turn = 0; turn < 6; ++turn) {
    core::Camera camera;
    camera.eye = {0.3f * turn, 0.1f, -0.2f * turn};
    camera.at = camera.eye + Vec3(std::sin(1.1f * turn), 0.3f * (turn - 3), std::cos(1.1f * turn));
    const auto all = draw(open, nullptr, 48, 40, camera);
    EXPECT_EQ(stats_.objectsCulled, 0u);
    const auto some = draw(culled, nullptr, 48, 40, camera);
    outside += stats_.objectsCulled;
    EXPECT_EQ(stats_.objectsDrawn + stats_.objectsCulled, culled.objects.size());
    EXPECT_EQ(all->baseAndId, some->baseAndId) << "turn " << turn;
    EXPECT_EQ(all->depth, some->depth) << "turn " << turn;
  }
  EXPECT_GT(outside, 200u);
}

/// Boxes as instances of one mesh and light from the maps: turned, stretched, mirrored.
Scene instancedBoxes() {
  Scene scene;
  scene.materials = {lambert(Vec3(1)), lambert(Vec3(0.2f, 0.9f, 0.4f))};
  scene.materials[1].doubleSided = true;
  Thing box = makeBox(Vec3(-0.5f), Vec3(0.5f));
  box.mesh.instanced = true;
  scene.meshes.push_back(box.mesh);
  std::mt19937 random(6);
  std::uniform_real_distribution<float> place(-3, 3), size(-1.5f, 1.5f);
  for (int i = 0; i < 60; ++i) {
    core::Object o = box.object;
    o.material = i % 2;
    o.id = static_cast<std::uint32_t>(i + 1);
    o.meshToWorld = glm::translate(core::Mat4(1), Vec3(place(random), place(random), place(random) - 5)) *
                    glm::rotate(core::Mat4(1), static_cast<float>(i), Vec3(0.6f, 0, 0.8f)) *
                    glm::scale(core::Mat4(1), Vec3(size(random), size(random), 0.7f));
    o.lightmapScaleOffset = {0.25f, 0.5f, 0.25f * static_cast<float>(i % 4),
                             0.5f * static_cast<float>(i % 2)};
    o.bounds = {};
    for (const Vec3& p : box.mesh.positions) o.bounds.add(Vec3(o.meshToWorld * core::Vec4(p, 1)));
    scene.bounds.add(o.bounds);
    scene.objects.push_back(o);
  }
  return scene;
}

TEST_P(BaseGeometry, InstancesAreDrawnAsTheFlattenedSceneIs) {
  const Scene scene = instancedBoxes();
  Scene flat = scene;
  core::chooseInstances(flat, ~std::size_t{0});
  for (core::Object& o : flat.objects) {
    for (core::Vec2& uv : flat.meshOf(o).lightmapUv) uv = core::placeInAtlas(o.lightmapScaleOffset, uv);
    o.lightmapScaleOffset = {1, 1, 0, 0};
  }
  core::IlluminationMaps maps;
  maps.width = 4;
  maps.height = 2;
  maps.layers = 2;
  for (int i = 0; i < 4 * 2 * 2 * 3; ++i)
    maps.texels.push_back(glm::packHalf1x16(1 + 0.25f * static_cast<float>(i)));
  const auto a = draw(scene, &maps, 96, 96, {}), b = draw(flat, &maps, 96, 96, {});
  EXPECT_GT(b->nonDiffusePixels, 3000);
  int others = 0;
  for (std::size_t i = 0; i < a->baseAndId.size(); ++i) {
    const bool same = a->baseAndId[i].w == b->baseAndId[i].w && std::abs(a->depth[i] - b->depth[i]) < 1e-5f &&
                      glm::length(Vec3(a->baseAndId[i]) - Vec3(b->baseAndId[i])) < 0.02f;
    others += !same;  // an edge on this side of a pixel's centre or on that
  }
  EXPECT_LE(others, 10);
}

TEST_P(BaseGeometry, Hard27SolidAroundTheCameraShowsItsInside) {
  Scene scene;
  scene.materials.push_back(lambert(Vec3(1)));
  scene.materials[0].doubleSided = true;
  addObject(scene, makeBox(Vec3(-1), Vec3(1), 0, 9));
  const auto frame = draw(scene);
  HardCase open = HardCase::counting("pixels of a solid around the camera that do not show it", "pixels");
  EXPECT_TRUE(open.within(32.0 * 32 - frame->nonDiffusePixels, 0));
}

TEST_P(BaseGeometry, Hard27CameraOnASurfaceSeesWhatLiesBeyond) {
  // The eye lies in the quad that it looks along or through; both walls cover all of the picture.
  HardCase wrong =
      HardCase::counting("pixels seen from on a surface that are not of the wall beyond", "pixels");
  for (const bool through : {true, false}) {
    Scene scene;
    scene.materials.push_back(lambert(Vec3(1)));
    scene.materials[0].doubleSided = true;
    const Vec3 up(0, 1, 0), ahead(0, 0, 1), right(1, 0, 0);
    addObject(scene, makeQuad(-right - (through ? up : ahead), 2.0f * right,
                              through ? 2.0f * up : 2.0f * ahead, 0, 1));
    addObject(scene, makeQuad({-9, -9, -2}, {18, 0, 0}, {0, 18, 0}, 0, 2));
    const auto frame = draw(scene);
    EXPECT_TRUE(wrong.within(32.0 * 32 - frame->extents[2].pixels, 0)) << through;
  }
}

}  // namespace
}  // namespace saccade::tests
