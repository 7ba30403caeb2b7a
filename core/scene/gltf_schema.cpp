#include "core/scene/gltf_schema.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace saccade::core {
namespace {

constexpr double kLargestFloat = std::numeric_limits<float>::max();

/// An object of the file with its name for messages.
struct Here {
  Json& json;
  std::string path;
  [[noreturn]] void refuse(const std::string& rule) const { throw Error(path + ": " + rule); }
  /// "FILE: a" below the file itself, "FILE: a.b" below an element.
  std::string below(const char* key) const {
    return path + (path.find(": ") == std::string::npos ? ": " : ".") + key;
  }
};

std::string quoted(const char* name) { return std::string("'") + name + "'"; }

class SchemaCheck {
 public:
  SchemaCheck(Json& root, Repairs& repairs) : root_(root), repairs_(repairs) {
    if (!root.contains("extensionsUsed") || !root["extensionsUsed"].is_array()) return;
    for (const Json& name : root["extensionsUsed"])
      if (name.is_string()) declared_.insert(name.get<std::string>());
  }

  void object(const Here& here, const ObjectRule& rule) {
    for (const PropertyRule& p : rule.properties) {
      if (here.json.contains(p.name)) {
        property(here, p);
      } else if (p.required) {
        here.refuse("lacks " + quoted(p.name));
      }
    }
    if (here.json.contains("extensions")) extensions(here, rule.place);
  }

 private:
  using Kind = PropertyRule::Kind;

  void property(const Here& here, const PropertyRule& p) {
    Json& value = here.json[p.name];
    if (value.is_null() && p.mended) return drop(here, p);  // NaN, which is no JSON, was read as null
    switch (p.kind) {
      case Kind::flag:
        if (!value.is_boolean()) here.refuse(quoted(p.name) + " must be true or false");
        break;
      case Kind::text:
        return textOf(here, p, value);
      case Kind::texts:
        return texts(here, p, value);
      case Kind::integer:
        return integer(here, p, value);
      case Kind::number:
        if (!number(here, p, value)) drop(here, p);
        break;
      case Kind::numbers:
        return numbers(here, p, value);
      case Kind::index:
        return reference(here, p, value, p.name);
      case Kind::indices:
        return indices(here, p, value);
      case Kind::indexMap:
        if (!value.is_object()) here.refuse(quoted(p.name) + " must be an object");
        for (auto& [key, entry] : value.items())
          reference(here, p, entry, (std::string(p.name) + "." + key).c_str());
        break;
      case Kind::object:
        if (!value.is_object()) here.refuse(quoted(p.name) + " must be an object");
        return object({value, here.below(p.name)}, *p.object);
      case Kind::objects:
        return objects(here, p, value);
    }
  }

  /// Takes a mendable property away, so that its default holds.
  void drop(const Here& here, const PropertyRule& p) {
    repairs_.add(p.mended, here.path);
    here.json.erase(p.name);
  }

  void textOf(const Here& here, const PropertyRule& p, const Json& value) {
    if (!value.is_string()) here.refuse(quoted(p.name) + " must be a string");
    const auto same = [&](const char* allowed) { return value.get_ref<const std::string&>() == allowed; };
    if (p.oneOf.empty() || std::any_of(p.oneOf.begin(), p.oneOf.end(), same)) return;
    if (p.mended) return drop(here, p);
    here.refuse(quoted(p.name) + " is " + value.dump() + ", which glTF does not know");
  }

  void texts(const Here& here, const PropertyRule& p, Json& value) {
    if (!value.is_array()) here.refuse(quoted(p.name) + " must be an array of names");
    std::set<std::string> seen;
    Json kept = Json::array();
    for (const Json& entry : value) {
      if (!entry.is_string()) here.refuse(quoted(p.name) + " must be an array of names");
      if (seen.insert(entry.get<std::string>()).second) kept.push_back(entry);
    }
    if (kept.size() < value.size())
      repairs_.add("names given twice were taken once", here.below(p.name), value.size() - kept.size());
    if (emptied(here, p, kept)) return;
    value = std::move(kept);
  }

  void integer(const Here& here, const PropertyRule& p, Json& value) {
    const auto whole = gltfInteger(value);
    if (whole && value.is_number_float()) {
      repairs_.add("integers were written with a fraction of 0 and taken as integers", here.path);
      value = *whole;
    }
    if (!p.oneOfThese.empty()) {
      if (whole && std::find(p.oneOfThese.begin(), p.oneOfThese.end(), *whole) != p.oneOfThese.end()) return;
      if (p.mended && value.is_number()) return drop(here, p);
      here.refuse(quoted(p.name) + " is " + value.dump() + ", which glTF does not know");
    }
    if (whole && static_cast<double>(*whole) >= p.lo && static_cast<double>(*whole) <= p.hi) return;
    here.refuse(quoted(p.name) + " is " + value.dump() + ", must be an integer from " +
                std::to_string(static_cast<std::uint64_t>(p.lo)) + " to " +
                std::to_string(static_cast<std::uint64_t>(p.hi)));
  }

  /// False: the value must be dropped. Refuses what is no number and what cannot be mended.
  bool number(const Here& here, const PropertyRule& p, Json& value) {
    if (!value.is_number()) here.refuse(quoted(p.name) + " must be a number");
    const double x = value.get<double>();
    if (p.zeroToo && x == 0) return true;
    const double lo = std::max(p.lo, -kLargestFloat), hi = std::min(p.hi, kLargestFloat);
    if ((p.aboveLo ? x > lo : x >= lo) && x <= hi) return true;
    if (!p.mended) here.refuse(quoted(p.name) + " is " + value.dump() + ", which is out of range");
    if (p.aboveLo && !(x > lo)) return false;
    repairs_.add(p.mended, here.path);
    value = std::clamp(x, lo, hi);
    return true;
  }

  void numbers(const Here& here, const PropertyRule& p, Json& value) {
    const auto isNumber = [](const Json& x) { return x.is_number(); };
    const bool anyLength = p.items == 0;
    if (!value.is_array() || !(anyLength || value.size() == p.items))
      here.refuse(quoted(p.name) + " must be " + (anyLength ? "an array of" : std::to_string(p.items)) +
                  " numbers");
    if (!std::all_of(value.begin(), value.end(), isNumber)) {
      const auto isNumberOrNull = [](const Json& x) { return x.is_number() || x.is_null(); };
      if (p.mended && std::all_of(value.begin(), value.end(), isNumberOrNull)) return drop(here, p);
      here.refuse(quoted(p.name) + " must be an array of numbers");
    }
    if (emptied(here, p, value)) return;
    for (Json& x : value) number(here, p, x);
  }

  void reference(const Here& here, const PropertyRule& p, Json& value, const char* name) {
    const std::size_t count = countOf(p.of);
    const auto whole = gltfInteger(value);
    if (!whole || *whole >= count)
      here.refuse(quoted(name) + " is " + value.dump() + ", but there are " + std::to_string(count) + " " +
                  p.of);
    value = *whole;
  }

  void indices(const Here& here, const PropertyRule& p, Json& value) {
    if (!value.is_array()) here.refuse(quoted(p.name) + " must be an array");
    if (emptied(here, p, value)) return;
    std::set<std::uint64_t> seen;
    for (Json& entry : value) {
      reference(here, p, entry, p.name);
      if (!seen.insert(entry.get<std::uint64_t>()).second)
        here.refuse(quoted(p.name) + " names " + entry.dump() + " twice");
    }
  }

  void objects(const Here& here, const PropertyRule& p, Json& value) {
    const std::string where = here.below(p.name);
    if (!value.is_array()) throw Error(where + ": must be an array");
    if (emptied(here, p, value)) return;
    for (std::size_t i = 0; i < value.size(); ++i) {
      const Here entry{value[i], where + "[" + std::to_string(i) + "]"};
      if (!entry.json.is_object()) entry.refuse("must be an object");
      object(entry, *p.object);
    }
  }

  /// Arrays must not be empty: a needed one is a breach, others are taken as absent.
  bool emptied(const Here& here, const PropertyRule& p, const Json& value) {
    if (!value.empty()) return false;
    if (p.required) here.refuse(quoted(p.name) + " must not be empty");
    repairs_.add("empty arrays were taken as absent", here.below(p.name));
    here.json.erase(p.name);
    return true;
  }

  void extensions(const Here& here, Place place) {
    Json& all = here.json["extensions"];
    if (!all.is_object()) here.refuse("'extensions' must be an object");
    const std::string where = here.below("extensions");
    for (auto at = all.begin(); at != all.end();) {
      const Here extension{at.value(), where + "." + at.key()};
      if (!extension.json.is_object()) extension.refuse("must be an object");
      if (!declared_.contains(at.key()))
        repairs_.add("extensions are used that 'extensionsUsed' does not name", extension.path);
      const ExtensionRule* rule = find(place, at.key());
      if (rule) {
        object(extension, rule->object);
        ++at;
        continue;
      }
      if (knownElsewhere(at.key()))
        repairs_.add("extensions in a place where they mean nothing were left out", extension.path);
      at = all.erase(at);
    }
  }

  static const ExtensionRule* find(Place place, const std::string& name) {
    for (const ExtensionRule& rule : extensionsAt(place))
      if (name == rule.name) return &rule;
    return nullptr;
  }
  static bool knownElsewhere(const std::string& name) {
    if (name == "KHR_mesh_quantization") return true;  // has no objects anywhere
    for (const Place place : {Place::root, Place::node, Place::material, Place::texture, Place::textureInfo,
                              Place::primitive, Place::channelTarget})
      if (find(place, name)) return true;
    return false;
  }

  std::size_t countOf(const char* key) const {
    const auto at = root_.find(key);
    return at != root_.end() && at->is_array() ? at->size() : 0;
  }

  Json& root_;
  Repairs& repairs_;
  std::set<std::string> declared_;
};

}  // namespace

void checkSchema(Json& root, const std::string& file, Repairs& repairs) {
  SchemaCheck(root, repairs).object({root, file}, kGltfRoot);
}

}  // namespace saccade::core
