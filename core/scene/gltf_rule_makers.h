// Short names for writing the property tables of gltf_properties.cpp and gltf_extensions.cpp.
#pragma once

#include "core/scene/gltf_schema.h"

namespace saccade::core::rules {

using Kind = PropertyRule::Kind;

constexpr PropertyRule property(const char* name, Kind kind) {
  PropertyRule rule;
  rule.name = name;
  rule.kind = kind;
  return rule;
}
constexpr PropertyRule flag(const char* name) { return property(name, Kind::flag); }
constexpr PropertyRule text(const char* name) { return property(name, Kind::text); }
constexpr PropertyRule texts(const char* name) { return property(name, Kind::texts); }
constexpr PropertyRule integer(const char* name) { return property(name, Kind::integer); }
constexpr PropertyRule number(const char* name) { return property(name, Kind::number); }
constexpr PropertyRule numbers(const char* name, std::size_t items) {
  PropertyRule rule = property(name, Kind::numbers);
  rule.items = items;
  return rule;
}
constexpr PropertyRule reference(const char* name, Kind kind, const char* of) {
  PropertyRule rule = property(name, kind);
  rule.of = of;
  return rule;
}
constexpr PropertyRule index(const char* name, const char* of) { return reference(name, Kind::index, of); }
constexpr PropertyRule indices(const char* name, const char* of) {
  return reference(name, Kind::indices, of);
}
constexpr PropertyRule indexMap(const char* name, const char* of) {
  return reference(name, Kind::indexMap, of);
}
constexpr PropertyRule object(const char* name, const ObjectRule& rule) {
  PropertyRule out = property(name, Kind::object);
  out.object = &rule;
  return out;
}
constexpr PropertyRule objects(const char* name, const ObjectRule& rule) {
  PropertyRule out = property(name, Kind::objects);
  out.object = &rule;
  return out;
}
constexpr PropertyRule oneOf(const char* name, std::span<const char* const> values) {
  PropertyRule rule = text(name);
  rule.oneOf = values;
  return rule;
}
constexpr PropertyRule oneOf(const char* name, std::span<const std::uint64_t> values) {
  PropertyRule rule = integer(name);
  rule.oneOfThese = values;
  return rule;
}

/// A texture reference.
constexpr PropertyRule texture(const char* name) { return object(name, kTextureInfo); }
constexpr double kLargestIndex = 2147483647.0;
constexpr PropertyRule kTexCoord = integer("texCoord").in(0, kLargestIndex);

constexpr const char* kMaterialFactors = "material factors out of range were clamped";
constexpr PropertyRule factor(const char* name) { return number(name).in(0, 1).mend(kMaterialFactors); }
constexpr PropertyRule color(const char* name) { return numbers(name, 3).in(0, 1).mend(kMaterialFactors); }

}  // namespace saccade::core::rules
