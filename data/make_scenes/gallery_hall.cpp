#include "data/make_scenes/gallery.h"
#include "data/make_scenes/materials.h"
#include "data/make_scenes/sculptures.h"
#include "data/make_scenes/shapes.h"
#include "data/make_scenes/textures.h"

namespace saccade::data {
namespace {

constexpr float kW = kHallHalfWidth, kL = kHallHalfLength, kH = kHallHeight;
const Vec3 kSkylight{9.6f, 9.8f, 10.0f};
const Vec3 kSideLight{10.5f, 9.2f, 7.4f};

/// The aisle: polished dark stone slabs in two tones between brass strips.
void addAisle(GlbWriter& glb) {
  const auto slabMaterial = [&](const char* name, const Vec3& ground, const Vec3& vein, std::uint32_t seed) {
    MaterialDesc slab = glazed(
        name, Vec3(1),
        glb.addJpeg(name, paint(256, 256, [&](Vec2 uv) { return marbleColor(uv, ground, vein, seed); }), 82),
        2.1f, 1);
    slab.metallicRoughnessTexture =
        glb.addJpeg(std::string(name) + " roughness",
                    metallicRoughnessMap(
                        128, 0, [&](Vec2 uv) { return mottledColor(uv, Vec3(0.055f), 0.4f, seed + 5).x; }),
                    85);
    return glb.addMaterial(slab);
  };
  const int black = slabMaterial("black marble", {.13f, .13f, .15f}, {.80f, .78f, .74f}, 3);
  const int green = slabMaterial("green marble", {.13f, .24f, .20f}, {.66f, .74f, .66f}, 8);
  constexpr int kSlabs = 8;
  const float length = 2 * kL / kSlabs, strip = 0.07f, half = kAisleHalfWidth - strip;
  const int slab =
      glb.addGeometry(panel({-half, 0, length / 2}, {2 * half, 0, 0}, {0, 0, -length}, {1, 1.3f}), true);
  for (int k = 0; k < kSlabs; ++k)
    glb.addNode("aisle slab", slab, k % 2 == 0 ? black : green,
                standing({0, 0, kL - (static_cast<float>(k) + 0.5f) * length}));
  const int brass = glb.addMaterial(metal("floor brass", kBrass, 0.15f));
  const int rail = glb.addGeometry(panel({0, 0, kL}, {strip, 0, 0}, {0, 0, -2 * kL}));
  glb.addNode("brass strip", rail, brass, standing({-kAisleHalfWidth, 0, 0}));
  glb.addNode("brass strip", rail, brass, standing({half, 0, 0}));
}

void addParquet(GlbWriter& glb) {
  const Vec3 tone(.60f, .41f, .25f);
  MaterialDesc parquet;  // oiled wood: a 4 % lobe, rough, below the threshold
  parquet.name = "parquet";
  parquet.baseColorTexture =
      glb.addJpeg("parquet", paint(384, 384, [&](Vec2 uv) { return boardColor(uv, {12}, tone, 31); }), 82);
  parquet.normalTexture =
      glb.addPng("parquet relief", normalMap(
                                       128, [](Vec2 uv) { return boardHeight(uv, {12}, 31); }, 0.006f));
  parquet.metallicRoughnessTexture = glb.addJpeg(
      "parquet roughness",
      metallicRoughnessMap(128, 0,
                           [&](Vec2 uv) { return 0.78f - 0.5f * boardColor(uv, {12}, tone, 31).x * 0.6f; }),
      80);
  const float width = kW - kAisleHalfWidth;
  const int side = glb.addGeometry(
      panel({-width / 2, 0, kL}, {width, 0, 0}, {0, 0, -2 * kL}, {width / 1.8f, 2 * kL / 1.8f}), true, true);
  const int material = glb.addMaterial(parquet);
  glb.addNode("parquet", side, material, standing({-kAisleHalfWidth - width / 2, 0, 0}));
  glb.addNode("parquet", side, material, standing({kAisleHalfWidth + width / 2, 0, 0}));
}

int plasterMaterial(GlbWriter& glb, const char* name, const Vec3& tone, int relief, std::uint32_t seed) {
  MaterialDesc plaster = lambert(
      name, Vec3(1),
      glb.addJpeg(name, paint(128, 128, [&](Vec2 uv) { return mottledColor(uv, tone, 0.07f, seed); }), 80));
  plaster.normalTexture = relief;
  return glb.addMaterial(plaster);
}

void addWalls(GlbWriter& glb) {
  const int relief = glb.addPng("plaster relief", normalMap(96, plasterHeight, 0.004f));
  const int wall = plasterMaterial(glb, "wall", {.40f, .55f, .56f}, relief, 61);
  const int endWall = plasterMaterial(glb, "end wall", {.66f, .30f, .24f}, relief, 62);
  const int frieze = plasterMaterial(glb, "frieze", {.90f, .88f, .83f}, relief, 63);
  constexpr float kFriezeAt = 4.1f;
  const auto addWall = [&](const Vec3& corner, const Vec3& along, int lower) {
    const float length = glm::length(along), top = kH - kFriezeAt;
    glb.addNode(
        "wall",
        glb.addGeometry(panel(corner, along, {0, kFriezeAt, 0}, Vec2(length, kFriezeAt) / 1.5f), true, true),
        lower);
    glb.addNode(
        "frieze",
        glb.addGeometry(panel(corner + Vec3(0, kFriezeAt, 0), along, {0, top, 0}, Vec2(length, top) / 1.5f),
                        true, true),
        frieze);
  };
  addWall({-kW, 0, kL}, {0, 0, -2 * kL}, wall);
  addWall({kW, 0, -kL}, {0, 0, 2 * kL}, wall);
  addWall({-kW, 0, -kL}, {2 * kW, 0, 0}, endWall);
  addWall({kW, 0, kL}, {-2 * kW, 0, 0}, endWall);
  const int white = glb.addMaterial(lambert("mouldings", Vec3(.76f, .73f, .67f)));
  const int dark = glb.addMaterial(lambert("skirting", Vec3(.13f, .10f, .08f)));
  const int along = glb.addGeometry(box(Vec3(0), {0.05f, 1, 2 * kL})),
            across = glb.addGeometry(box(Vec3(0), {2 * kW, 1, 0.05f}));
  const auto band = [&](const char* name, int material, float y, float height) {
    for (const float side : {-1.f, 1.f}) {
      glb.addNode(name, along, material, {{side * (kW - 0.025f), y, 0}, {1, 0, 0, 0}, {1, height, 1}});
      glb.addNode(name, across, material, {{0, y, side * (kL - 0.025f)}, {1, 0, 0, 0}, {1, height, 1}});
    }
  };
  band("skirting", dark, 0.08f, 0.16f);
  band("picture rail", white, kFriezeAt, 0.10f);
  band("cornice", white, kH - 0.11f, 0.22f);
}

/// Six skylights over the aisle and six panels over the sides, all facing down.
void addCeiling(GlbWriter& glb) {
  const int white = glb.addMaterial(lambert("ceiling", Vec3(.80f, .78f, .73f)));
  const int bars = glb.addMaterial(lambert("skylight bars", Vec3(.05f)));
  glb.addNode("ceiling", glb.addGeometry(panel({-kW, kH, -kL}, {2 * kW, 0, 0}, {0, 0, 2 * kL})), white);
  const float w = 2.6f, l = 2.2f, y = kH - 0.04f;
  const int light = glb.addGeometry(panel({-w / 2, y, -l / 2}, {w, 0, 0}, {0, 0, l}));
  MeshData grid;
  for (int k = -1; k <= 1; ++k)
    grid.append(box({0.5f * w * static_cast<float>(k), y - 0.02f, 0}, {0.05f, 0.05f, l + 0.05f}));
  for (int k = -2; k <= 2; ++k)
    grid.append(box({0, y - 0.015f, 0.25f * l * static_cast<float>(k)}, {w, 0.04f, 0.04f}));
  const int gridShape = glb.addGeometry(grid),
            beam = glb.addGeometry(box({0, kH - 0.13f, 0}, {5.6f, 0.26f, 0.34f}));
  const int sky = glb.addMaterial(emitter("skylight", kSkylight)),
            side = glb.addMaterial(emitter("side light", kSideLight));
  const int sideLight = glb.addGeometry(panel({-0.3f, y, -1.3f}, {0.6f, 0, 0}, {0, 0, 2.6f}));
  for (int k = 0; k < 6; ++k) {
    const float z = 10 - 4 * static_cast<float>(k);
    glb.addNode("skylight", light, sky, standing({0, 0, z}));
    glb.addNode("skylight grid", gridShape, bars, standing({0, 0, z}));
    if (k < 5) glb.addNode("ceiling beam", beam, white, standing({0, 0, z - 2}));
  }
  for (const float z : {8.f, 0.f, -8.f})
    for (const float x : {-4.2f, 4.2f}) glb.addNode("side light", sideLight, side, standing({x, 0, z}));
}

void addColonnades(GlbWriter& glb) {
  constexpr float kShaft = 4.6f, kRadius = 0.21f;
  MaterialDesc stone = lambert("travertine", Vec3(1),
                               glb.addJpeg("travertine",
                                           paint(192, 192,
                                                 [](Vec2 uv) {
                                                   return travertineColor(uv, {.86f, .79f, .67f}, 71);
                                                 }),
                                           80));
  stone.normalTexture = glb.addPng(
      "travertine relief", normalMap(
                               96, [](Vec2 uv) { return travertineColor(uv, Vec3(1), 71).x; }, 0.006f));
  const int material = glb.addMaterial(stone);
  const int shape = glb.addGeometry(column(kShaft, kRadius), true, true);
  const int architrave =
      glb.addGeometry(box({0, 0.5f * (kShaft + kH), 0}, {0.56f, kH - kShaft, 2 * kL}, 1), true, true);
  for (const float side : {-1.f, 1.f}) {
    for (const float z : {-9.f, -3.f, 3.f, 9.f})
      glb.addNode("column", shape, material, standing({side * kColonnadeX, 0, z}));
    glb.addNode("architrave", architrave, material, standing({side * kColonnadeX, 0, 0}));
  }
}

}  // namespace

void addHall(GlbWriter& glb) {
  addAisle(glb);
  addParquet(glb);
  addWalls(glb);
  addCeiling(glb);
  addColonnades(glb);
}

}  // namespace saccade::data
