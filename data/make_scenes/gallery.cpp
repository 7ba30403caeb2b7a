#include "data/make_scenes/gallery.h"

#include <algorithm>
#include <array>
#include <cmath>
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
  glb.addCamera({"main", {0.55f, 1.6f, 11.2f}, {-0.15f, 1.62f, 0.0f}, {0, 1, 0}, 60});
  glb.addCamera({"centrepiece", {1.75f, 1.6f, 1.9f}, {-0.1f, 1.15f, -3.0f}, {0, 1, 0}, 60});
  glb.addCamera({"treasures", {-0.9f, 1.6f, 6.6f}, {-3.4f, 1.35f, 6.5f}, {0, 1, 0}, 65});
  return glb;
}

namespace {

constexpr float kCell = 0.14f;     // metres from thing to thing
constexpr float kCabinetZ = 2.0f;  // the shelves' back

/// Shelves of dark wood behind and below the things.
void addShelves(GlbWriter& glb, int columns, int rows, float bottom) {
  const int wood = glb.addMaterial(lambert("shelf", {.20f, .16f, .13f}));
  const int back = glb.addMaterial(lambert("cabinet back", {.52f, .50f, .46f}));
  const float width = kCell * static_cast<float>(columns), height = kCell * static_cast<float>(rows);
  const int board = glb.addGeometry(box(Vec3(0), {width, 0.012f, 0.14f}));
  for (int row = 0; row <= rows; ++row)
    glb.addNode("shelf", board, wood,
                standing({0, bottom + kCell * static_cast<float>(row) - 0.006f, kCabinetZ + 0.07f}));
  glb.addNode("cabinet back",
              glb.addGeometry(box({0, bottom + height / 2, kCabinetZ - 0.02f}, {width, height, 0.04f})),
              back);
  glb.addNode("cabinet foot",
              glb.addGeometry(box({0, bottom / 2, kCabinetZ + 0.05f}, {width, bottom - 0.02f, 0.18f})), wood);
}

std::vector<int> cabinetShapes(GlbWriter& glb) {
  const auto vessel = [](const std::vector<Vec2>& outline) { return lathe(splineProfile(outline, 2), 14); };
  return {
      glb.addGeometry(lathe(sphereProfile(0.045f, 10), 14)),
      glb.addGeometry(lathe(torusProfile(0.034f, 0.014f, 8), 16)),
      glb.addGeometry(vessel({{0, -0.045f},
                              {0.025f, -0.044f},
                              {0.042f, -0.01f},
                              {0.018f, 0.03f},
                              {0.026f, 0.048f},
                              {0, 0.046f}})),
      glb.addGeometry(cutStone(0.045f, 0.08f, 10)),
      glb.addGeometry(vessel(
          {{0, -0.045f}, {0.032f, -0.04f}, {0.036f, 0.02f}, {0.014f, 0.035f}, {0.02f, 0.055f}, {0, 0.06f}})),
      glb.addGeometry(roundedBox(Vec3(0), Vec3(0.07f), 0.012f, 2))};
}

std::vector<int> cabinetMaterials(GlbWriter& glb) {
  std::vector<int> materials{
      glb.addMaterial(metal("gold", kGold, 0.12f)),     glb.addMaterial(metal("copper", kCopper, 0.2f)),
      glb.addMaterial(metal("silver", kSilver, 0.05f)), glb.addMaterial(metal("mirror", Vec3(0.94f), 0)),
      glb.addMaterial(metal("bronze", kBronze, 0.3f)),  glb.addMaterial(glass("glass"))};
  for (int k = 0; k < 10; ++k) {
    const float hue = 2 * core::kPi * static_cast<float>(k) / 10;
    const Vec3 color = 0.36f + 0.32f * Vec3(std::cos(hue), std::cos(hue - 2.094f), std::cos(hue + 2.094f));
    materials.push_back(glb.addMaterial(glazed("enamel " + std::to_string(k + 1), color, -1, 2.2f, 0.08f)));
  }
  return materials;
}

}  // namespace

GlbWriter makeCabinet(int objects) {
  constexpr int kMostObjects = 4000;
  if (objects < 1 || objects > kMostObjects)
    throw core::UsageError("--objects " + std::to_string(objects) + ": give a number from 1 to " +
                           std::to_string(kMostObjects));
  GlbWriter glb;
  addHall(glb);
  const int columns = static_cast<int>(std::ceil(std::sqrt(1.6 * objects))),
            rows = (objects + columns - 1) / columns;
  const float bottom = 0.35f;
  addShelves(glb, columns, rows, bottom);
  const std::vector<int> shapes = cabinetShapes(glb), materials = cabinetMaterials(glb);
  for (int k = 0; k < objects; ++k) {
    const auto key = static_cast<std::uint32_t>(k);
    const std::size_t shape = static_cast<std::size_t>(hash01(key, 1, 0) * static_cast<float>(shapes.size()));
    const std::size_t material =
        static_cast<std::size_t>(hash01(key, 2, 0) * static_cast<float>(materials.size()));
    const float x = kCell * (static_cast<float>(k % columns) - 0.5f * static_cast<float>(columns - 1));
    const float y = bottom + kCell * (static_cast<float>(k / columns) + 0.5f);
    Placement place = standing({x, y, kCabinetZ + 0.075f}, 360 * hash01(key, 3, 0));
    if (shape == 1)
      place.rotation = place.rotation * glm::angleAxis(core::kPi / 2, Vec3(1, 0, 0));  // rings stand
    if (shape == 3) place.translation.y -= 0.04f;  // cut stones start at their tip
    glb.addNode("thing " + std::to_string(k + 1), shapes[shape], materials[material], place);
  }
  const float height = kCell * static_cast<float>(rows), width = kCell * static_cast<float>(columns);
  const float distance = 0.5f * std::max(height, width) / std::tan(glm::radians(27.0f));
  const float middle = bottom + height / 2;
  glb.addCamera(
      {"main", {0, std::max(middle, 1.2f), kCabinetZ + distance}, {0, middle, kCabinetZ}, {0, 1, 0}, 58});
  return glb;
}

}  // namespace saccade::data
