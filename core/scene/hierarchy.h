// The object hierarchy: a binary tree, materials first, then nearness (Haber 2001, section 4.1).
#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace saccade::core {

/// [0] is the root; every object is exactly one leaf; children follow their parent. Empty without objects.
std::vector<HierarchyNode> buildHierarchy(const std::vector<Object>& objects);

}  // namespace saccade::core
