#include "core/scene/median_edge.h"

#include <algorithm>
#include <vector>

namespace saccade::core {

double medianEdge(const Mesh& mesh) {
  std::vector<float> lengths;
  lengths.reserve(mesh.indices.size());
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
    lengths.push_back(glm::distance(mesh.positions[mesh.indices[i]], mesh.positions[mesh.indices[next]]));
  }
  if (lengths.empty()) return 0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return static_cast<double>(*middle);
}

}  // namespace saccade::core
