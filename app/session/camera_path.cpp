#include "app/session/camera_path.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"

namespace saccade::app {

namespace {

using Json = nlohmann::json;

[[noreturn]] void fail(const std::filesystem::path& file, std::size_t key, const std::string& rule) {
  throw core::Error(
      file.string() + ": key " + std::to_string(key) + ": " + rule +
      "; a key reads {\"t\": 0, \"eye\": [0,1.6,3], \"at\": [0,1,0], \"up\": [0,1,0], \"fov\": 60}");
}

core::Vec3 readVec3(const std::filesystem::path& file, std::size_t key, const Json& object,
                    const char* name) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_array() || found->size() != 3)
    fail(file, key, std::string(name) + " needs 3 numbers");
  core::Vec3 v;
  for (int i = 0; i < 3; ++i) {
    const Json& number = (*found)[static_cast<std::size_t>(i)];
    if (!number.is_number() || !std::isfinite(number.get<float>()))
      fail(file, key, std::string(name) + " needs finite numbers");
    v[i] = number.get<float>();
  }
  return v;
}

double readNumber(const std::filesystem::path& file, std::size_t key, const Json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_number() || !std::isfinite(found->get<double>())) {
    fail(file, key, std::string(name) + " needs a finite number");
  }
  return found->get<double>();
}

CameraKey readKey(const std::filesystem::path& file, std::size_t index, const Json& object) {
  if (!object.is_object()) fail(file, index, "not an object");
  CameraKey key;
  key.seconds = readNumber(file, index, object, "t");
  key.camera.eye = readVec3(file, index, object, "eye");
  key.camera.at = readVec3(file, index, object, "at");
  if (object.contains("up")) key.camera.up = readVec3(file, index, object, "up");
  if (object.contains("fov"))
    key.camera.fovYDegrees = static_cast<float>(readNumber(file, index, object, "fov"));
  if (!(key.camera.fovYDegrees > 0 && key.camera.fovYDegrees < 180))
    fail(file, index, "fov must lie between 0 and 180");
  if (key.camera.eye == key.camera.at) fail(file, index, "eye and at are the same point");
  return key;
}

/// Catmull-Rom on non-uniform times: a cubic Hermite segment with finite-difference tangents.
template <class T>
T hermite(const T& p0, const T& p1, const T& m0, const T& m1, float s) {
  const float s2 = s * s, s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * p0 + (s3 - 2 * s2 + s) * m0 + (-2 * s3 + 3 * s2) * p1 + (s3 - s2) * m1;
}

template <class Get>
auto interpolate(const std::vector<CameraKey>& keys, std::size_t i, float s, Get get) {
  const double span = keys[i + 1].seconds - keys[i].seconds;
  const auto tangent = [&](std::size_t k) {
    const std::size_t before = k > 0 ? k - 1 : k, after = k + 1 < keys.size() ? k + 1 : k;
    const auto slope = static_cast<float>(span / (keys[after].seconds - keys[before].seconds));
    return (get(keys[after].camera) - get(keys[before].camera)) * slope;
  };
  return hermite(get(keys[i].camera), get(keys[i + 1].camera), tangent(i), tangent(i + 1), s);
}

}  // namespace

CameraPath CameraPath::read(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw core::Error(file.string() + ": cannot be read; check the name given to --path");
  const Json root = Json::parse(stream, nullptr, false);
  if (root.is_discarded()) throw core::Error(file.string() + ": not JSON");
  if (!root.is_array() || root.empty())
    throw core::Error(file.string() + ": expected a non-empty list of camera keys");
  std::vector<CameraKey> keys;
  for (std::size_t i = 0; i < root.size(); ++i) {
    keys.push_back(readKey(file, i, root[i]));
    if (i > 0 && keys[i].seconds <= keys[i - 1].seconds)
      fail(file, i, "t must be later than that of the key before");
  }
  return through(std::move(keys));
}

CameraPath CameraPath::orbit(const core::Camera& camera, double periodSeconds) {
  constexpr int kKeys = 64;  // the spline then leaves the circle by less than 1e-5 of its radius
  const core::Vec3 arm = camera.eye - camera.at;
  std::vector<CameraKey> keys;
  for (int i = -1; i <= kKeys + 1; ++i) {  // one beyond either end: the circle is closed
    const float angle = glm::two_pi<float>() * static_cast<float>(i) / kKeys;
    CameraKey key{periodSeconds * i / kKeys, camera};
    if (i != 0 && i != kKeys) {
      const float c = std::cos(angle), s = std::sin(angle);
      key.camera.eye = camera.at + core::Vec3(c * arm.x + s * arm.z, arm.y, c * arm.z - s * arm.x);
    }
    keys.push_back(key);
  }
  return {std::move(keys), 0, periodSeconds};
}

CameraPath CameraPath::through(std::vector<CameraKey> keys) {
  const double begin = keys.front().seconds, end = keys.back().seconds;
  return {std::move(keys), begin, end};
}

std::vector<CameraKey> CameraPath::keys() const {
  std::vector<CameraKey> inside;
  for (const CameraKey& key : keys_) {
    if (key.seconds >= begin_ && key.seconds <= end_) inside.push_back(key);
  }
  return inside;
}

CameraPath CameraPath::still(const core::Camera& camera) { return {{{0, camera}}, 0, 0}; }

core::Camera CameraPath::at(double seconds) const {
  seconds = std::clamp(seconds, begin_, end_);
  const auto after = std::upper_bound(keys_.begin(), keys_.end(), seconds,
                                      [](double t, const CameraKey& key) { return t < key.seconds; });
  const auto i = static_cast<std::size_t>(after - keys_.begin()) - 1;
  if (i + 1 == keys_.size()) return keys_.back().camera;
  const auto s = static_cast<float>((seconds - keys_[i].seconds) / (keys_[i + 1].seconds - keys_[i].seconds));
  if (s == 0) return keys_[i].camera;
  core::Camera camera = keys_[i].camera;
  camera.eye = interpolate(keys_, i, s, [](const core::Camera& c) { return c.eye; });
  camera.at = interpolate(keys_, i, s, [](const core::Camera& c) { return c.at; });
  camera.up = interpolate(keys_, i, s, [](const core::Camera& c) { return c.up; });
  camera.fovYDegrees =
      std::clamp(interpolate(keys_, i, s, [](const core::Camera& c) { return c.fovYDegrees; }), 0.1f, 179.9f);
  return camera;
}

void writeCameraPath(const std::filesystem::path& file, const std::vector<CameraKey>& keys) {
  Json root = Json::array();
  const auto list = [](const core::Vec3& v) { return Json{v.x, v.y, v.z}; };
  for (const CameraKey& key : keys) {
    const core::Camera& c = key.camera;
    root.push_back({{"t", key.seconds}, {"eye", list(c.eye)}, {"at", list(c.at)}, {"up", list(c.up)}});
    root.back()["fov"] = c.fovYDegrees;
  }
  std::string text = "[\n";
  for (const Json& key : root) text += (&key == &root.front() ? "" : ",\n") + key.dump();
  text += "\n]\n";
  core::writeFileAtomically(file, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

bool within(const PathTolerance& tolerance, const core::Camera& a, const core::Camera& b) {
  const core::Vec3 ahead = glm::normalize(a.at - a.eye), other = glm::normalize(b.at - b.eye);
  const float chord = 2 * std::sin(0.5f * tolerance.radians);
  return glm::length(a.eye - b.eye) <= tolerance.eyeMetres && glm::length(ahead - other) <= chord &&
         std::abs(a.fovYDegrees - b.fovYDegrees) <= tolerance.fovDegrees;
}

namespace {

/// Of the recorded keys between two that are kept, the middle one of those beyond the tolerance; `from` where
/// there is none. A middle one halves the work that is left, wherever the path strays most.
std::size_t middleBeyond(const std::vector<CameraKey>& recorded, const CameraPath& path,
                         const PathTolerance& tolerance, std::size_t from, std::size_t to) {
  std::vector<std::size_t> beyond;
  for (std::size_t i = from + 1; i < to; ++i) {
    if (!within(tolerance, path.at(recorded[i].seconds), recorded[i].camera)) beyond.push_back(i);
  }
  return beyond.empty() ? from : beyond[beyond.size() / 2];
}

std::vector<CameraKey> keysAt(const std::vector<CameraKey>& recorded, const std::vector<std::size_t>& kept) {
  std::vector<CameraKey> keys;
  keys.reserve(kept.size());
  for (const std::size_t i : kept) keys.push_back(recorded[i]);
  return keys;
}

}  // namespace

std::vector<CameraKey> thinned(const std::vector<CameraKey>& recorded, const PathTolerance& tolerance) {
  if (recorded.size() < 3) return recorded;
  std::vector<std::size_t> kept{0, recorded.size() - 1};
  for (std::size_t before = 0; before != kept.size();) {
    before = kept.size();
    const CameraPath path = CameraPath::through(keysAt(recorded, kept));
    std::vector<std::size_t> more;
    for (std::size_t k = 0; k + 1 < kept.size(); ++k) {
      more.push_back(kept[k]);
      const std::size_t middle = middleBeyond(recorded, path, tolerance, kept[k], kept[k + 1]);
      if (middle != kept[k]) more.push_back(middle);
    }
    more.push_back(kept.back());
    kept = std::move(more);
  }
  return keysAt(recorded, kept);
}

}  // namespace saccade::app
