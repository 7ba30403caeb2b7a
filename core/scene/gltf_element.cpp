#include "core/scene/gltf_element.h"

#include <algorithm>
#include <cmath>

namespace saccade::core {
namespace {

constexpr double kLargestExactInteger = 9007199254740992.0;  // 2^53

std::string childPath(const std::string& path, const char* key) {
  return path + (path.find(": ") == std::string::npos ? ": " : ".") + key;
}

}  // namespace

std::optional<std::uint64_t> gltfInteger(const Json& v) {
  if (v.is_number_unsigned()) return v.get<std::uint64_t>();
  if (!v.is_number_float()) return std::nullopt;  // negative integers are signed, not unsigned
  const double d = v.get<double>();
  if (!(d >= 0 && d <= kLargestExactInteger) || d != std::floor(d)) return std::nullopt;
  return static_cast<std::uint64_t>(d);
}

Element Element::member(const char* key) const {
  const std::string where = childPath(path_, key);
  if (!has(key)) throw Error(path_ + ": lacks '" + key + "'");
  const Json& child = json_[key];
  if (!child.is_object()) throw Error(where + ": must be an object");
  return Element(child, where);
}

std::vector<Element> Element::array(const char* key) const {
  std::vector<Element> out;
  if (!has(key)) return out;
  const Json& list = json_[key];
  const std::string where = childPath(path_, key);
  if (!list.is_array()) throw Error(where + ": must be an array");
  out.reserve(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    out.emplace_back(list[i], where + "[" + std::to_string(i) + "]");
    if (!list[i].is_object()) out.back().refuse("must be an object");
  }
  return out;
}

std::uint64_t Element::integer(const char* key, std::uint64_t lo, std::uint64_t hi) const {
  if (!has(key)) refuse(std::string("lacks '") + key + "'");
  const auto value = gltfInteger(json_[key]);
  if (!value || *value < lo || *value > hi)
    refuse(std::string("'") + key + "' is " + json_[key].dump() + ", must be an integer from " +
           std::to_string(lo) + " to " + std::to_string(hi));
  return *value;
}

std::uint64_t Element::integerOr(const char* key, std::uint64_t otherwise, std::uint64_t lo,
                                 std::uint64_t hi) const {
  return has(key) ? integer(key, lo, hi) : otherwise;
}

std::uint64_t Element::index(const char* key, std::size_t count, const char* what) const {
  if (!has(key)) refuse(std::string("lacks '") + key + "'");
  const auto value = gltfInteger(json_[key]);
  if (!value || *value >= count)
    refuse(std::string("'") + key + "' is " + json_[key].dump() + ", but there are " + std::to_string(count) +
           " " + what);
  return *value;
}

void Element::optionalIndex(const char* key, std::size_t count, const char* what) const {
  if (has(key)) index(key, count, what);
}

std::string Element::text(const char* key) const {
  if (!has(key) || !json_[key].is_string()) refuse(std::string("'") + key + "' must be a string");
  return json_[key].get<std::string>();
}

void Element::optionalNumber(const char* key) const {
  if (has(key) && !json_[key].is_number()) refuse(std::string("'") + key + "' must be a number");
}

void Element::optionalNumbers(const char* key, std::size_t n) const {
  if (!has(key)) return;
  const Json& list = json_[key];
  const bool good = list.is_array() && list.size() == n &&
                    std::all_of(list.begin(), list.end(), [](const Json& x) { return x.is_number(); });
  if (!good) refuse(std::string("'") + key + "' must be " + std::to_string(n) + " numbers");
}

std::uint64_t gltfComponentBytes(std::uint64_t componentType) {
  switch (componentType) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      return 0;
  }
}

std::uint64_t gltfComponents(const std::string& type) {
  static constexpr std::pair<const char*, std::uint64_t> kTypes[] = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
  for (const auto& [name, n] : kTypes)
    if (type == name) return n;
  return 0;
}

}  // namespace saccade::core
