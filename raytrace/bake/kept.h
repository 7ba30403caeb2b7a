// Charts of an earlier bake whose texels stay as they are.
#pragma once

#include <vector>

#include "core/maps.h"

namespace saccade::raytrace {

struct KeptCharts {
  /// Where charts are kept, theirs are the same texels of the atlas, which may be larger now, and have
  /// another layer.
  const core::IlluminationMaps* previous = nullptr;
  std::vector<char> keep;  ///< by TexelMap::charts()
};

}  // namespace saccade::raytrace
