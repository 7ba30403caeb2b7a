#include "data/make_scenes/gallery.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <string>

#include "core/error.h"
#include "data/make_scenes/materials.h"
#include "data/make_scenes/noise.h"
#include "data/make_scenes/profiles.h"
#include "data/make_scenes/scenes.h"
#include "data/make_scenes/shapes.h"

namespace saccade::data {

GlbWriter makeGallery() {
  GlbWriter glb;
  addHall(glb);
  addPictures(glb);
  addExhibits(glb);
  glb.addCamera({"main", {0.35f, 1.6f, 10.6f}, {-0.1f, 1.25f, 0.0f}, {0, 1, 0}, 60});
  glb.addCamera({"centrepiece", {1.2f, 1.6f, 4.6f}, {-0.15f, 1.0f, 0.6f}, {0, 1, 0}, 60});
  glb.addCamera({"treasures", {-0.6f, 1.6f, 6.9f}, {-3.4f, 1.25f, 5.7f}, {0, 1, 0}, 65});
  return glb;
}

namespace {

constexpr float kTribuneWidth = 5.4f;  // between the colonnades
constexpr float kTribuneBack = 0;      // z of its highest step's back

/// Steps that rise away from the visitor, one row of things on each.
struct Tribune {
  int columns, rows;
  float cell;  ///< metres: width of a place, rise and depth of a step

  Tribune(int objects)
      : columns(static_cast<int>(std::ceil(std::sqrt(1.6 * objects)))),
        rows((objects + columns - 1) / columns),
        cell(kTribuneWidth / static_cast<float>(columns)) {}
  float front() const { return kTribuneBack + cell * static_cast<float>(rows); }
  /// Middle of the tread where thing `k` stands.
  Vec3 place(int k) const {
    const auto column = static_cast<float>(k % columns), row = static_cast<float>(k / columns);
    return {cell * (column - 0.5f * static_cast<float>(columns - 1)), cell * (row + 1),
            front() - cell * (row + 0.5f)};
  }
};

MeshData steps(const Tribune& tribune) {
  MeshData mesh;
  const float cell = tribune.cell, half = kTribuneWidth / 2 + 0.05f;
  const Vec3 along(2 * half, 0, 0);
  for (int row = 0; row < tribune.rows; ++row) {
    const float y = cell * static_cast<float>(row), z = tribune.front() - y;
    mesh.append(panel({-half, y, z}, along, {0, cell, 0}));
    mesh.append(panel({-half, y + cell, z}, along, {0, 0, -cell}));
    mesh.append(panel({half, 0, z}, {0, 0, -cell}, {0, y + cell, 0}));
    mesh.append(panel({-half, 0, z - cell}, {0, 0, cell}, {0, y + cell, 0}));
  }
  mesh.append(panel({half, 0, kTribuneBack}, -along, {0, cell * static_cast<float>(tribune.rows), 0}));
  return mesh;
}

MeshData moved(const MeshData& mesh, const Vec3& by) {
  MeshData result;
  result.append(mesh, glm::translate(Mat4(1), by));
  return result;
}

/// Things about 0.8 wide that stand at y = 0, for a place of width 1.
std::vector<MeshData> thingShapes() {
  const auto vessel = [](const std::vector<Vec2>& outline) { return lathe(splineProfile(outline, 2), 14); };
  MeshData ring;
  ring.append(lathe(torusProfile(0.28f, 0.12f, 8), 16),
              glm::mat4_cast(glm::angleAxis(core::kPi / 2, Vec3(1, 0, 0))));
  return {moved(lathe(sphereProfile(0.4f, 10), 16), {0, 0.4f, 0}),
          moved(ring, {0, 0.4f, 0}),
          vessel({{0, 0}, {0.2f, 0.01f}, {0.38f, 0.3f}, {0.15f, 0.66f}, {0.22f, 0.82f}, {0, 0.8f}}),
          cutStone(0.4f, 0.7f, 10),
          vessel({{0, 0}, {0.28f, 0.03f}, {0.32f, 0.5f}, {0.13f, 0.68f}, {0.18f, 0.86f}, {0, 0.9f}}),
          roundedBox({0, 0.3f, 0}, Vec3(0.6f), 0.1f, 2)};
}

std::vector<int> thingMaterials(GlbWriter& glb) {
  std::vector<int> materials{
      glb.addMaterial(metal("gold", kGold, 0.12f)),     glb.addMaterial(metal("copper", kCopper, 0.2f)),
      glb.addMaterial(metal("silver", kSilver, 0.05f)), glb.addMaterial(metal("mirror", Vec3(0.94f), 0)),
      glb.addMaterial(metal("bronze", kBronze, 0.3f)),  glb.addMaterial(glass("glass"))};
  const std::array<Vec3, 8> enamels{{{.78f, .20f, .10f},
                                     {.08f, .20f, .46f},
                                     {.85f, .62f, .18f},
                                     {.16f, .42f, .34f},
                                     {.88f, .85f, .76f},
                                     {.42f, .62f, .66f},
                                     {.40f, .08f, .12f},
                                     {.06f, .06f, .07f}}};
  for (std::size_t k = 0; k < enamels.size(); ++k)
    materials.push_back(
        glb.addMaterial(glazed("enamel " + std::to_string(k + 1), enamels[k], -1, 2.2f, 0.08f)));
  return materials;
}

}  // namespace

GlbWriter makeTribune(int objects) {
  constexpr int kMostObjects = 4000;
  if (objects < 1 || objects > kMostObjects)
    throw core::UsageError("--objects " + std::to_string(objects) + ": give a number from 1 to " +
                           std::to_string(kMostObjects));
  GlbWriter glb;
  addHall(glb);
  const Tribune tribune(objects);
  glb.addNode("tribune", glb.addGeometry(steps(tribune)),
              glb.addMaterial(lambert("tribune", {.70f, .68f, .63f})));
  std::vector<int> shapes;
  for (const MeshData& shape : thingShapes()) shapes.push_back(glb.addGeometry(shape));
  const std::vector<int> materials = thingMaterials(glb);
  const auto choose = [](const std::vector<int>& from, std::uint32_t k, std::uint32_t use) {
    return from[static_cast<std::size_t>(hash01(k, use, 0) * static_cast<float>(from.size()))];
  };
  for (int k = 0; k < objects; ++k) {
    const auto key = static_cast<std::uint32_t>(k);
    const Vec3 hover(0, 1e-3f, 0);
    glb.addNode("thing " + std::to_string(k + 1), choose(shapes, key, 1), choose(materials, key, 2),
                standing(tribune.place(k) + hover, 360 * hash01(key, 3, 0), tribune.cell));
  }
  const float middle = 0.5f * tribune.front();
  glb.addCamera({"main", {0, 2.5f, tribune.front() + 5.0f}, {0, 0.9f * middle, middle}, {0, 1, 0}, 58});
  return glb;
}

}  // namespace saccade::data
