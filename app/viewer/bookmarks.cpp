#include "app/viewer/bookmarks.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"

namespace saccade::app {

namespace {

using Json = nlohmann::ordered_json;

Json emptyFile() { return {{"version", 1}, {"scenes", Json::object()}}; }

[[noreturn]] void fail(const std::filesystem::path& file) {
  throw core::Error(file.string() + ": not a list of bookmarks; delete it or move it away");
}

Json readFile(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return emptyFile();
  const std::vector<std::uint8_t> bytes = core::readWholeFile(file);
  Json root = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
  if (!root.is_object() || root.value("version", 0) != 1 || !root.contains("scenes") ||
      !root["scenes"].is_object())
    fail(file);
  return root;
}

Json toJson(const core::Camera& c) {
  const auto list = [](const core::Vec3& v) { return Json{v.x, v.y, v.z}; };
  return {
      {"name", c.name}, {"eye", list(c.eye)}, {"at", list(c.at)}, {"up", list(c.up)}, {"fov", c.fovYDegrees}};
}

/// Throws Json::exception for another shape, core::Error for a camera that shows nothing.
core::Camera toCamera(const Json& object) {
  const auto vector = [&](const char* name) {
    const auto v = object.at(name).get<std::array<float, 3>>();
    return core::Vec3(v[0], v[1], v[2]);
  };
  core::Camera camera{object.at("name").get<std::string>(), vector("eye"), vector("at"), vector("up"),
                      object.at("fov").get<float>()};
  const core::View check(camera, 1, 1, {core::Vec3(-1), core::Vec3(1)});  // throws for a degenerate one
  return camera;
}

/// As given where the file system cannot tell more.
std::string nameOf(const std::filesystem::path& scene) {
  std::error_code failed;
  std::filesystem::path name = std::filesystem::absolute(scene, failed);
  if (!failed) name = std::filesystem::weakly_canonical(name, failed);
  return failed ? scene.string() : name.string();
}

}  // namespace

Bookmarks::Bookmarks(std::filesystem::path file, const std::filesystem::path& scene)
    : file_(std::move(file)), scene_(nameOf(scene)) {
  const Json root = readFile(file_);
  const auto found = root["scenes"].find(scene_);
  if (found == root["scenes"].end()) return;
  try {
    for (const Json& camera : *found) cameras_.push_back(toCamera(camera));
  } catch (const std::exception&) {
    fail(file_);
  }
}

void Bookmarks::add(const core::Camera& camera) {
  const auto taken = [this](const std::string& name) {
    return std::any_of(cameras_.begin(), cameras_.end(), [&](const auto& c) { return c.name == name; });
  };
  std::size_t number = cameras_.size() + 1;
  while (taken("place " + std::to_string(number))) ++number;
  cameras_.push_back(camera);
  cameras_.back().name = "place " + std::to_string(number);
  save();
}

void Bookmarks::set(std::size_t index, const core::Camera& camera) {
  std::string name = std::move(cameras_.at(index).name);
  cameras_[index] = camera;
  cameras_[index].name = std::move(name);
  save();
}

void Bookmarks::remove(std::size_t index) {
  cameras_.erase(cameras_.begin() + static_cast<std::ptrdiff_t>(index));
  save();
}

void Bookmarks::save() const {
  Json root = readFile(file_);
  Json list = Json::array();
  for (const core::Camera& camera : cameras_) list.push_back(toJson(camera));
  root["scenes"].erase(scene_);
  if (!list.empty()) root["scenes"][scene_] = std::move(list);
  std::error_code failed;
  std::filesystem::create_directories(file_.parent_path(), failed);  // else the writing says why
  // File names need not be UTF-8, JSON must: such a scene's are not found again.
  const std::string text = root.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
  core::writeFileAtomically(file_, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace saccade::app
