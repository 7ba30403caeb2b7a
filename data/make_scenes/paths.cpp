// Walks through the bundled scenes, sampled twice a second from smooth curves; a viewer interpolates.
#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "core/atomic_file.h"
#include "data/make_scenes/scenes.h"

namespace saccade::data {
namespace {

constexpr double kKeySeconds = 0.5;

/// `cameraAt` takes t in [0, 1].
CameraPath sampled(double seconds, const std::function<core::Camera(float t)>& cameraAt) {
  CameraPath path;
  const int keys = static_cast<int>(std::lround(seconds / kKeySeconds));
  for (int k = 0; k <= keys; ++k)
    path.push_back({k * kKeySeconds, cameraAt(static_cast<float>(k) / static_cast<float>(keys))});
  return path;
}

/// Catmull-Rom through evenly timed stations.
Vec3 along(const std::vector<Vec3>& stations, float t) {
  const auto last = static_cast<int>(stations.size()) - 1;
  const float at = t * static_cast<float>(last);
  const int i = std::min(static_cast<int>(at), last - 1);
  const auto station = [&](int k) { return stations[static_cast<std::size_t>(std::clamp(k, 0, last))]; };
  const float u = at - static_cast<float>(i);
  const Vec3 p0 = station(i - 1), p1 = station(i), p2 = station(i + 1), p3 = station(i + 2);
  return 0.5f * (2.f * p1 + u * (p2 - p0) + u * u * (2.f * p0 - 5.f * p1 + 4.f * p2 - p3) +
                 u * u * u * (3.f * (p1 - p2) + p3 - p0));
}

}  // namespace

CameraPath cornellPath() {
  return sampled(8, [](float t) {
    const float swing = std::sin(2 * core::kPi * t), near = 0.5f - 0.5f * std::cos(2 * core::kPi * t);
    return core::Camera{"",
                        {0.62f * swing, 1 - 0.3f * near, 2.9f - 1.1f * near},
                        {0.05f, 0.9f - 0.35f * near, 0},
                        {0, 1, 0},
                        50};
  });
}

CameraPath tablePath() {
  return sampled(9, [](float t) {
    const float angle = glm::radians(15 + 62 * std::sin(2 * core::kPi * t)),
                radius = 0.62f - 0.1f * std::sin(core::kPi * t);
    return core::Camera{
        "",
        {radius * std::sin(angle), 1.01f + 0.10f * std::sin(4 * core::kPi * t), radius * std::cos(angle)},
        {-0.005f, 0.825f, 0},
        {0, 1, 0},
        34};
  });
}

CameraPath galleryPath() {
  const std::vector<Vec3> eyes{{0.35f, 1.6f, 10.6f}, {0.2f, 1.6f, 9.0f},   {-0.5f, 1.6f, 7.2f},
                               {-0.9f, 1.6f, 5.6f},  {-0.9f, 1.6f, 4.2f},  {-1.5f, 1.6f, 2.6f},
                               {-1.75f, 1.6f, 0.9f}, {-1.3f, 1.6f, -0.8f}, {-0.9f, 1.6f, -2.3f}};
  const std::vector<Vec3> targets{{-0.1f, 1.25f, 0},   {-0.5f, 1.3f, 1.5f}, {-1.6f, 1.3f, 3.6f},
                                  {-1.0f, 1.1f, 1.2f}, {0.4f, 1.0f, 0.8f},  {0.5f, 1.1f, -1.6f},
                                  {0.3f, 1.2f, -4.0f}, {0.6f, 1.3f, -6.5f}, {0.1f, 1.5f, -9.0f}};
  return sampled(12, [&](float t) {
    return core::Camera{"", along(eyes, t), along(targets, t), {0, 1, 0}, 60};
  });
}

CameraPath wardPath() {
  return sampled(8, [](float t) {
    const float angle = glm::radians(38 * std::sin(2 * core::kPi * t)),
                radius = 1.75f - 0.45f * std::sin(4 * core::kPi * t);
    return core::Camera{
        "",
        {radius * std::sin(angle), 1.3f + 0.12f * std::cos(2 * core::kPi * t), radius * std::cos(angle)},
        {0, 0.92f, -0.1f},
        {0, 1, 0},
        46};
  });
}

void writePath(const std::filesystem::path& file, const CameraPath& path) {
  const auto tidy = [](float x) { return std::round(static_cast<double>(x) * 1e4) / 1e4; };
  const auto triple = [&](const Vec3& v) { return nlohmann::ordered_json{tidy(v.x), tidy(v.y), tidy(v.z)}; };
  std::string text = "[";
  for (const PathKey& key : path) {
    const nlohmann::ordered_json line{{"t", key.seconds},
                                      {"eye", triple(key.camera.eye)},
                                      {"at", triple(key.camera.at)},
                                      {"up", triple(key.camera.up)},
                                      {"fov", tidy(key.camera.fovYDegrees)}};
    text += (text.size() > 1 ? ",\n" : "\n") + line.dump();
  }
  text += "\n]\n";
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  core::writeFileAtomically(file, bytes);
}

}  // namespace saccade::data
