// The properties of glTF 2.0 and its extensions as tables: type, range and what they refer to.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "core/scene/gltf_element.h"
#include "core/scene/repairs.h"

namespace saccade::core {

struct ObjectRule;

/// One property of a glTF object. Absent is right unless `required`.
struct PropertyRule {
  enum class Kind {
    flag,
    text,
    texts,     ///< array of strings, none twice
    integer,   ///< in [lo, hi]
    number,    ///< finite in single precision, in [lo, hi], or (lo, hi] if `aboveLo`
    numbers,   ///< `items` of them, each in [lo, hi]; any number of them if items is 0
    index,     ///< into the file's array `of`
    indices,   ///< none twice
    object,    ///< see `object`
    objects,   ///< array of them
    indexMap,  ///< object whose values are indices into `of`
  };

  const char* name = nullptr;
  Kind kind = Kind::flag;
  bool required = false;
  bool aboveLo = false;
  bool zeroToo = false;  ///< 0 is right although below lo
  double lo = -std::numeric_limits<double>::infinity();
  double hi = std::numeric_limits<double>::infinity();
  std::size_t items = 0;
  const char* of = nullptr;
  const ObjectRule* object = nullptr;
  std::span<const char* const> oneOf;         ///< the only texts
  std::span<const std::uint64_t> oneOfThese;  ///< the only integers
  /// A value out of range is no breach but a repair, counted under this name: it is clamped, or dropped (so
  /// that the default holds) where the range is open or a list.
  const char* mended = nullptr;

  /// A changed copy. Defined ahead of its users: clang needs its body while it evaluates them.
  template <class Change>
  constexpr PropertyRule with(Change change) const {
    PropertyRule copy = *this;
    change(copy);
    return copy;
  }
  constexpr PropertyRule must() const {
    return with([](PropertyRule& r) { r.required = true; });
  }
  constexpr PropertyRule in(double from, double to) const {
    return with([=](PropertyRule& r) { r.lo = from, r.hi = to; });
  }
  constexpr PropertyRule atLeast(double from) const {
    return with([=](PropertyRule& r) { r.lo = from; });
  }
  constexpr PropertyRule above(double from) const {
    return with([=](PropertyRule& r) { r.lo = from, r.aboveLo = true; });
  }
  constexpr PropertyRule orZero() const {
    return with([](PropertyRule& r) { r.zeroToo = true; });
  }
  constexpr PropertyRule mend(const char* noun) const {
    return with([=](PropertyRule& r) { r.mended = noun; });
  }
};

/// Where extensions may stand; the same name elsewhere means nothing.
enum class Place { none, root, node, material, texture, textureInfo, primitive, channelTarget };

struct ObjectRule {
  std::span<const PropertyRule> properties;
  Place place = Place::none;
};

struct ExtensionRule {
  const char* name;
  ObjectRule object;
};

/// The root object of a glTF file (gltf_properties.cpp).
extern const ObjectRule kGltfRoot;
/// Texture references of materials and of their extensions.
extern const ObjectRule kTextureInfo, kNormalTextureInfo;
/// The extensions that this program knows at a place (gltf_extensions.cpp).
std::span<const ExtensionRule> extensionsAt(Place place);

/// Checks every property of `root` that the tables know and repairs, in place, what they call mendable.
/// Extension objects that are unknown or in the wrong place are taken out, `extensionsUsed` and
/// `extensionsRequired` lose repeated names. `file` starts the messages. Throws core::Error.
void checkSchema(Json& root, const std::string& file, Repairs& repairs);

}  // namespace saccade::core
