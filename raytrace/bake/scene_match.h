// Which objects of a scene were there before, as another state of it remembers them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "core/scene_state.h"

namespace saccade::raytrace {

struct SceneMatch {
  static constexpr std::int32_t kNone = -1;
  std::vector<std::int32_t> before;  ///< by object: the earlier one of the same shape in the same place
  std::vector<char> sameLook;        ///< by object: that one had the same material, emission factors apart
  std::vector<std::uint32_t> gone;   ///< earlier objects without one now

  /// Nothing but lights differs, and the order of objects is the same.
  bool sameObjects() const;
};

/// Objects that are alike are matched in their order.
SceneMatch matchScenes(const core::SceneState& now, const core::SceneState& before);

/// What a person would call the changes of objects: "NAME (moved)", "(new)", "(material)", "(gone)". An
/// object that changed its shape counts as moved.
std::vector<std::string> namesOfChanges(const SceneMatch& match, const core::SceneState& now,
                                        const core::SceneState& before);

}  // namespace saccade::raytrace
