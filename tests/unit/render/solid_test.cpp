#include "render/base/solid.h"

#include <algorithm>

#include "scene_fixture.h"

namespace saccade::tests {
namespace {

using core::Vec3;

core::Mesh turnedInsideOut(core::Mesh mesh) {
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
  return mesh;
}

core::Mesh together(core::Mesh a, const core::Mesh& b) {
  const auto base = static_cast<std::uint32_t>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (std::uint32_t index : b.indices) a.indices.push_back(base + index);
  return a;
}

TEST(Solid, BoxFacingOutwardsAnywhere) {
  const Vec3 far(1e5f, -3e5f, 2e5f);  // the volume's products would cancel at the origin of the world
  EXPECT_TRUE(render::isOutwardSolid(makeBox(Vec3(-1), Vec3(1)).mesh));
  EXPECT_TRUE(render::isOutwardSolid(makeBox(far, far + Vec3(1)).mesh));
}

TEST(Solid, RoomFacingInwardsIsNone) {
  EXPECT_FALSE(render::isOutwardSolid(turnedInsideOut(makeBox(Vec3(-1), Vec3(1)).mesh)));
}

TEST(Solid, EveryPartCounts) {
  const core::Mesh large = makeBox(Vec3(-9), Vec3(9)).mesh, small = makeBox(Vec3(20), Vec3(21)).mesh;
  EXPECT_TRUE(render::isOutwardSolid(together(large, small)));
  EXPECT_FALSE(render::isOutwardSolid(together(large, turnedInsideOut(small))));
}

TEST(Solid, HoleOrTurnedTriangleIsNone) {
  core::Mesh holed = makeBox(Vec3(-1), Vec3(1)).mesh;
  holed.indices.resize(holed.indices.size() - 3);
  EXPECT_FALSE(render::isOutwardSolid(holed));
  core::Mesh turned = makeBox(Vec3(-1), Vec3(1)).mesh;
  std::swap(turned.indices[0], turned.indices[1]);
  EXPECT_FALSE(render::isOutwardSolid(turned));
  EXPECT_FALSE(render::isOutwardSolid({}));
}

}  // namespace
}  // namespace saccade::tests
