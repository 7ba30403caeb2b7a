// Charts of an earlier bake whose texels stay as they are.
#pragma once

#include <vector>

#include "core/maps.h"

namespace saccade::raytrace {

struct KeptCharts {
  const core::IlluminationMaps* previous = nullptr;  ///< of the same charts, size and layers
  std::vector<char> keep;                            ///< by TexelMap::charts()
};

}  // namespace saccade::raytrace
