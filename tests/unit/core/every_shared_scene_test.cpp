// Every scene of the shared folder loads, with the warnings that are known and no others, right side out.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/scene/load.h"
#include "tests/shared_folder.h"

namespace saccade::core {
namespace {

namespace fs = std::filesystem;

/// Beginnings or parts of the warnings a file gives besides those about the default camera and light.
const std::map<std::string, std::vector<std::string>> kWarnings = {
    {"conference.obj", {"Both `d` and `Tr`", "more such lines from the OBJ parser"}},
    {"CornellBox-Sphere.obj", {"Both `d` and `Tr`"}},
    {"chess-board_undraco.glb", {"3 triangles were dropped"}},
    {"garage.glb", {"4 triangles were dropped"}},
    {"home-theater.glb", {"10 triangles were dropped"}},
    {"MetalRoughSpheresNoTextures.glb", {"2 triangles were dropped"}},
    {"Cameras.gltf", {"1 cameras are orthographic"}},
    {"ClearCoatTest.glb", {"1 primitives lack the tangents"}},
    {"SheenChair.glb", {"KHR_materials_variants is not supported"}},
    {"TransmissionTest.glb", {"KHR_xmp is not supported"}},
};

std::vector<fs::path> allScenes() {
  std::vector<fs::path> out;
  std::error_code none;
  for (fs::recursive_directory_iterator at(tests::sharedFolder() / "scenes", none), end; !none && at != end;
       at.increment(none)) {
    const std::string extension = at->path().extension().string();
    if (extension == ".glb" || extension == ".gltf" || extension == ".obj") out.push_back(at->path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

bool expected(const std::string& file, const std::string& warning) {
  const auto contains = [&](const std::string& part) { return warning.find(part) != std::string::npos; };
  if (contains("the default camera frames it") || contains("a default light panel was added")) return true;
  const auto known = kWarnings.find(file);
  return known != kWarnings.end() && std::any_of(known->second.begin(), known->second.end(), contains);
}

/// Six times the volume that a watertight mesh encloses: positive when its fronts are outside.
double signedVolume(const Mesh& mesh) {
  const glm::dvec3 origin(mesh.positions[mesh.indices[0]]);
  double sum = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::dvec3 a = glm::dvec3(mesh.positions[mesh.indices[i]]) - origin,
                     b = glm::dvec3(mesh.positions[mesh.indices[i + 1]]) - origin,
                     c = glm::dvec3(mesh.positions[mesh.indices[i + 2]]) - origin;
    sum += glm::dot(a, glm::cross(b, c));
  }
  return sum;
}

TEST(EverySharedScene, LoadsWithKnownWarningsRightSideOut) {
  const std::vector<fs::path> scenes = allScenes();
  if (scenes.empty()) GTEST_SKIP() << "no scenes in " << tests::sharedFolder() << " (set SACCADE_SHARED)";
  std::size_t closed = 0;
  for (const fs::path& file : scenes) {
    SCOPED_TRACE(file.string());
    LoadOptions options;
    if (file.filename() == "conference.obj") options.unitScale = 0.003f;
    Scene scene;
    ASSERT_NO_THROW(scene = loadScene(file, options));
    for (const std::string& warning : scene.warnings)
      EXPECT_TRUE(expected(file.filename().string(), warning)) << warning;
    EXPECT_GT(scene.triangleCount(), 0u);
    EXPECT_NO_THROW(View(scene.cameras.at(0), 64, 64, scene.bounds));
    for (const Object& object : scene.objects) {
      if (!object.closed) continue;
      ++closed;
      EXPECT_GT(signedVolume(scene.meshOf(object)), 0) << object.name;
    }
  }
  EXPECT_GT(closed, 100u);
}

}  // namespace
}  // namespace saccade::core
