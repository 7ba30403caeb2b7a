#include <array>
#include <string>

#include "data/make_scenes/gallery.h"
#include "data/make_scenes/materials.h"
#include "data/make_scenes/profiles.h"
#include "data/make_scenes/sculptures.h"
#include "data/make_scenes/shapes.h"
#include "data/make_scenes/textures.h"

namespace saccade::data {
namespace {

/// Materials of the exhibits, made once.
struct Palette {
  int gold, copper, silver, steel, bronze, hammered, rippled, crystal, case_;
  std::array<int, 6> glazes;
  std::array<int, 3> plinths;  ///< white plaster, travertine (both diffuse), polished black stone
};

int textured(GlbWriter& glb, MaterialDesc material, const std::string& reliefName, int size,
             const HeightFunction& height, float strength) {
  material.normalTexture = glb.addPng(reliefName, normalMap(size, height, strength));
  return glb.addMaterial(material);
}

std::array<int, 6> makeGlazes(GlbWriter& glb) {
  const std::array<Vec3, 6> grounds{{{.92f, .91f, .86f},
                                     {.20f, .42f, .46f},
                                     {.86f, .74f, .48f},
                                     {.55f, .70f, .60f},
                                     {.16f, .18f, .30f},
                                     {.62f, .18f, .12f}}};
  const std::array<Vec3, 6> inks{{{.10f, .20f, .52f},
                                  {.90f, .84f, .66f},
                                  {.46f, .16f, .08f},
                                  {.94f, .93f, .86f},
                                  {.82f, .62f, .26f},
                                  {.10f, .06f, .06f}}};
  std::array<int, 6> glazes{};
  for (std::size_t k = 0; k < 6; ++k) {
    const std::string name = "glaze " + std::to_string(k + 1);
    glazes[k] = glb.addMaterial(glazed(
        name, Vec3(1),
        glb.addJpeg(
            name,
            paint(160, 96, [&](Vec2 uv) { return glazeColor(uv, static_cast<int>(k), grounds[k], inks[k]); }),
            82),
        2.2f, 0.06f));
  }
  return glazes;
}

std::array<int, 3> makePlinths(GlbWriter& glb) {
  const int white = glb.addJpeg(
      "plinth plaster",
      paint(96, 96, [](Vec2 uv) { return mottledColor(uv, Vec3(.88f, .87f, .84f), .05f, 91); }), 80);
  const int terrazzo = glb.addJpeg("terrazzo",
                                   paint(160, 160,
                                         [](Vec2 uv) {
                                           return terrazzoColor(uv, {.68f, .63f, .56f}, 92);
                                         }),
                                   80);
  const int black = glb.addJpeg("plinth marble",
                                paint(160, 160,
                                      [](Vec2 uv) {
                                        return marbleColor(uv, {.12f, .11f, .12f}, {.76f, .66f, .48f}, 93);
                                      }),
                                82);
  return {glb.addMaterial(lambert("plinth plaster", Vec3(1), white)),
          glb.addMaterial(lambert("terrazzo", Vec3(1), terrazzo)),
          glb.addMaterial(glazed("plinth marble", Vec3(1), black, 2.0f, 0.08f))};
}

Palette makePalette(GlbWriter& glb) {
  Palette p{};
  p.gold = glb.addMaterial(metal("polished gold", kGold, 0.12f));
  p.copper = glb.addMaterial(metal("polished copper", kCopper, 0.16f));
  p.silver = glb.addMaterial(metal("polished silver", kSilver, 0.06f));
  p.steel = glb.addMaterial(metal("mirror steel", Vec3(0.90f, 0.90f, 0.91f), 0.02f));
  MaterialDesc bronze = metal("patinated bronze", Vec3(1), 1);
  bronze.baseColorTexture = glb.addJpeg(
      "bronze patina",
      paint(128, 128,
            [](Vec2 uv) {
              const float green = glm::smoothstep(.5f, .7f, mottledColor(uv, Vec3(.5f), .9f, 95).x);
              return glm::mix(Vec3(.80f, .58f, .38f), Vec3(.45f, .55f, .44f), .7f * green);
            }),
      82);
  bronze.metallicRoughnessTexture = glb.addJpeg(
      "bronze wear",
      metallicRoughnessMap(128, 1,
                           [](Vec2 uv) {
                             return .26f +
                                    .3f * glm::smoothstep(.5f, .7f, mottledColor(uv, Vec3(.5f), .9f, 95).x);
                           }),
      82);
  p.bronze = glb.addMaterial(bronze);
  p.hammered = textured(
      glb, metal("hammered brass", kBrass, 0.18f), "hammer marks", 128,
      [](Vec2 uv) { return hammeredHeight(uv, 9); }, 0.03f);
  p.rippled = textured(glb, metal("rippled silver", kSilver, 0.08f), "ripples", 96, rippleHeight, 0.02f);
  p.crystal = glb.addMaterial(glass("crystal"));
  MaterialDesc pane = glass("vitrine glass", Vec3(0.96f, 0.98f, 0.97f));
  pane.doubleSided = true;
  p.case_ = glb.addMaterial(pane);
  p.glazes = makeGlazes(glb);
  p.plinths = makePlinths(glb);
  return p;
}

/// Shapes used by several exhibits, stored once; `bumpy` so that any material fits.
struct Shapes {
  int knot, cinquefoil, ring, tower, flame, starfruit, shell, beads, crown, bust, ball, stone;
  std::array<int, 4> vases;
  int plinth, pedestal;
};

Shapes makeShapes(GlbWriter& glb) {
  Shapes s{};
  s.knot = glb.addGeometry(torusKnot(2, 3, 120, 12));
  s.cinquefoil = glb.addGeometry(torusKnot(2, 5, 168, 10));
  s.ring = glb.addGeometry(twistedRing());
  s.tower = glb.addGeometry(twistedTower());
  s.flame = glb.addGeometry(flame());
  s.starfruit = glb.addGeometry(starfruit(), true, true);
  s.shell = glb.addGeometry(seashell());
  s.beads = glb.addGeometry(beadTower());
  s.crown = glb.addGeometry(crown());
  s.bust = glb.addGeometry(bust(), true, true);
  s.ball = glb.addGeometry(lathe(sphereProfile(1, 28), 44));
  s.stone = glb.addGeometry(cutStone(0.18f, 0.26f, 12));
  for (int k = 0; k < 4; ++k)
    s.vases[static_cast<std::size_t>(k)] = glb.addGeometry(vase(k, 32), k < 3, k == 1);
  s.plinth = glb.addGeometry(roundedBox({0, 0.5f, 0}, {0.52f, 1.0f, 0.52f}, 0.012f, 1, 1), true);
  s.pedestal = glb.addGeometry(roundedBox({0, 0.45f, 0}, {0.74f, 0.9f, 0.74f}, 0.012f, 1, 1), true);
  return s;
}

struct Exhibit {
  const char* name;
  int shape, material, plinth;
  float x, z, degrees, scale;
};

constexpr float kHover = 1e-3f;  // air under whatever stands

/// Sculptures on plinths along the colonnades and in the corners.
void addSculptures(GlbWriter& glb, const Palette& p, const Shapes& s) {
  const float inner = 2.15f, outer = kColonnadeX;
  const std::array<Exhibit, 20> exhibits{{
      {"knot in gold", s.knot, p.gold, 2, -inner, 7.7f, 25, 0.95f},
      {"silver flame", s.flame, p.silver, 0, inner, 7.0f, 10, 0.85f},
      {"starfruit", s.starfruit, p.rippled, 0, -inner, 4.9f, 0, 0.85f},
      {"crystal ball", s.ball, p.crystal, 2, inner, 4.5f, 0, 0.24f},
      {"lattice vase", s.vases[2], p.glazes[3], 2, -inner, -2.6f, 0, 0.9f},
      {"cinquefoil", s.cinquefoil, p.silver, 1, inner, -3.4f, 0, 0.95f},
      {"crystal knot", s.knot, p.crystal, 2, -inner, -5.8f, 35, 0.8f},
      {"steel ring", s.ring, p.steel, 2, inner, -6.6f, 35, 0.95f},
      {"blue and white vase", s.vases[0], p.glazes[0], 1, -outer, 10.7f, 0, 0.9f},
      {"hammered bowl", s.vases[1], p.hammered, 0, outer, 10.7f, 0, 1.0f},
      {"bronze head", s.bust, p.bronze, 2, -outer, 4.4f, 90, 0.9f},
      {"twisted ring", s.ring, p.copper, 2, outer, 4.6f, -55, 0.95f},
      {"twisted tower", s.tower, p.steel, 1, -outer, -1.5f, 20, 1.0f},
      {"seashell", s.shell, p.gold, 0, outer, -1.5f, 40, 0.95f},
      {"copper beads", s.beads, p.copper, 0, -outer, -7.4f, 0, 0.75f},
      {"second head", s.bust, p.hammered, 2, outer, -7.4f, 0, 0.9f},
      {"goblet", s.vases[3], p.gold, 0, -outer, -10.8f, 0, 1.0f},
      {"scaled vase", s.vases[0], p.glazes[5], 0, outer, -10.8f, 0, 0.95f},
      {"dotted vase", s.vases[2], p.glazes[2], 1, -4.3f, 11.2f, 0, 0.95f},
      {"banded bowl", s.vases[1], p.glazes[4], 1, 4.3f, 11.2f, 0, 1.0f},
  }};
  for (const Exhibit& e : exhibits) {
    const std::string name = e.name;
    glb.addNode(name + " plinth", s.plinth, p.plinths[static_cast<std::size_t>(e.plinth)],
                standing({e.x, kHover, e.z}));
    const float lift = e.shape == s.ball ? e.scale : 0;  // the ball is centred on the origin
    glb.addNode(name, e.shape, e.material,
                standing({e.x, 1.0f + 2 * kHover + lift, e.z}, e.degrees, e.scale));
  }
}

/// Glass cases with small treasures between the columns.
void addVitrines(GlbWriter& glb, const Palette& p, const Shapes& s) {
  const int glassCase = glb.addGeometry(openCase({0.66f, 0.72f, 0.66f}));
  const int rim = glb.addGeometry(box({0, 0.01f, 0}, {0.70f, 0.02f, 0.70f}));
  const int brass = glb.addMaterial(metal("vitrine brass", kBrass, 0.24f));
  struct Treasure {
    const char* name;
    int shape, material;
    float scale;
  };
  const std::array<Treasure, 6> treasures{{{"crown", s.crown, p.gold, 0.72f},
                                           {"cut crystal", s.stone, p.crystal, 1.3f},
                                           {"waved vase", s.vases[0], p.glazes[1], 0.6f},
                                           {"silver goblet", s.vases[3], p.silver, 0.65f},
                                           {"small shell", s.shell, p.copper, 0.55f},
                                           {"gold star", s.starfruit, p.gold, 0.5f}}};
  for (std::size_t k = 0; k < treasures.size(); ++k) {
    const Treasure& t = treasures[k];
    const float x = k % 2 == 0 ? -kColonnadeX : kColonnadeX, z = 6.2f - 6.0f * static_cast<float>(k / 2);
    const std::string name = t.name;
    glb.addNode(name + " pedestal", s.pedestal, p.plinths[k % 2 == 0 ? 1 : 0], standing({x, kHover, z}));
    glb.addNode(name + " rim", rim, brass, standing({x, 0.9f + 2 * kHover, z}));
    glb.addNode(name, t.shape, t.material, standing({x, 0.92f + 3 * kHover, z}, 30, t.scale));
    glb.addNode(name + " case", glassCase, p.case_, standing({x, 0.92f + 3 * kHover, z}));
  }
}

void addCentrepiece(GlbWriter& glb, const Palette& p) {
  const int base = glb.addGeometry(
      lathe(roundedProfile({{{0, 0}, 0}, {{1.25f, 0}, 0}, {{1.25f, 0.22f}, 0.03f}, {{0, 0.22f}, 0}}, 3), 64),
      true);
  glb.addNode("centrepiece base", base, p.plinths[0], standing({0, kHover, 1.2f}));
  glb.addNode("centrepiece", glb.addGeometry(bean()), p.steel,
              standing({0, 0.22f + 2 * kHover, 1.2f}, 14, 1.12f));
  glb.addNode("tall flame", glb.addGeometry(flame()), p.gold, standing({0, 0.22f + kHover, -8.2f}, 60, 1.9f));
  glb.addNode("tall flame base", glb.addGeometry(box({0, 0.11f, 0}, {0.7f, 0.22f, 0.7f}, 1), true),
              p.plinths[2], standing({0, kHover / 2, -8.2f}));
}

void addBenches(GlbWriter& glb) {
  MaterialDesc leather = lambert("leather", Vec3(1),
                                 glb.addJpeg("leather",
                                             paint(96, 96,
                                                   [](Vec2 uv) {
                                                     return mottledColor(uv, {.45f, .20f, .13f}, .12f, 97);
                                                   }),
                                             80));
  const int cushion = textured(glb, leather, "leather grain", 96, leatherHeight, 0.006f);
  const int walnut =
      glb.addMaterial(lambert("walnut", Vec3(1),
                              glb.addJpeg("walnut",
                                          paint(128, 96,
                                                [](Vec2 uv) {
                                                  return boardColor(uv, {3, 1}, {.34f, .22f, .15f}, 98);
                                                }),
                                          80)));
  const int seat =
      glb.addGeometry(roundedBox({0, 0.43f, 0}, {0.52f, 0.10f, 1.70f}, 0.04f, 4, 0.5f), true, true);
  MeshData rack = box({0, 0.355f, 0}, {0.46f, 0.05f, 1.64f}, 0.6f);
  for (int k = 0; k < 4; ++k)
    rack.append(
        box({k % 2 == 0 ? -0.19f : 0.19f, 0.165f, k / 2 == 0 ? -0.76f : 0.76f}, {0.06f, 0.33f, 0.06f}, 0.6f));
  const int frameShape = glb.addGeometry(rack, true);
  const std::array<Vec3, 3> places{{{0, 0, -4.6f}, {-4.0f, 0, 2.2f}, {4.0f, 0, -4.4f}}};
  for (const Vec3& place : places) {
    glb.addNode("bench seat", seat, cushion, standing(place));
    glb.addNode("bench frame", frameShape, walnut, standing(place + Vec3(0, kHover, 0)));
  }
}

/// Brass posts with a red rope before the grand picture.
void addStanchions(GlbWriter& glb) {
  const int brass = glb.addMaterial(metal("stanchion brass", kBrass, 0.14f));
  const int velvet = glb.addMaterial(lambert("velvet rope", {.38f, .03f, .05f}));
  const int post = glb.addGeometry(lathe(splineProfile({{0, 0},
                                                        {0.15f, 0.002f},
                                                        {0.155f, 0.015f},
                                                        {0.12f, 0.03f},
                                                        {0.026f, 0.05f},
                                                        {0.022f, 0.1f},
                                                        {0.022f, 0.86f},
                                                        {0.034f, 0.89f},
                                                        {0.03f, 0.92f},
                                                        {0.05f, 0.96f},
                                                        {0.035f, 1.0f},
                                                        {0, 1.01f}},
                                                       2),
                                         16));
  constexpr double kSpan = 1.1;
  const int rope = glb.addGeometry(
      tube([](double t) { return glm::dvec3(kSpan * (t - 0.5), 0.90 - 0.22 * 4 * t * (1 - t), 0); },
           [](double) { return 0.02; }, 28, 10));
  constexpr int kPosts = 4;
  for (int k = 0; k < kPosts; ++k) {
    const float x = static_cast<float>(kSpan) * (static_cast<float>(k) - 0.5f * (kPosts - 1));
    glb.addNode("stanchion", post, brass, standing({x, kHover, -10.4f}));
    if (k + 1 < kPosts)
      glb.addNode("rope", rope, velvet, standing({x + 0.5f * static_cast<float>(kSpan), 0, -10.4f}));
  }
}

}  // namespace

void addExhibits(GlbWriter& glb) {
  const Palette palette = makePalette(glb);
  const Shapes shapes = makeShapes(glb);
  addSculptures(glb, palette, shapes);
  addVitrines(glb, palette, shapes);
  addCentrepiece(glb, palette);
  addBenches(glb);
  addStanchions(glb);
}

}  // namespace saccade::data
