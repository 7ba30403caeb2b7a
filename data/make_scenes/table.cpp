// Two glasses and a mug on a wooden table: the still life of Haber et al. 2001, Figure 3.
#include <cmath>

#include "data/make_scenes/materials.h"
#include "data/make_scenes/noise.h"
#include "data/make_scenes/profiles.h"
#include "data/make_scenes/scenes.h"
#include "data/make_scenes/shapes.h"
#include "data/make_scenes/textures.h"

namespace saccade::data {
namespace {

constexpr float kHalfRoom = 1.6f;
constexpr float kTableTop = 0.75f;
constexpr float kHover = 2e-4f;  // air between a vessel and the table

void addRoom(GlbWriter& glb) {
  const int boards = glb.addJpeg("floor boards",
                                 paint(256, 256,
                                       [](Vec2 uv) {
                                         return boardColor(uv, {6}, {0.42f, 0.31f, 0.22f}, 21);
                                       }),
                                 80);
  const int plaster = glb.addMaterial(lambert("plaster", {0.70f, 0.66f, 0.58f}));
  const int wallpaper = glb.addMaterial(lambert("wall paint", {0.26f, 0.38f, 0.42f}));
  const float w = kHalfRoom, h = 2.5f;
  const Vec3 x(2 * w, 0, 0), y(0, h, 0), z(0, 0, 2 * w);
  glb.addNode("floor", glb.addGeometry(panel({-w, 0, w}, x, -z, Vec2(3)), true),
              glb.addMaterial(lambert("floor", Vec3(1), boards)));
  glb.addNode("ceiling", glb.addGeometry(panel({-w, h, -w}, x, z)), plaster);
  glb.addNode("back wall", glb.addGeometry(panel({-w, 0, -w}, x, y)), wallpaper);
  glb.addNode("front wall", glb.addGeometry(panel({w, 0, w}, -x, y)), plaster);
  glb.addNode("left wall", glb.addGeometry(panel({-w, 0, w}, -z, y)), plaster);
  glb.addNode("right wall", glb.addGeometry(panel({w, 0, -w}, z, y)), plaster);
  glb.addNode("dado", glb.addGeometry(box({0, 0.5f, -w + 0.015f}, {2 * w, 1.0f, 0.03f})),
              glb.addMaterial(lambert("white paint", {0.78f, 0.76f, 0.70f})));
}

/// A window with four panes in the left wall, and a lamp under the ceiling.
void addLights(GlbWriter& glb) {
  const int daylight = glb.addMaterial(emitter("daylight", {9.4f, 10.5f, 12.3f}));
  const int pane = glb.addGeometry(panel({0, 0, 0}, {0, 0, -0.52f}, {0, 0.58f, 0}));
  for (int k = 0; k < 4; ++k)
    glb.addNode("window pane", pane, daylight,
                standing({-kHalfRoom + 0.015f, 1.05f + 0.64f * static_cast<float>(k / 2),
                          0.30f + 0.58f * static_cast<float>(k % 2)}));
  const int bars = glb.addMaterial(lambert("window bars", {0.80f, 0.79f, 0.75f}));
  glb.addNode("window cross", glb.addGeometry(box({-kHalfRoom + 0.03f, 1.66f, 0.33f}, {0.05f, 1.36f, 0.06f})),
              bars);
  glb.addNode("window transom",
              glb.addGeometry(box({-kHalfRoom + 0.03f, 1.66f, 0.33f}, {0.04f, 0.06f, 1.24f})), bars);
  glb.addNode("window sill", glb.addGeometry(box({-kHalfRoom + 0.07f, 1.0f, 0.33f}, {0.14f, 0.05f, 1.4f})),
              bars);
  glb.addNode("ceiling lamp", glb.addGeometry(panel({-0.35f, 2.46f, -0.35f}, {0.7f, 0, 0}, {0, 0, 0.7f})),
              glb.addMaterial(emitter("lamp", {6.4f, 5.3f, 3.8f})));
}

void addTable(GlbWriter& glb) {
  const int wood = glb.addJpeg("oak",
                               paint(768, 768,
                                     [](Vec2 uv) {
                                       return boardColor(uv, {9, 0, 0.72f}, {0.58f, 0.42f, 0.28f}, 5);
                                     }),
                               84);
  // Varnished: a dielectric lobe of 4 %, below the threshold, so the table stays in the base layer.
  MaterialDesc varnished;
  varnished.name = "varnished oak";
  varnished.baseColorTexture = wood;
  varnished.roughness = 0.5f;
  const int oak = glb.addMaterial(varnished);
  glb.addNode(
      "table top",
      glb.addGeometry(roundedBox({0, kTableTop - 0.02f, 0}, {1.5f, 0.04f, 0.9f}, 0.008f, 3, 1.6f), true),
      oak);
  const int leg = glb.addGeometry(roundedBox({0, 0.355f, 0}, {0.07f, 0.71f, 0.07f}, 0.006f, 2, 1.6f), true);
  for (int k = 0; k < 4; ++k)
    glb.addNode("table leg", leg, oak,
                standing({k % 2 == 0 ? -0.66f : 0.66f, 0, k / 2 == 0 ? -0.36f : 0.36f}));
}

MeshData tumbler() {
  return lathe(roundedProfile({{{0, 0}, 0},
                               {{0.033f, 0}, 0.004f},
                               {{0.040f, 0.115f}, 0.00125f},
                               {{0.0374f, 0.115f}, 0.00125f},
                               {{0.0305f, 0.014f}, 0.008f},
                               {{0, 0.012f}, 0}},
                              8),
               96);
}

MeshData wineGlass() {
  return lathe(splineProfile({{0, 0},
                              {0.036f, 0.0005f},
                              {0.0365f, 0.0015f},
                              {0.034f, 0.0025f},
                              {0.010f, 0.008f},
                              {0.0045f, 0.020f},
                              {0.0040f, 0.060f},
                              {0.0070f, 0.080f},
                              {0.026f, 0.096f},
                              {0.040f, 0.125f},
                              {0.041f, 0.150f},
                              {0.035f, 0.190f},
                              {0.0342f, 0.1912f},
                              {0.0335f, 0.190f},
                              {0.0393f, 0.150f},
                              {0.0382f, 0.126f},
                              {0.0245f, 0.099f},
                              {0.008f, 0.0885f},
                              {0, 0.0872f}},
                             6),
               96);
}

MeshData mug() {
  MeshData mesh = lathe(roundedProfile({{{0, 0.003f}, 0},
                                        {{0.030f, 0.003f}, 0.001f},
                                        {{0.031f, 0}, 0.001f},
                                        {{0.0415f, 0}, 0.006f},
                                        {{0.0425f, 0.098f}, 0.0022f},
                                        {{0.0380f, 0.098f}, 0.0022f},
                                        {{0.0365f, 0.008f}, 0.010f},
                                        {{0, 0.007f}, 0}},
                                       8),
                        96);
  const auto bow = [](double t) {
    const double angle = 3.14159265358979 * (t - 0.5);
    return glm::dvec3(0.0402 + 0.027 * std::cos(angle), 0.051 + 0.031 * std::sin(angle), 0);
  };
  mesh.append(tube(
      bow, [](double) { return 0.0055; }, 48, 20));
  return mesh;
}

}  // namespace

GlbWriter makeTable() {
  GlbWriter glb;
  addRoom(glb);
  addLights(glb);
  addTable(glb);
  const int clear = glb.addMaterial(glass("clear glass"));
  const auto at = [](float x, float z, float degrees) {
    return standing({x, kTableTop + kHover, z}, degrees);
  };
  glb.addNode("tumbler", glb.addGeometry(tumbler()), clear, at(0.075f, 0.085f, 0));
  glb.addNode("wine glass", glb.addGeometry(wineGlass()), clear, at(0.045f, -0.075f, 0));
  glb.addNode("mug", glb.addGeometry(mug()),
              glb.addMaterial(glazed("glazed ceramic", {0.05f, 0.25f, 0.30f}, -1, 2.2f, 0.08f)),
              at(-0.095f, 0.02f, 205));
  glb.addCamera({"main", {0.16f, 1.01f, 0.60f}, {-0.005f, 0.825f, 0.0f}, {0, 1, 0}, 34});
  glb.addCamera({"room", {1.3f, 1.45f, 1.4f}, {-0.2f, 0.8f, -0.2f}, {0, 1, 0}, 60});
  return glb;
}

}  // namespace saccade::data
