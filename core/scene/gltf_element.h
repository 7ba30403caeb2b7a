// Typed, checked access to an element of a glTF file's JSON.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"

namespace saccade::core {

using Json = nlohmann::json;

/// An element of the file, for messages: "scene.glb: accessors[3]".
class Element {
 public:
  Element(const Json& json, std::string path) : json_(json), path_(std::move(path)) {}
  const Json& json() const { return json_; }
  const std::string& path() const { return path_; }
  [[noreturn]] void refuse(const std::string& rule) const { throw Error(path_ + ": " + rule); }

  bool has(const char* key) const { return json_.is_object() && json_.contains(key); }
  /// A member that must be an object; an array of things of one kind (absent: empty).
  Element member(const char* key) const;
  std::vector<Element> array(const char* key) const;
  /// Integer in [lo, hi]; numbers like 3.0 count as integers, as exporters write them.
  std::uint64_t integer(const char* key, std::uint64_t lo, std::uint64_t hi) const;
  std::uint64_t integerOr(const char* key, std::uint64_t otherwise, std::uint64_t lo, std::uint64_t hi) const;
  /// Index below `count`, naming what it points to.
  std::uint64_t index(const char* key, std::size_t count, const char* what) const;
  void optionalIndex(const char* key, std::size_t count, const char* what) const;
  std::string text(const char* key) const;
  /// Absent, or an array of exactly n numbers.
  void optionalNumbers(const char* key, std::size_t n) const;
  void optionalNumber(const char* key) const;

 private:
  const Json& json_;
  std::string path_;
};

/// A number that is a non-negative integer, 3.0 included.
std::optional<std::uint64_t> gltfInteger(const Json& v);

/// Size of an accessor component in bytes, 0 for a wrong type; number of components of "SCALAR".. "MAT4", 0
/// for a wrong name.
std::uint64_t gltfComponentBytes(std::uint64_t componentType);
std::uint64_t gltfComponents(const std::string& type);

}  // namespace saccade::core
