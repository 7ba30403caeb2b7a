#include "bench/growth/ball_scene.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <string>

#include "core/scene/load.h"

namespace saccade::bench {
namespace {

using core::Vec3;

constexpr int kFewestRings = 3;
constexpr float kRadius = 0.45f;  ///< in distances between balls
constexpr float kFovDegrees = 50;

/// Of radius kRadius about the origin: one vertex at each pole.
core::Mesh ballMesh(int rings) {
  core::Mesh mesh;
  mesh.instanced = true;
  const int segments = 2 * rings;
  const auto add = [&](float theta, float phi) {
    const Vec3 n(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
    mesh.normals.push_back(n);
    mesh.positions.push_back(kRadius * n);
  };
  const auto at = [&](int ring, int segment) {
    return static_cast<std::uint32_t>(1 + (ring - 1) * segments + segment % segments);
  };
  add(0, 0);
  for (int r = 1; r < rings; ++r) {
    for (int s = 0; s < segments; ++s)
      add(core::kPi * static_cast<float>(r) / static_cast<float>(rings),
          2 * core::kPi * static_cast<float>(s) / static_cast<float>(segments));
  }
  add(core::kPi, 0);
  const auto south = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  for (int s = 0; s < segments; ++s) {
    for (const std::uint32_t i : {0u, at(1, s + 1), at(1, s)}) mesh.indices.push_back(i);
    for (const std::uint32_t i : {south, at(rings - 1, s), at(rings - 1, s + 1)}) mesh.indices.push_back(i);
    for (int r = 1; r + 1 < rings; ++r) {
      for (const std::uint32_t i :
           {at(r, s), at(r, s + 1), at(r + 1, s), at(r, s + 1), at(r + 1, s + 1), at(r + 1, s)})
        mesh.indices.push_back(i);
    }
  }
  return mesh;
}

core::Material mirror() {
  core::Material material;
  material.name = "mirror";
  material.baseColor = Vec3(0.9f, 0.85f, 0.7f);
  material.metallic = 1;
  material.roughness = 0;
  return material;
}

core::Material matt() {
  core::Material material;
  material.name = "matt";
  material.baseColor = Vec3(0.6f);
  material.metallic = 0;
  material.specular = 0;
  return material;
}

/// A column and row for each ball, about the origin.
void placeBalls(core::Scene& scene, std::size_t balls, float side) {
  const auto across = static_cast<std::size_t>(side);
  for (std::size_t i = 0; i < balls; ++i) {
    const std::size_t x = i % across, y = i / across;
    const Vec3 place(static_cast<float>(x) - side / 2 + 0.5f, static_cast<float>(y) - side / 2 + 0.5f, 0);
    core::Object object;
    object.name = "ball " + std::to_string(i);
    object.material = static_cast<int>((x + y) % 2);
    object.meshToWorld = glm::translate(core::Mat4(1), place);
    scene.objects.push_back(std::move(object));
  }
}

}  // namespace

std::size_t trianglesOfBall(int rings) {
  const auto r = static_cast<std::size_t>(rings);
  return 4 * r * (r - 1);
}

int ringsFor(std::size_t triangles) {
  int rings = kFewestRings;
  while (trianglesOfBall(rings + 1) <= triangles) ++rings;
  return rings;
}

core::Scene makeBallScene(const BallScene& size) {
  core::Scene scene;
  scene.materials = {mirror(), matt()};
  scene.meshes.push_back(ballMesh(ringsFor(size.triangles / size.balls)));
  const float side = std::ceil(std::sqrt(static_cast<float>(size.balls)));
  placeBalls(scene, size.balls, side);
  core::Camera camera;
  camera.fovYDegrees = kFovDegrees;
  camera.at = Vec3(0);
  camera.eye = Vec3(0, 0, kRadius + side / 2 / std::tan(glm::radians(kFovDegrees / 2)));
  scene.cameras.push_back(camera);
  core::LoadOptions options;
  const std::string extent = std::to_string(side);
  options.lights = {"panel:at=0," + extent + "," + extent + ",size=" + extent + "," + extent +
                    ",radiance=10,10,10"};
  options.sharingPays = size.instanced ? 0 : std::numeric_limits<std::size_t>::max();
  core::completeScene(scene, options);
  return scene;
}

}  // namespace saccade::bench
