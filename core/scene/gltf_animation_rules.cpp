// glTF 2.0, 3.11: what the animations of nodes must hold.
#include <cmath>
#include <set>

#include "core/scene/gltf_rules.h"

namespace saccade::core {
namespace {

constexpr float kUnitTolerance = 0.00769f;  ///< of a quaternion in 8-bit components

struct Sampler {
  const Element& element;
  const GltfAccessor& input;
  const GltfAccessor& output;
  bool cubic;
};

Sampler samplerOf(const Element& of, const std::vector<GltfAccessor>& accessors) {
  const Json& json = of.json();
  return {of, accessors[json["input"].get<std::size_t>()], accessors[json["output"].get<std::size_t>()],
          json.value("interpolation", "LINEAR") == "CUBICSPLINE"};
}

/// Why a channel is not played, or null if it is.
const char* whyLeftOut(const Element& target, const Json& nodes) {
  const std::string path = target.text("path");
  if (path == "weights") return "animation channels of morph targets were left out";
  if (path != "translation" && path != "rotation" && path != "scale")
    return "animation channels of properties other than node transforms were left out";
  if (!target.has("node")) return "animation channels without a node were left out";
  const Json& node = nodes[target.json()["node"].get<std::size_t>()];
  if (node.contains("matrix")) return "animation channels of nodes that have a matrix were left out";
  return nullptr;
}

/// Memory for the contents of a sampler's accessors while they are checked.
class Contents {
 public:
  Contents(const GltfAccessor& accessor, LoadBudget& budget, const std::string& what)
      : budget_(budget), bytes_(accessor.count * accessor.components * sizeof(float)) {
    budget.charge(bytes_, what);
    values = contentsOf(accessor);
  }
  Contents(const Contents&) = delete;
  Contents& operator=(const Contents&) = delete;
  ~Contents() { budget_.release(bytes_); }
  std::vector<float> values;

 private:
  LoadBudget& budget_;
  std::uint64_t bytes_;
};

/// Why the key times are of no use, or null if they are.
const char* inputFault(const Sampler& s, LoadBudget& budget) {
  if (s.input.componentType != 5126 || s.input.components != 1 || s.input.normalized)
    s.element.refuse("input must be float scalars");
  if (s.cubic && s.input.count < 2) s.element.refuse("CUBICSPLINE needs at least 2 keys");
  const Contents input(s.input, budget, s.element.path());
  float before = -1;
  for (const float t : input.values) {
    if (!std::isfinite(t) || t < 0)
      return "animation channels with a time that is negative or no number were left out";
    if (t <= before) return "animation channels whose times do not increase were left out";
    before = t;
  }
  return nullptr;
}

void checkQuaternions(const Sampler& s, const std::vector<float>& values, Repairs& repairs) {
  std::uint64_t off = 0;
  for (std::size_t i = 0; i + 3 < values.size(); i += 4) {
    if (s.cubic && i / 4 % 3 != 1) continue;  // in-tangent, value, out-tangent
    const float square = values[i] * values[i] + values[i + 1] * values[i + 1] +
                         values[i + 2] * values[i + 2] + values[i + 3] * values[i + 3];
    off += !(std::abs(std::sqrt(square) - 1) <= kUnitTolerance);
  }
  if (off > 0)
    repairs.add("animated rotations were not of unit length and are normalised", s.element.path(), off);
}

void checkOutput(const Sampler& s, const std::string& path, Repairs& repairs, LoadBudget& budget) {
  const bool rotation = path == "rotation";
  const bool integers =
      s.output.normalized && s.output.componentType >= 5120 && s.output.componentType <= 5123;
  if (s.output.components != (rotation ? 4u : 3u) ||
      !(s.output.componentType == 5126 || (rotation && integers)))
    s.element.refuse("output has the wrong type for " + path);
  const std::uint64_t expected = s.input.count * (s.cubic ? 3 : 1);
  if (s.output.count != expected)
    s.element.refuse("output has " + std::to_string(s.output.count) + " elements, must have " +
                     std::to_string(expected));
  const Contents output(s.output, budget, s.element.path());
  for (const float x : output.values)
    if (!std::isfinite(x)) s.element.refuse("output holds a number that is not finite");
  if (rotation) checkQuaternions(s, output.values, repairs);
}

/// Indices of the channels that stay.
std::vector<std::size_t> checkAnimation(const Element& animation, const Json& nodes,
                                        const std::vector<GltfAccessor>& accessors, Repairs& repairs,
                                        LoadBudget& budget) {
  const auto samplers = animation.array("samplers"), channels = animation.array("channels");
  std::vector<const char*> faults;
  faults.reserve(samplers.size());
  for (const Element& of : samplers) faults.push_back(inputFault(samplerOf(of, accessors), budget));
  std::vector<std::size_t> kept;
  std::set<std::pair<std::size_t, std::string>> targets;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const Element& channel = channels[i];
    budget.checkTime();
    const std::size_t sampled = channel.index("sampler", samplers.size(), "samplers");
    const Sampler sampler = samplerOf(samplers[sampled], accessors);
    const Element target = channel.member("target");
    const char* left = whyLeftOut(target, nodes);
    if (!left) left = faults[sampled];
    if (left) {
      repairs.add(left, channel.path());
      continue;
    }
    const std::string path = target.text("path");
    checkOutput(sampler, path, repairs, budget);
    if (targets.insert({target.json()["node"].get<std::size_t>(), path}).second) {
      kept.push_back(i);
    } else {
      repairs.add("animation channels with the target of an earlier one were left out", channel.path());
    }
  }
  return kept;
}

}  // namespace

void checkAnimations(Json& root, const std::string& file, const std::vector<GltfAccessor>& accessors,
                     Repairs& repairs, LoadBudget& budget) {
  const auto animations = Element(root, file).array("animations");
  static const Json kNone = Json::array();
  const Json& nodes = root.contains("nodes") ? root["nodes"] : kNone;
  Json kept = Json::array();
  for (const Element& animation : animations) {
    Json channels = Json::array();
    for (const std::size_t i : checkAnimation(animation, nodes, accessors, repairs, budget))
      channels.push_back(animation.json()["channels"][i]);
    if (channels.empty()) continue;
    kept.push_back(animation.json());
    kept.back()["channels"] = std::move(channels);
  }
  root.erase("animations");
  if (!kept.empty()) root["animations"] = std::move(kept);
}

}  // namespace saccade::core
