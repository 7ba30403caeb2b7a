// A row of vases with Ward's lobe, as in the scenes of Haber et al. 2001: three surfaces that Ward measured
// and three that stretch the lobe, before a tray of brushed steel.
#include <cmath>

#include "data/make_scenes/materials.h"
#include "data/make_scenes/profiles.h"
#include "data/make_scenes/scenes.h"
#include "data/make_scenes/shapes.h"

namespace saccade::data {
namespace {

constexpr float kHalfWidth = 1.9f, kBack = -0.9f, kFront = 3.2f, kHeight = 2.3f;
constexpr float kBenchTop = 0.78f;
constexpr float kHover = 2e-4f;  // air between the things and the bench

void addRoom(GlbWriter& glb) {
  const Vec3 x(2 * kHalfWidth, 0, 0), y(0, kHeight, 0), z(0, 0, kFront - kBack);
  const int plaster = glb.addMaterial(lambert("plaster", {0.62f, 0.60f, 0.56f}));
  glb.addNode("floor", glb.addGeometry(panel({-kHalfWidth, 0, kFront}, x, -z)),
              glb.addMaterial(lambert("floor", {0.30f, 0.24f, 0.19f})));
  glb.addNode("ceiling", glb.addGeometry(panel({-kHalfWidth, kHeight, kBack}, x, z)), plaster);
  glb.addNode("back wall", glb.addGeometry(panel({-kHalfWidth, 0, kBack}, x, y)),
              glb.addMaterial(lambert("blue wall", {0.16f, 0.22f, 0.30f})));
  glb.addNode("front wall", glb.addGeometry(panel({kHalfWidth, 0, kFront}, -x, y)), plaster);
  glb.addNode("left wall", glb.addGeometry(panel({-kHalfWidth, 0, kFront}, -z, y)), plaster);
  glb.addNode("right wall", glb.addGeometry(panel({kHalfWidth, 0, kBack}, z, y)), plaster);
  glb.addNode("bench",
              glb.addGeometry(roundedBox({0, kBenchTop / 2, -0.1f}, {2.3f, kBenchTop, 0.9f}, 0.01f, 3)),
              glb.addMaterial(lambert("painted wood", {0.55f, 0.52f, 0.47f})));
}

/// A long lamp over the bench and a tall one to the left: one highlight along, one across the vases.
void addLights(GlbWriter& glb) {
  glb.addNode("ceiling lamp",
              glb.addGeometry(panel({-1.1f, kHeight - 0.015f, 0.55f}, {2.2f, 0, 0}, {0, 0, 0.18f})),
              glb.addMaterial(emitter("warm tube", {22.0f, 19.6f, 16.2f})));
  glb.addNode("tall lamp",
              glb.addGeometry(panel({-kHalfWidth + 0.015f, 0.5f, 1.5f}, {0, 0, -0.22f}, {0, 1.5f, 0})),
              glb.addMaterial(emitter("cool tube", {15.0f, 17.4f, 20.0f})));
}

MeshData vase() {
  return lathe(splineProfile({{0, 0},
                              {0.060f, 0.000f},
                              {0.066f, 0.006f},
                              {0.105f, 0.080f},
                              {0.128f, 0.170f},
                              {0.112f, 0.250f},
                              {0.066f, 0.312f},
                              {0.050f, 0.345f},
                              {0.058f, 0.385f},
                              {0.072f, 0.400f},
                              {0.066f, 0.402f},
                              {0.050f, 0.385f},
                              {0.043f, 0.345f},
                              {0.058f, 0.308f},
                              {0.100f, 0.245f},
                              {0.114f, 0.170f},
                              {0.092f, 0.085f},
                              {0.050f, 0.018f},
                              {0, 0.014f}},
                             4),
               72);
}

/// One of the row. `alpha` x runs around the vase, y along its outline.
struct Finish {
  const char* name;
  Vec3 diffuse, specular;
  Vec2 alpha;
};

/// The first three have the strengths and alphas of Ward 1992, table 1 (grey there; the hues are ours).
const Finish kRow[] = {{"rolled brass", {0.14f, 0.095f, 0.035f}, {0.42f, 0.32f, 0.14f}, {0.050f, 0.16f}},
                       {"rolled aluminium", Vec3(0.10f), {0.205f, 0.21f, 0.22f}, {0.04f, 0.09f}},
                       {"enamel", {0.10f, 0.27f, 0.33f}, Vec3(0.12f), {0.080f, 0.096f}},
                       {"satin copper", {0.06f, 0.03f, 0.02f}, {0.62f, 0.36f, 0.26f}, {0.20f, 0.20f}},
                       {"polished lacquer", {0.33f, 0.02f, 0.02f}, Vec3(0.13f), {0.03f, 0.03f}},
                       {"turned steel", Vec3(0.03f), {0.55f, 0.56f, 0.58f}, {0.03f, 0.30f}}};

}  // namespace

GlbWriter makeWard() {
  GlbWriter glb;
  addRoom(glb);
  addLights(glb);
  const int shape = glb.addGeometry(vase(), true, true);
  float x = -0.85f;
  for (const Finish& f : kRow) {
    glb.addNode(std::string(f.name) + " vase", shape,
                glb.addMaterial(ward(f.name, f.diffuse, f.specular, f.alpha)),
                standing({x, kBenchTop + kHover, -0.15f}));
    x += 0.34f;
  }
  glb.addNode(
      "brushed tray",
      glb.addGeometry(roundedBox({0, kBenchTop + kHover + 0.008f, 0.185f}, {1.7f, 0.016f, 0.2f}, 0.004f, 3),
                      true, true),
      glb.addMaterial(ward("brushed steel", Vec3(0.05f), {0.50f, 0.51f, 0.53f}, {0.25f, 0.05f})));
  glb.addCamera({"main", {0.18f, 1.36f, 2.75f}, {0, 0.93f, 0}, {0, 1, 0}, 40});
  glb.addCamera({"close", {-0.55f, 1.25f, 0.95f}, {-0.5f, 0.95f, -0.1f}, {0, 1, 0}, 42});
  return glb;
}

}  // namespace saccade::data
