// Scenes in which light shows what a change of objects and lights does.
//
// Light adds up, lamp by lamp. With T the transport of light in a scene, what the lamps that did not change
// send elsewhere is T(now) - T(before) of them alone; the others' light is T(now) of what is new in them and
// T(before) of what is gone. Earlier objects that are no longer there are stood for by plain materials
// (core::plainMaterial), and so are objects that changed, in both scenes, so that they differ by the change
// alone.
#pragma once

#include "core/scene/scene.h"
#include "core/scene_state.h"
#include "raytrace/bake/scene_match.h"

namespace saccade::raytrace {

/// What the changes are found from. All must outlive it; `now` is charted.
struct ChangedScene {
  const core::Scene& now;
  const core::SceneState& stateNow;
  const core::SceneState& before;
  const SceneMatch& match;
};

/// The present objects with the earlier light of those that were there and did not move.
core::Scene sceneNow(const ChangedScene& change);
/// The earlier objects with the same light. The charts of what is still there are as in `now`; the rest has
/// none.
core::Scene sceneBefore(const ChangedScene& change);

/// The present objects, with only what is new or another in the lamps shining, by as much as it changed;
/// where objects are the same, what is gone too.
core::Scene newLight(const ChangedScene& change);
/// The earlier objects, with only what is gone shining. Where objects are the same: none.
core::Scene goneLight(const ChangedScene& change);

/// Names of the lights, and of the objects whose emission factor alone changed.
std::vector<std::string> namesOfLights(const ChangedScene& change);

}  // namespace saccade::raytrace
