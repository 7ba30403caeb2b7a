#include "core/scene/defaults.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/scene/instances.h"
#include "core/scene/placement.h"
#include "core/scene/texture_mean.h"

namespace saccade::core {
namespace {

constexpr float kPanelSide = 1, kPanelHeight = 0.95f, kPanelRadiance = 15;
/// Of a floor, m^2, that a panel of kPanelSide lights; over a larger one it grows with it.
constexpr float kPanelFloor = 200;
/// Emitters that would light the faces of the bounds by less than this, W/m^2 on average, light nothing one
/// would see: a lit label, windows painted white. A room keeps its light, around things most of it is lost.
constexpr double kDimRoom = 0.05, kDimOpen = 0.25;
constexpr float kFov = 60;
constexpr float kEyeHeight = 1.6f;
/// Metres. A room that is higher was not modelled in metres: its size says nothing of a person's.
constexpr float kHighestRoom = 100;
constexpr float kSmallestRoom = 1.2f;
/// Rays to each face of the bounds: a grid of this many points a side; a face is open when more than half
/// miss.
constexpr int kFaceGrid = 3;
/// A front nearer to the middle than this share of the way to the face belongs to a thing, not to a wall.
constexpr float kNearestWall = 0.4f;

struct Hit {
  float distance;  ///< in units of the direction's length
  bool front;
};

/// Whether the ray can meet the box before `within`, in units of the direction's length; says yes in doubt.
bool mayMeet(const Bounds& box, const Vec3& from, const Vec3& direction, float within) {
  const Vec3 slack = 1e-4f * (glm::abs(box.lo) + glm::abs(box.hi) + glm::abs(from));
  const Vec3 a = (box.lo - slack - from) / direction, b = (box.hi + slack - from) / direction;
  float enter = 0, leave = within;
  for (int c = 0; c < 3; ++c) {
    // NaN (0 / 0: in the plane of a side) changes nothing.
    enter = std::fmax(enter, std::fmin(a[c], b[c]));
    leave = std::fmin(leave, std::fmax(a[c], b[c]));
  }
  return enter <= leave;
}

/// visit(Hit) for whatever the ray meets, in no order, but for what it meets in boxes beyond `within`, which
/// visit may lower. Every triangle of the boxes met is tried: a few dozen rays once per scene do not pay for
/// a tree.
template <class Visit>
void forEachHit(const Scene& scene, const Vec3& worldFrom, const Vec3& worldDirection, const float& within,
                Visit&& visit) {
  for (const Object& o : scene.objects) {
    if (!mayMeet(o.bounds, worldFrom, worldDirection, within)) continue;
    Vec3 from = worldFrom, direction = worldDirection;
    bool mirrored = false;
    if (scene.meshOf(o).instanced) {
      const Placement place(o.meshToWorld);
      const Mat3 inverse = glm::inverse(place.linear);
      from = inverse * (from - place.translation);
      direction = inverse * direction;
      mirrored = place.mirrored;
    }
    const auto& p = scene.meshOf(o).positions;
    const auto& index = scene.meshOf(o).indices;
    for (std::size_t i = 0; i + 2 < index.size(); i += 3) {
      const Vec3 a = p[index[i]], e1 = p[index[i + 1]] - a, e2 = p[index[i + 2]] - a;
      const Vec3 across = glm::cross(direction, e2);
      const float determinant = glm::dot(e1, across);
      if (determinant == 0) continue;
      const Vec3 s = from - a;
      const float u = glm::dot(s, across) / determinant;
      if (!(u >= 0 && u <= 1)) continue;
      const Vec3 q = glm::cross(s, e1);
      const float v = glm::dot(direction, q) / determinant;
      if (!(v >= 0 && u + v <= 1)) continue;
      const float t = glm::dot(e2, q) / determinant;
      if (t > 0) visit(Hit{t, (determinant > 0) != mirrored});
    }
  }
}

std::optional<Hit> nearestHit(const Scene& scene, const Vec3& from, const Vec3& direction) {
  std::optional<Hit> nearest;
  float within = kInfinity;
  forEachHit(scene, from, direction, within, [&](const Hit& hit) {
    if (hit.distance >= within && nearest) return;
    nearest = hit;
    within = hit.distance;
  });
  return nearest;
}

struct FaceView {
  int hits = 0, fronts = 0, walls = 0;
};

/// Rays from the middle to a grid of points on one face of the bounds.
FaceView lookAtFace(const Scene& scene, int axis, bool positive) {
  FaceView seen;
  const Bounds& box = scene.bounds;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  for (int i = 0; i < kFaceGrid; ++i) {
    for (int j = 0; j < kFaceGrid; ++j) {
      Vec3 target;
      target[axis] = positive ? box.hi[axis] : box.lo[axis];
      // Off the symmetry planes, where edges like to lie.
      target[u] = glm::mix(box.lo[u], box.hi[u], 0.21f + 0.29f * static_cast<float>(i));
      target[v] = glm::mix(box.lo[v], box.hi[v], 0.22f + 0.285f * static_cast<float>(j));
      std::optional<Hit> nearest;
      bool wall = false;
      forEachHit(scene, box.center(), target - box.center(), kInfinity, [&](const Hit& hit) {
        if (!nearest || hit.distance < nearest->distance) nearest = hit;
        wall = wall || (hit.front && hit.distance > kNearestWall);
      });
      seen.hits += nearest.has_value();
      seen.fronts += nearest && nearest->front;
      seen.walls += wall;
    }
  }
  return seen;
}

Camera outside(const Bounds& box, const Vec3& towardsEye) {
  Camera camera;
  camera.name = "default camera";
  camera.fovYDegrees = kFov;
  camera.at = box.center();
  const float radius = std::max(0.5f * box.diagonal(), 1e-3f);
  camera.eye = camera.at + glm::normalize(towardsEye) * (radius / std::sin(glm::radians(0.5f * kFov)));
  return camera;
}

Camera beforeOpening(const Bounds& box, int axis, float side) {
  Camera camera = outside(box, Vec3(0, 0, 1));
  const Vec3 extent = box.extent();
  const float half = 0.5f * std::max(extent.y, extent[axis == 0 ? 2 : 0]);
  camera.eye = box.center();
  camera.eye[axis] += side * (0.5f * extent[axis] + 1.1f * half / std::tan(glm::radians(0.5f * kFov)));
  return camera;
}

/// Mean free way of a small fan of rays, each no longer than the room.
float freeWay(const Scene& scene, const Vec3& eye, const Vec3& forward, float longest) {
  const Vec3 right = glm::normalize(glm::cross(forward, Vec3(0, 1, 0)));
  float sum = 0;
  for (int i = -2; i <= 2; ++i) {
    for (int j = -1; j <= 1; ++j) {
      const Vec3 d = glm::normalize(forward + 0.23f * static_cast<float>(i) * right +
                                    0.21f * static_cast<float>(j) * Vec3(0, 1, 0));
      const auto hit = nearestHit(scene, eye, d);
      sum += hit ? std::min(hit->distance, longest) : 0;
    }
  }
  return sum;
}

Camera insideRoom(const Scene& scene) {
  const Bounds& box = scene.bounds;
  const Vec3 extent = box.extent();
  const float height = extent.y > kHighestRoom ? 0.6f * extent.y : std::min(kEyeHeight, 0.6f * extent.y);
  Camera best;
  float farthest = -1;
  for (const int axis : {0, 2}) {
    for (const float side : {-1.0f, 1.0f}) {
      for (const float aside : {0.0f, -0.25f, 0.25f}) {
        Camera c;
        c.name = "default camera";
        c.fovYDegrees = kFov;
        c.eye = box.center();
        c.eye.y = box.lo.y + height;
        c.eye[axis] += side * 0.4f * extent[axis];
        c.eye[2 - axis] += aside * extent[2 - axis];
        c.at = box.center();
        c.at.y = box.lo.y + 0.9f * height;
        const float way = freeWay(scene, c.eye, glm::normalize(c.at - c.eye), box.diagonal());
        if (way > farthest) farthest = way, best = c;
      }
    }
  }
  return best;
}

}  // namespace

Surroundings look(const Scene& scene) {
  Surroundings out;
  constexpr int kMost = kFaceGrid * kFaceGrid / 2 + 1;
  const FaceView floor = lookAtFace(scene, 1, false);
  int walls = 0, hits = floor.hits, fronts = floor.fronts;
  for (int side = 0; side < 4; ++side) {
    const FaceView face = lookAtFace(scene, side < 2 ? 0 : 2, side % 2 == 0);
    out.open[side] = face.hits < kMost;
    walls += face.walls >= kMost;
    hits += face.hits;
    fronts += face.fronts;
  }
  // A solid thing surrounds its middle too, but shows its backs there; things around the middle show it
  // no front far away; a shelf of samples is no room for a walker.
  const Vec3 extent = scene.bounds.extent();
  const bool roomy = std::min({extent.x, extent.y, extent.z}) >= kSmallestRoom;
  out.interior = roomy && floor.walls >= kMost && walls >= 3 && 3 * fronts >= 2 * hits;
  return out;
}

void addPanel(Scene& scene, const std::string& name, const Vec3& center, Vec2 size, const Vec3& direction,
              const Vec3& radiance) {
  Material material;
  material.name = name;
  material.baseColor = Vec3(0);
  material.metallic = 0;
  material.specular = 0;
  material.emission = radiance;
  scene.materials.push_back(material);

  Node node;
  node.name = name;
  scene.nodes.push_back(node);

  const Vec3 n = glm::normalize(direction);
  const Vec3 u = glm::normalize(glm::cross(std::abs(n.y) > 0.9f ? Vec3(0, 0, 1) : Vec3(0, 1, 0), n));
  const Vec3 v = glm::cross(n, u);
  Object object;
  object.name = name;
  object.node = static_cast<int>(scene.nodes.size()) - 1;
  object.material = static_cast<int>(scene.materials.size()) - 1;
  Mesh mesh;
  for (const Vec2 corner : {Vec2(-0.5f, -0.5f), Vec2(0.5f, -0.5f), Vec2(0.5f, 0.5f), Vec2(-0.5f, 0.5f)})
    mesh.positions.push_back(center + corner.x * size.x * u + corner.y * size.y * v);
  mesh.normals.assign(4, n);
  mesh.indices = {0, 1, 2, 0, 2, 3};
  scene.add(std::move(object), std::move(mesh));
}

namespace {

/// Of the panel of a room, metres.
float panelSide(const Vec3& room) {
  return kPanelSide * std::max(1.0f, std::sqrt(room.x * room.z / kPanelFloor));
}

/// Lowest height of what is above the panel's place, at most the top of the bounds.
float ceilingHeight(const Scene& scene, float side) {
  const Vec3 middle = scene.bounds.center();
  float height = scene.bounds.hi.y;
  for (const Vec2 corner :
       {Vec2(0), Vec2(-0.5f, -0.5f), Vec2(0.5f, -0.5f), Vec2(0.5f, 0.5f), Vec2(-0.5f, 0.5f)}) {
    const Vec3 from = middle + side * Vec3(corner.x, 0, corner.y);
    if (const auto hit = nearestHit(scene, from, Vec3(0, 1, 0)))
      height = std::min(height, from.y + hit->distance);
  }
  return height;
}

/// Unit, from the middle of a scene that is no room to its panel: above and to the left of the first camera,
/// so that it lights what the camera sees and stays out of the picture.
Vec3 keyDirection(const Scene& scene) {
  Vec3 toEye = scene.cameras.empty() ? Vec3(0, 0, 1) : scene.cameras[0].eye - scene.bounds.center();
  toEye.y = 0;
  if (!(glm::length(toEye) > 0)) toEye = Vec3(0, 0, 1);
  toEye = glm::normalize(toEye);
  const Vec3 left = glm::cross(toEye, Vec3(0, 1, 0));
  return glm::normalize(Vec3(0, 1, 0) + 0.55f * toEye + 0.6f * left);
}

}  // namespace

bool onlyDimEmitters(const Scene& scene, const Surroundings& around) {
  double watts = 0;
  for (const Object& o : scene.objects) {
    const Material& m = scene.materials[static_cast<std::size_t>(o.material)];
    if (!m.emits()) continue;
    const Vec3 texture =
        m.emissionTexture
            ? Vec3(textureMean(scene.textures[static_cast<std::size_t>(m.emissionTexture.texture)]))
            : Vec3(1);
    watts += std::numbers::pi * luminance(m.emission * texture) * surfaceArea(scene, o);
  }
  const Vec3 e = scene.bounds.extent();
  const double faces = 2.0 * (e.x * e.y + e.y * e.z + e.z * e.x);
  return watts < (around.interior ? kDimRoom : kDimOpen) * faces;
}

void addDefaultLight(Scene& scene, const Surroundings& around) {
  const Bounds& box = scene.bounds;
  Vec3 center = box.center(), direction(0, -1, 0);
  float side = panelSide(box.extent());
  if (around.interior) {
    center.y = glm::mix(box.lo.y, ceilingHeight(scene, side), kPanelHeight);
  } else {
    direction = -keyDirection(scene);
    center -= 1.25f * box.diagonal() * direction;
    side = 0.5f * box.diagonal();
  }
  addPanel(scene, "default light", center, Vec2(side), direction, Vec3(kPanelRadiance));
}

bool isNoMetreRoom(const Scene& scene, const Surroundings& around) {
  return around.interior && scene.bounds.extent().y > kHighestRoom;
}

Camera defaultCamera(const Scene& scene, const Surroundings& around) {
  if (!around.interior) return outside(scene.bounds, Vec3(0.6f, 0.45f, 1));
  for (int side = 0; side < 4; ++side)
    if (around.open[side]) return beforeOpening(scene.bounds, side < 2 ? 0 : 2, side % 2 == 0 ? 1.0f : -1.0f);
  return insideRoom(scene);
}

}  // namespace saccade::core
