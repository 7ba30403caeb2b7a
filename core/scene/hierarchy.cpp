#include "core/scene/hierarchy.h"

#include <algorithm>
#include <span>

namespace saccade::core {
namespace {

/// Objects of one material, or parts of that; at the top, items are whole materials.
struct Item {
  Bounds bounds;
  std::vector<int> objects;
};

void sortAlongLongestAxis(std::span<Item> items) {
  Bounds centers;
  for (const Item& i : items) centers.add(i.bounds.center());
  const Vec3 extent = centers.extent();
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  std::sort(items.begin(), items.end(), [axis](const Item& a, const Item& b) {
    const float ca = a.bounds.center()[axis], cb = b.bounds.center()[axis];
    return ca != cb ? ca < cb : a.objects.front() < b.objects.front();
  });
}

class Builder {
 public:
  explicit Builder(const std::vector<Object>& objects) : objects_(objects) {}

  int build(std::span<Item> items) {
    const int at = static_cast<int>(nodes_.size());
    nodes_.emplace_back();
    for (const Item& i : items) nodes_.back().bounds.add(i.bounds);
    if (items.size() == 1 && items[0].objects.size() == 1) {
      nodes_.back().object = items[0].objects[0];
      return at;
    }
    std::vector<Item> single;
    if (items.size() == 1) {
      for (const int o : items[0].objects)
        single.push_back({objects_[static_cast<std::size_t>(o)].bounds, {o}});
      items = single;
    }
    sortAlongLongestAxis(items);
    const int left = build(items.subspan(0, items.size() / 2));
    const int right = build(items.subspan(items.size() / 2));
    nodes_[static_cast<std::size_t>(at)].child[0] = left;
    nodes_[static_cast<std::size_t>(at)].child[1] = right;
    return at;
  }

  std::vector<HierarchyNode> take() { return std::move(nodes_); }

 private:
  const std::vector<Object>& objects_;
  std::vector<HierarchyNode> nodes_;
};

}  // namespace

std::vector<HierarchyNode> buildHierarchy(const std::vector<Object>& objects) {
  if (objects.empty()) return {};
  std::vector<Item> materials;
  for (std::size_t o = 0; o < objects.size(); ++o) {
    const auto m = static_cast<std::size_t>(objects[o].material);
    if (materials.size() <= m) materials.resize(m + 1);
    materials[m].bounds.add(objects[o].bounds);
    materials[m].objects.push_back(static_cast<int>(o));
  }
  std::erase_if(materials, [](const Item& i) { return i.objects.empty(); });
  Builder builder(objects);
  builder.build(materials);
  return builder.take();
}

}  // namespace saccade::core
