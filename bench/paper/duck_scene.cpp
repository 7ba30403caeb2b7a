#include "bench/paper/duck_scene.h"

#include <algorithm>

#include "core/scene/defaults.h"
#include "core/scene/load.h"

namespace saccade::bench {
namespace {

using core::Vec3;

constexpr float kHalfRoom = 2;  // metres
constexpr float kHeight = 2.6f;
constexpr float kSeat = 0.45f;
constexpr float kThing = 0.5f;
constexpr int kTiles = 8;

/// Lambert alone.
core::Material paint(const char* name, const Vec3& color) {
  core::Material m;
  m.name = name;
  m.baseColor = color;
  m.metallic = 0;
  m.specular = 0;
  return m;
}

class Room {
 public:
  core::Scene scene;

  int add(const core::Material& material) {
    scene.materials.push_back(material);
    return static_cast<int>(scene.materials.size()) - 1;
  }
  void add(const std::string& name, int material, core::Mesh mesh) {
    core::Node node;
    node.name = name;
    scene.nodes.push_back(node);
    core::Object object;
    object.name = name;
    object.node = static_cast<int>(scene.nodes.size()) - 1;
    object.material = material;
    scene.add(std::move(object), std::move(mesh));
  }
};

/// Its front is where cross(e1, e2) points.
void addQuad(core::Mesh& mesh, const Vec3& corner, const Vec3& e1, const Vec3& e2) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& p : {corner, corner + e1, corner + e1 + e2, corner + e2}) mesh.positions.push_back(p);
  mesh.normals.resize(mesh.positions.size(), glm::normalize(glm::cross(e1, e2)));
  for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + i);
}

core::Mesh quad(const Vec3& corner, const Vec3& e1, const Vec3& e2) {
  core::Mesh mesh;
  addQuad(mesh, corner, e1, e2);
  return mesh;
}

core::Mesh tiles(bool dark) {
  core::Mesh mesh;
  const float side = 2 * kHalfRoom / kTiles;
  for (int i = 0; i < kTiles; ++i) {
    for (int j = 0; j < kTiles; ++j) {
      if (((i + j) % 2 == 0) != dark) continue;
      const Vec3 corner(-kHalfRoom + static_cast<float>(i) * side, 0,
                        -kHalfRoom + static_cast<float>(j) * side);
      addQuad(mesh, corner, {0, 0, side}, {side, 0, 0});
    }
  }
  return mesh;
}

/// Without a bottom.
core::Mesh stool(float half) {
  core::Mesh mesh = quad({-half, kSeat, half}, {2 * half, 0, 0}, {0, 0, -2 * half});
  const Vec3 up(0, kSeat, 0);
  addQuad(mesh, {-half, 0, half}, {2 * half, 0, 0}, up);
  addQuad(mesh, {half, 0, half}, {0, 0, -2 * half}, up);
  addQuad(mesh, {half, 0, -half}, {-2 * half, 0, 0}, up);
  addQuad(mesh, {-half, 0, -half}, {0, 0, 2 * half}, up);
  return mesh;
}

void addWalls(Room& room) {
  const float r = kHalfRoom, h = kHeight;
  const int white = room.add(paint("white wall", {0.72f, 0.7f, 0.66f}));
  room.add("floor, dark tiles", room.add(paint("dark tile", {0.12f, 0.1f, 0.1f})), tiles(true));
  room.add("floor, light tiles", room.add(paint("light tile", {0.7f, 0.65f, 0.55f})), tiles(false));
  room.add("ceiling", white, quad({-r, h, -r}, {2 * r, 0, 0}, {0, 0, 2 * r}));
  room.add("back wall", white, quad({-r, 0, -r}, {2 * r, 0, 0}, {0, h, 0}));
  room.add("front wall", room.add(paint("blue wall", {0.2f, 0.3f, 0.6f})),
           quad({r, 0, r}, {-2 * r, 0, 0}, {0, h, 0}));
  room.add("left wall", room.add(paint("red wall", {0.62f, 0.16f, 0.1f})),
           quad({-r, 0, r}, {0, 0, -2 * r}, {0, h, 0}));
  room.add("right wall", room.add(paint("green wall", {0.2f, 0.5f, 0.18f})),
           quad({r, 0, -r}, {0, 0, 2 * r}, {0, h, 0}));
}

bool isThing(const core::Scene& scene, const core::Object& object) {
  return !scene.materials[static_cast<std::size_t>(object.material)].emits();
}

/// In world space, without what only its own material needs.
core::Mesh placed(const core::Scene& scene, const core::Object& object, float scale, const Vec3& shift) {
  const core::Mesh& from = scene.meshOf(object);
  const core::Mat3 turn(object.meshToWorld), turnNormals = glm::transpose(glm::inverse(turn));
  core::Mesh mesh;
  mesh.indices = from.indices;
  for (const Vec3& p : from.positions)
    mesh.positions.push_back(scale * Vec3(object.meshToWorld * core::Vec4(p, 1)) + shift);
  for (const Vec3& n : from.normals) mesh.normals.push_back(glm::normalize(turnNormals * n));
  return mesh;
}

void addThing(Room& room, const core::Scene& file, const core::Material& material) {
  core::Bounds bounds;
  for (const core::Object& o : file.objects) {
    if (isThing(file, o)) bounds.add(o.bounds);
  }
  if (bounds.empty()) throw core::Error(file.path + ": nothing in it but lamps");
  const float scale = kThing / std::max({bounds.extent().x, bounds.extent().y, bounds.extent().z});
  const Vec3 feet(bounds.center().x, bounds.lo.y, bounds.center().z);
  const int shared = room.add(material);
  for (const core::Object& o : file.objects) {
    if (isThing(file, o)) room.add(o.name, shared, placed(file, o, scale, Vec3(0, kSeat, 0) - scale * feet));
  }
}

}  // namespace

core::Material chrome() {
  core::Material m;
  m.name = "chrome";
  m.baseColor = {0.9f, 0.9f, 0.92f};
  m.metallic = 1;
  m.roughness = 0;
  return m;
}

core::Scene thingInRoom(const std::filesystem::path& file, const core::Material& material) {
  const core::Scene thing = core::loadScene(file, {});
  Room room;
  room.scene.path = file.string();
  addWalls(room);
  room.add("stool", room.add(paint("wood", {0.45f, 0.25f, 0.1f})), stool(0.32f));
  addThing(room, thing, material);
  core::addPanel(room.scene, "lamp", {0.3f, kHeight - 0.02f, 0.6f}, {1, 1}, {0, -1, 0}, Vec3(14));
  core::Camera camera;
  camera.eye = {0.85f, 1.15f, 1.3f};
  camera.at = {0, kSeat + 0.45f * kThing, 0};
  camera.fovYDegrees = 40;
  room.scene.cameras.push_back(camera);
  core::completeScene(room.scene, {});
  return std::move(room.scene);
}

}  // namespace saccade::bench
