#include "core/scene/gltf_animation.h"

#include <algorithm>
#include <glm/gtc/quaternion.hpp>
#include <set>
#include <utility>

#include "core/scene/gltf_accessors.h"

namespace saccade::core {
namespace {

using glm::dvec4;

/// One of a key's parts (cubicSpline: 0 in-tangent, 1 value, 2 out-tangent; else only 0, the value).
dvec4 partOf(const AnimationTrack& track, std::size_t key, std::size_t part) {
  const std::size_t parts = track.interpolation == Interpolation::cubicSpline ? 3 : 1;
  const auto width = static_cast<std::size_t>(track.width);
  dvec4 out(0);
  for (std::size_t c = 0; c < width; ++c)
    out[static_cast<int>(c)] = track.values[(key * parts + part) * width + c];
  return out;
}

dvec4 valueOf(const AnimationTrack& track, std::size_t key) {
  return partOf(track, key, track.interpolation == Interpolation::cubicSpline ? 1 : 0);
}

dvec4 slerp(const dvec4& from, const dvec4& to, double share) {
  const auto unit = [](const dvec4& q) {
    const double length = glm::length(q);
    const dvec4 v = length > 0 ? q / length : dvec4(0, 0, 0, 1);
    return glm::dquat(v.w, v.x, v.y, v.z);
  };
  const glm::dquat q = glm::slerp(unit(from), unit(to), share);  // by the shorter arc
  return {q.x, q.y, q.z, q.w};
}

/// Appendix C.5: tangents are per second, so they grow with the time between the keys.
dvec4 hermite(const AnimationTrack& track, std::size_t key, double share, double seconds) {
  const double t = share, t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * partOf(track, key, 1) + seconds * (t3 - 2 * t2 + t) * partOf(track, key, 2) +
         (3 * t2 - 2 * t3) * partOf(track, key + 1, 1) + seconds * (t3 - t2) * partOf(track, key + 1, 0);
}

Interpolation interpolationOf(const std::string& name) {
  if (name == "STEP") return Interpolation::step;
  return name == "CUBICSPLINE" ? Interpolation::cubicSpline : Interpolation::linear;
}

void pose(tinygltf::Node& node, const std::string& path, const dvec4& value) {
  if (path == "rotation") {
    node.rotation = {value.x, value.y, value.z, value.w};
  } else {
    (path == "scale" ? node.scale : node.translation) = {value.x, value.y, value.z};
  }
}

}  // namespace

dvec4 sampleTrack(const AnimationTrack& track, double seconds) {
  const auto after = std::upper_bound(track.times.begin(), track.times.end(), seconds);
  if (after == track.times.begin()) return valueOf(track, 0);
  const auto key = static_cast<std::size_t>(after - track.times.begin()) - 1;
  if (after == track.times.end() || track.interpolation == Interpolation::step) return valueOf(track, key);
  const double from = track.times[key], length = track.times[key + 1] - from,
               share = (seconds - from) / length;
  if (track.interpolation == Interpolation::cubicSpline) return hermite(track, key, share, length);
  if (track.width == 4) return slerp(valueOf(track, key), valueOf(track, key + 1), share);
  return glm::mix(valueOf(track, key), valueOf(track, key + 1), share);
}

std::vector<Animation> poseNodes(tinygltf::Model& model, double seconds, Warnings& warnings) {
  std::vector<Animation> out;
  std::set<std::pair<int, std::string>> posed;
  int twice = 0;
  for (const tinygltf::Animation& from : model.animations) {
    Animation animation{from.name, 0};
    for (const tinygltf::AnimationChannel& channel : from.channels) {
      const auto& sampler = from.samplers[static_cast<std::size_t>(channel.sampler)];
      const AnimationTrack track{interpolationOf(sampler.interpolation),
                                 channel.target_path == "rotation" ? 4 : 3, readFloats(model, sampler.input),
                                 readFloats(model, sampler.output)};
      animation.lastSeconds = std::max(animation.lastSeconds, static_cast<double>(track.times.back()));
      if (posed.insert({channel.target_node, channel.target_path}).second) {
        pose(model.nodes[static_cast<std::size_t>(channel.target_node)], channel.target_path,
             sampleTrack(track, seconds));
      } else {
        ++twice;
      }
    }
    out.push_back(std::move(animation));
  }
  if (twice > 0)
    warnings.push_back(std::to_string(twice) +
                       " animation channels move what an earlier animation moves and were left out");
  return out;
}

}  // namespace saccade::core
