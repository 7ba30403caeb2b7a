#include "app/session/picking.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "raytrace/world.h"

namespace saccade::app {

namespace {

constexpr core::Rgba8 kInnerColor{20, 20, 20, 255};

std::string labelled(const char* name, const char* property, float value) {
  char text[64];
  std::snprintf(text, sizeof text, "%s, %s %.3g", name, property, static_cast<double>(value));
  return text;
}

/// The diffuse object that a ray through the pixel meets first. The mask has told that there is no other.
std::optional<std::uint32_t> objectByRay(const core::View& view, const raytrace::World& world,
                                         const core::Vec2& pixel) {
  raytrace::Hit hit;
  raytrace::RayCounters counters;
  const core::Vec3 direction = view.direction(pixel);
  const raytrace::Ray ray{view.camera().eye, direction, view.zNear(), view.zFar()};
  if (!world.intersectVisible(ray, hit, counters)) return std::nullopt;
  return hit.object;
}

class Pen {
 public:
  explicit Pen(core::ImageRgba8& picture) : picture_(picture) {}
  void dot(int x, int y, const core::Rgba8& color) {
    if (x >= 0 && y >= 0 && x < picture_.width() && y < picture_.height()) picture_.at(x, y) = color;
  }
  void line(const core::Vec2& a, const core::Vec2& b) {
    const core::Vec2 way = b - a;
    const float longest = std::max(std::abs(way.x), std::abs(way.y));
    const int steps =
        static_cast<int>(std::min(longest, 4.0f * static_cast<float>(picture_.width() + picture_.height())));
    for (int i = 0; i <= steps; ++i) {
      const core::Vec2 p = a + way * (static_cast<float>(i) / static_cast<float>(std::max(1, steps)));
      dot(static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)), kOutlineColor);
    }
  }

 private:
  core::ImageRgba8& picture_;
};

void outlineMask(std::uint32_t id, const core::FrameSnapshot& frame, core::ImageRgba8& picture) {
  if (id >= frame.extents.size()) return;
  const core::PixelBox& box = frame.extents[id].box;
  const int width = picture.width(), height = picture.height();
  const auto on = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < width && y < height && frame.idAt(x, y) == id;
  };
  const int x1 = std::min(box.x1 + 1, width), y1 = std::min(box.y1 + 1, height);
  for (int y = std::max(box.y0 - 1, 0); y < y1; ++y) {
    for (int x = std::max(box.x0 - 1, 0); x < x1; ++x) {
      const bool all = on(x - 1, y) && on(x + 1, y) && on(x, y - 1) && on(x, y + 1);
      const bool any = on(x - 1, y) || on(x + 1, y) || on(x, y - 1) || on(x, y + 1);
      if (on(x, y) ? !all : any) picture.at(x, y) = on(x, y) ? kInnerColor : kOutlineColor;
    }
  }
}

void outlineBox(const core::Bounds& bounds, const core::View& view, core::ImageRgba8& picture) {
  Pen pen(picture);
  const auto corner = [&](int i) {
    return core::Vec3(i & 1 ? bounds.hi.x : bounds.lo.x, i & 2 ? bounds.hi.y : bounds.lo.y,
                      i & 4 ? bounds.hi.z : bounds.lo.z);
  };
  // In pieces, so that an edge that passes the eye is drawn as far as it lies before it.
  constexpr int kPieces = 64;
  for (int i = 0; i < 8; ++i) {
    for (int axis = 1; axis <= 4; axis *= 2) {
      if (i & axis) continue;
      std::optional<core::View::Projected> last;
      for (int k = 0; k <= kPieces; ++k) {
        const auto now = view.project(glm::mix(corner(i), corner(i | axis), static_cast<float>(k) / kPieces));
        if (last && now) pen.line(last->pixel, now->pixel);
        last = now;
      }
    }
  }
}

}  // namespace

std::optional<PickedObject> pick(const core::FrameSnapshot& frame, const raytrace::World& world, int x,
                                 int y) {
  const float depth = frame.depth[frame.index(x, y)];
  if (!(depth > 0)) return std::nullopt;
  const core::Vec2 pixel(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
  const std::uint32_t id = frame.idAt(x, y);
  const auto object = id > 0 ? world.objectOfId(id) : objectByRay(frame.view, world, pixel);
  if (!object) return std::nullopt;
  const core::Object& o = world.scene().objects[*object];
  const core::Material& material = world.scene().materials[static_cast<std::size_t>(o.material)];
  PickedObject picked;
  picked.object = *object;
  picked.id = o.id;
  picked.name = o.name;
  picked.material = material.name;
  picked.lobes = lobesOf(material);
  picked.position = frame.view.unproject(pixel, depth);
  picked.distance = glm::length(picked.position - frame.view.camera().eye);
  return picked;
}

std::vector<std::string> lobesOf(const core::Material& m) {
  if (m.unlit) return {"unlit"};
  std::vector<std::string> lobes;
  if (m.emits()) lobes.push_back("emits light");
  if (m.ward) {
    lobes.push_back("diffuse");
    lobes.push_back(labelled("Ward gloss", "slope", std::max(m.ward->alphaX, m.ward->alphaY)));
    return lobes;
  }
  if (m.metallic > 0) lobes.push_back(labelled("metal", "roughness", m.roughness));
  if (m.metallic < 1) {
    if (m.transmission < 1) lobes.push_back("diffuse");
    if (m.transmission > 0) lobes.push_back(labelled(m.thinWalled ? "thin glass" : "glass", "index", m.ior));
    if (m.specular > 0 && m.ior > 1) lobes.push_back(labelled("gloss", "roughness", m.roughness));
  }
  if (m.clearcoat > 0) lobes.push_back(labelled("clear coat", "roughness", m.clearcoatRoughness));
  if (m.sheenColor != core::Vec3(0)) lobes.push_back(labelled("sheen", "roughness", m.sheenRoughness));
  if (m.iridescence > 0) lobes.push_back("iridescent");
  if (m.anisotropy > 0) lobes.push_back("brushed");
  return lobes;
}

void outline(const PickedObject& picked, const core::Scene& scene, const core::FrameSnapshot& frame,
             core::ImageRgba8& picture) {
  if (picked.id > 0) return outlineMask(picked.id, frame, picture);
  outlineBox(scene.objects[picked.object].bounds, frame.view, picture);
}

}  // namespace saccade::app
