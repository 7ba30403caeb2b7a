// Animated node transforms at one time (glTF 2.0, 3.11 and appendix C).
#pragma once

#include <vector>

#include "core/scene/scene.h"
#include "core/scene/tinygltf.h"

namespace saccade::core {

enum class Interpolation { step, linear, cubicSpline };

/// The keys of one property of one node. Times are seconds, >= 0, strictly increasing, at least one. A key
/// has `width` values, three times as many for cubicSpline: in-tangent, value, out-tangent. All finite.
struct AnimationTrack {
  Interpolation interpolation = Interpolation::linear;
  int width = 3;  ///< 3: translation or scale; 4: rotation, a quaternion x, y, z, w
  std::vector<float> times, values;
};

/// The property at `seconds`, the first key's value before it, the last key's after it; w = 0 for width 3.
/// Rotations need not be of unit length: linear ones are (along the shorter arc) when their keys are not
/// zero, the others are left for the caller to normalise. Any thread.
glm::dvec4 sampleTrack(const AnimationTrack& track, double seconds);

/// Gives the nodes of a model behind the gate the translations, rotations and scales that all its animations,
/// played together, have at `seconds`. A property that several animations move follows the first (counted in
/// `warnings`). Returns what the file's animations are.
std::vector<Animation> poseNodes(tinygltf::Model& model, double seconds, Warnings& warnings);

}  // namespace saccade::core
