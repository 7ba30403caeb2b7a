// The object hierarchy covers each object once, holds its children, and groups by material.
#include "core/scene/hierarchy.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "tests/unit/core/scene_shapes.h"

namespace saccade::core {
namespace {

std::vector<Object> scattered(int count, int materials) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> where(-50, 50);
  std::vector<Object> out;
  for (int i = 0; i < count; ++i) {
    Object o;
    o.material = static_cast<int>(random() % static_cast<unsigned>(materials));
    const Vec3 at(where(random), where(random), where(random));
    o.bounds.add(at);
    o.bounds.add(at + Vec3(1));
    out.push_back(o);
  }
  return out;
}

std::multiset<int> leavesBelow(const std::vector<HierarchyNode>& tree, int at) {
  const HierarchyNode& n = tree[static_cast<std::size_t>(at)];
  if (n.object >= 0) return {n.object};
  std::multiset<int> all = leavesBelow(tree, n.child[0]);
  all.merge(leavesBelow(tree, n.child[1]));
  return all;
}

TEST(Hierarchy, CoversEveryObjectOnce) {
  for (const int count : {1, 2, 3, 17, 400}) {
    const auto objects = scattered(count, 7);
    const auto tree = buildHierarchy(objects);
    EXPECT_EQ(tree.size(), static_cast<std::size_t>(2 * count - 1));
    const auto leaves = leavesBelow(tree, 0);
    ASSERT_EQ(leaves.size(), objects.size());
    int expected = 0;
    for (const int leaf : leaves) EXPECT_EQ(leaf, expected++);
  }
  EXPECT_TRUE(buildHierarchy({}).empty());
}

TEST(Hierarchy, BoundsHoldWhatIsBelow) {
  const auto objects = scattered(150, 5);
  const auto tree = buildHierarchy(objects);
  for (const HierarchyNode& n : tree) {
    if (n.object >= 0) {
      EXPECT_EQ(n.bounds.lo, objects[static_cast<std::size_t>(n.object)].bounds.lo);
      continue;
    }
    for (const int c : n.child) {
      EXPECT_TRUE(n.bounds.contains(tree[static_cast<std::size_t>(c)].bounds.lo));
      EXPECT_TRUE(n.bounds.contains(tree[static_cast<std::size_t>(c)].bounds.hi));
    }
  }
}

TEST(Hierarchy, EveryMaterialHasItsSubtree) {
  const auto objects = scattered(200, 6);
  const auto tree = buildHierarchy(objects);
  std::set<std::multiset<int>> groups;
  for (std::size_t i = 0; i < tree.size(); ++i) groups.insert(leavesBelow(tree, static_cast<int>(i)));
  for (int m = 0; m < 6; ++m) {
    std::multiset<int> wanted;
    for (std::size_t o = 0; o < objects.size(); ++o)
      if (objects[o].material == m) wanted.insert(static_cast<int>(o));
    EXPECT_TRUE(groups.contains(wanted)) << m;
  }
}

}  // namespace
}  // namespace saccade::core
