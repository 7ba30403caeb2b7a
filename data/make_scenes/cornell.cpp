// A Cornell box: a closed white room with a red and a green wall, a lamp, and one object of each kind.
#include "data/make_scenes/materials.h"
#include "data/make_scenes/profiles.h"
#include "data/make_scenes/scenes.h"
#include "data/make_scenes/shapes.h"

namespace saccade::data {
namespace {

constexpr float kFront = 3.2f;  // z of the wall behind the camera; the back wall stands at -1
const Vec3 kLampRadiance{17.0f, 14.4f, 10.2f};

void addRoom(GlbWriter& glb) {
  const auto wall = [&](const char* name, const MeshData& mesh, const Vec3& color) {
    MaterialDesc material = lambert(name, color);
    material.doubleSided = true;
    glb.addNode(name, glb.addGeometry(mesh), glb.addMaterial(material));
  };
  const float depth = kFront + 1;
  const Vec3 white(0.73f), x2(2, 0, 0), y2(0, 2, 0), z(0, 0, depth);
  wall("floor", panel({-1, 0, kFront}, x2, -z), white);
  wall("ceiling", panel({-1, 2, -1}, x2, z), white);
  wall("back wall", panel({-1, 0, -1}, x2, y2), white);
  wall("front wall", panel({1, 0, kFront}, -x2, y2), {0.35f, 0.40f, 0.48f});
  wall("left wall", panel({-1, 0, kFront}, -z, y2), {0.61f, 0.06f, 0.06f});
  wall("right wall", panel({1, 0, -1}, z, y2), {0.12f, 0.44f, 0.10f});
}

}  // namespace

GlbWriter makeCornell() {
  GlbWriter glb;
  addRoom(glb);
  glb.addNode("lamp", glb.addGeometry(panel({-0.3f, 1.985f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f})),
              glb.addMaterial(emitter("lamp", kLampRadiance)));
  const int sphere = glb.addGeometry(lathe(sphereProfile(1, 48), 96));
  const auto addSphere = [&](const char* name, const Vec3& floorPoint, float radius,
                             const MaterialDesc& material) {
    // A tenth of a millimetre of air: the ball touches nothing.
    glb.addNode(name, sphere, glb.addMaterial(material),
                standing(floorPoint + Vec3(0, radius + 1e-4f, 0), 0, radius));
  };
  addSphere("mirror sphere", {-0.44f, 0, -0.42f}, 0.38f, metal("mirror", Vec3(0.95f), 0));
  addSphere("glass sphere", {0.50f, 0, 0.30f}, 0.28f, glass("glass"));
  addSphere("diffuse sphere", {-0.22f, 0, 0.42f}, 0.19f, lambert("ochre", {0.80f, 0.52f, 0.16f}));
  glb.addNode("glossy box", glb.addGeometry(roundedBox(Vec3(0), {0.5f, 1.0f, 0.5f}, 0.02f, 3)),
              glb.addMaterial(metal("brushed gold", kGold, 0.25f)), standing({0.40f, 0.5001f, -0.42f}, -18));
  glb.addCamera({"main", {0, 1, 3.1f}, {0, 0.97f, 0}, {0, 1, 0}, 44});
  glb.addCamera({"spheres", {-0.55f, 0.75f, 1.7f}, {0.1f, 0.4f, 0.2f}, {0, 1, 0}, 50});
  return glb;
}

}  // namespace saccade::data
