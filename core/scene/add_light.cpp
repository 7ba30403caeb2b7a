// --light TYPE:key=value,...
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/defaults.h"
#include "core/scene/load.h"

namespace saccade::core {
namespace {

constexpr const char* kExamples =
    "; examples: point:pos=0,2,0,power=60,60,60  spot:pos=0,2,0,dir=0,-1,0,power=60,60,60,angle=40  "
    "directional:dir=0,-1,0.3,irradiance=3,3,3  panel:at=0,2.4,0,size=1,1,radiance=15,15,15";

/// key -> numbers. A comma either continues the numbers of a key or starts the next key=value.
class Fields {
 public:
  explicit Fields(const std::string& description) : description_(description) {
    const std::size_t colon = description.find(':');
    type_ = description.substr(0, colon);
    if (colon == std::string::npos) refuse("lacks ':'");
    std::string key;
    for (std::size_t at = colon + 1; at <= description.size();) {
      const std::size_t comma = std::min(description.find(',', at), description.size());
      std::string word = description.substr(at, comma - at);
      if (const std::size_t equals = word.find('='); equals != std::string::npos) {
        key = word.substr(0, equals);
        word = word.substr(equals + 1);
      }
      if (key.empty()) refuse("starts with a value that belongs to no key");
      values_[key].push_back(number(word));
      at = comma + 1;
    }
  }

  const std::string& type() const { return type_; }

  Vec3 vector(const std::string& key, const std::optional<Vec3>& otherwise = {}) {
    const auto v = take(key, otherwise.has_value());
    if (v.empty()) return otherwise.value_or(Vec3(0));
    if (v.size() == 1) return Vec3(v[0]);
    if (v.size() != 3) refuse("needs three numbers for " + key);
    return Vec3(v[0], v[1], v[2]);
  }
  Vec2 pair(const std::string& key) {
    const auto v = take(key, false);
    if (v.size() != 2) refuse("needs two numbers for " + key);
    return Vec2(v[0], v[1]);
  }
  float scalar(const std::string& key, float otherwise) {
    const auto v = take(key, true);
    if (v.empty()) return otherwise;
    if (v.size() != 1) refuse("needs one number for " + key);
    return v[0];
  }
  void finish() {
    if (!values_.empty()) refuse("has no use for '" + values_.begin()->first + "'");
  }
  [[noreturn]] void refuse(const std::string& why) const {
    throw UsageError("--light '" + description_ + "' " + why + kExamples);
  }

 private:
  float number(const std::string& word) const {
    char* end = nullptr;
    const float x = std::strtof(word.c_str(), &end);
    if (word.empty() || *end != '\0' || !std::isfinite(x)) refuse("holds '" + word + "', which is no number");
    return x;
  }
  std::vector<float> take(const std::string& key, bool optional) {
    const auto at = values_.find(key);
    if (at == values_.end() && !optional) refuse("lacks " + key + "=");
    if (at == values_.end()) return {};
    std::vector<float> out = std::move(at->second);
    values_.erase(at);
    return out;
  }

  std::string description_, type_;
  std::map<std::string, std::vector<float>> values_;
};

Vec3 unitDirection(Fields& fields, const std::optional<Vec3>& otherwise) {
  const Vec3 d = fields.vector("dir", otherwise);
  if (!(glm::length(d) > 0)) fields.refuse("has a direction of length 0");
  return glm::normalize(d);
}

}  // namespace

void addLight(Scene& scene, const std::string& description) {
  Fields fields(description);
  PunctualLight light;
  light.name = description;
  if (fields.type() == "panel") {
    const Vec3 at = fields.vector("at"), radiance = fields.vector("radiance");
    const Vec2 size = fields.pair("size");
    const Vec3 direction = unitDirection(fields, Vec3(0, -1, 0));
    fields.finish();
    if (!(size.x > 0 && size.y > 0)) fields.refuse("needs a size above 0");
    addPanel(scene, "panel light", at, size, direction, glm::max(radiance, Vec3(0)));
    return;
  }
  if (fields.type() == "point" || fields.type() == "spot") {
    light.position = fields.vector("pos");
    // Power in watts over the whole sphere; a spot keeps the intensity of the point light it is cut from.
    light.intensity = glm::max(fields.vector("power"), Vec3(0)) / (4 * kPi);
    if (fields.type() == "spot") {
      light.type = PunctualLight::Type::spot;
      light.direction = unitDirection(fields, {});
      const float outer = glm::radians(std::clamp(fields.scalar("angle", 45), 1.0f, 89.0f));
      light.cosOuter = std::cos(outer);
      light.cosInner = std::cos(0.8f * outer);
    }
  } else if (fields.type() == "directional") {
    light.type = PunctualLight::Type::directional;
    light.direction = unitDirection(fields, {});
    light.intensity = glm::max(fields.vector("irradiance"), Vec3(0));
  } else {
    fields.refuse("has an unknown type");
  }
  fields.finish();
  scene.lights.push_back(light);
}

}  // namespace saccade::core
