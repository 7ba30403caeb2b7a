// Small scenes with known light, and what a bake of them shows.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "core/maps.h"
#include "core/scene/scene.h"
#include "raytrace/bake/baker.h"
#include "raytrace/bake/charts.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

/// Builds a scene of flat and curved patches.
class SceneBuilder {
 public:
  using Vec3 = core::Vec3;

  /// A Lambert material without any specular lobe.
  static core::Material matte(float albedo, Vec3 emission = Vec3(0)) {
    core::Material m;
    m.baseColor = Vec3(albedo);
    m.metallic = 0;
    m.roughness = 1;
    m.specular = 0;
    m.emission = emission;
    return m;
  }

  /// One object: n x m quads over [0, 1]^2, front where d/ds x d/dt points. Returns its index.
  int patch(const core::Material& material, int n, int m, const std::function<Vec3(float, float)>& place) {
    core::Mesh mesh;
    for (int y = 0; y <= m; ++y) {
      for (int x = 0; x <= n; ++x) {
        const float s = static_cast<float>(x) / static_cast<float>(n),
                    t = static_cast<float>(y) / static_cast<float>(m);
        mesh.positions.push_back(place(s, t));
        const float step = 1e-3f;
        mesh.normals.push_back(glm::normalize(
            glm::cross(place(s + step, t) - place(s - step, t), place(s, t + step) - place(s, t - step))));
      }
    }
    const auto v = [n](int x, int y) { return static_cast<std::uint32_t>(y * (n + 1) + x); };
    for (int y = 0; y < m; ++y) {
      for (int x = 0; x < n; ++x) {
        for (std::uint32_t i :
             {v(x, y), v(x + 1, y), v(x + 1, y + 1), v(x, y), v(x + 1, y + 1), v(x, y + 1)}) {
          mesh.indices.push_back(i);
        }
      }
    }
    return add(material, std::move(mesh));
  }

  int quad(const core::Material& material, Vec3 corner, Vec3 u, Vec3 v) {
    return patch(material, 1, 1, [=](float s, float t) { return corner + s * u + t * v; });
  }

  /// Inner or outer faces of a box.
  void box(const core::Material& material, Vec3 lo, Vec3 hi, bool inside) {
    const Vec3 e = hi - lo, x(e.x, 0, 0), y(0, e.y, 0), z(0, 0, e.z);
    const auto face = [&](Vec3 corner, Vec3 u, Vec3 v) {
      inside ? quad(material, corner, v, u) : quad(material, corner, u, v);
    };
    face(lo, x, z);
    face(lo + y, z, x);
    face(lo, y, x);
    face(lo + z, x, y);
    face(lo, z, y);
    face(lo + x, y, z);
  }

  /// A closed room of 2 m from x on, of albedo 1/2; below its ceiling a lamp of 0.6 m from `lampX` on.
  void room(float x, float lampX, float radiance) {
    box(matte(0.5f), Vec3(x, 0, 0), Vec3(x + 2, 2, 2), true);
    quad(matte(0, Vec3(radiance)), Vec3(lampX, 1.9f, 0.7f), Vec3(0.6f, 0, 0), Vec3(0, 0, 0.6f));
  }

  /// A disk facing down as a fan of `sides` triangles with the true disk's area.
  int disk(const core::Material& material, Vec3 center, float radius, int sides) {
    core::Mesh mesh;
    const float sector = 2 * core::kPi / static_cast<float>(sides);
    const float r = radius * std::sqrt(sector / std::sin(sector));
    mesh.positions.push_back(center);
    for (int i = 0; i < sides; ++i) {
      const float a = sector * static_cast<float>(i);
      mesh.positions.push_back(center + Vec3(r * std::cos(a), 0, r * std::sin(a)));
      for (int k : {0, 1 + i, 1 + (i + 1) % sides}) mesh.indices.push_back(static_cast<std::uint32_t>(k));
    }
    mesh.normals.assign(mesh.positions.size(), Vec3(0, -1, 0));
    return add(material, std::move(mesh));
  }

  core::Scene scene;

 private:
  int add(const core::Material& material, core::Mesh mesh) {
    core::Object object;
    object.name = "object " + std::to_string(scene.objects.size());
    object.material = static_cast<int>(scene.materials.size());
    for (const Vec3& p : mesh.positions) object.bounds.add(p);
    scene.bounds.add(object.bounds);
    scene.materials.push_back(material);
    scene.add(std::move(object), std::move(mesh));
    return static_cast<int>(scene.objects.size()) - 1;
  }
};

/// A job that is given it pauses after each piece of work.
inline std::stop_token stopped() {
  std::stop_source source;
  source.request_stop();
  return source.get_token();
}

/// Few particles, quality medium.
inline BakeOptions mediumBake(std::uint64_t photons) {
  BakeOptions o;
  o.quality = "medium";
  o.photons = photons;
  o.threads = 2;
  return o;
}

/// A scene with its maps, ready for look-ups.
class Baked {
 public:
  Baked(core::Scene scene, int atlasSize, const BakeOptions& options) : scene_(std::move(scene)) {
    core::Plan plan;
    plan.lightmapSize = atlasSize;
    ChartAtlas atlas = makeCharts(scene_, plan, atlasSize);
    core::applyCharts(scene_, atlas.charts);
    world_ = std::make_unique<World>(scene_, plan);
    maps_ = bakeMaps(*world_, std::move(atlas.charts), atlas.size, options, {});
    world_->setMaps(&maps_);
    texelMetres_ = atlas.texelMetres;
  }

  /// Irradiance of an object at its point nearest to `position`, on its triangles' planes.
  core::Vec3 irradiance(int objectIndex, const core::Vec3& world, int layer = 0) const {
    const core::Object& object = scene_.objects[static_cast<std::size_t>(objectIndex)];
    const core::Mesh& mesh = scene_.meshOf(object);
    const core::Vec3 position(glm::inverse(object.meshToWorld) * core::Vec4(world, 1));
    core::Vec3 found(-1);
    float nearest = core::kInfinity;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
      const auto corner = [&](std::size_t c) { return mesh.indices[3 * t + c]; };
      const core::Vec3 a = mesh.positions[corner(0)], e = mesh.positions[corner(1)] - a,
                       f = mesh.positions[corner(2)] - a, d = position - a;
      const core::Vec3 n = glm::cross(e, f);
      const float u = glm::dot(glm::cross(d, f), n) / glm::dot(n, n);
      const float v = glm::dot(glm::cross(e, d), n) / glm::dot(n, n);
      if (u < -1e-4f || v < -1e-4f || u + v > 1.0002f) continue;
      const float away = std::abs(glm::dot(d, glm::normalize(n)));
      if (!(away < nearest)) continue;
      nearest = away;
      const core::Vec2 uv = mesh.lightmapUv[corner(0)] * (1 - u - v) + mesh.lightmapUv[corner(1)] * u +
                            mesh.lightmapUv[corner(2)] * v;
      found = world_->irradiance(core::placeInAtlas(object.lightmapScaleOffset, uv), layer);
    }
    return found;
  }

  const World& world() const { return *world_; }
  const core::Scene& scene() const { return scene_; }
  const core::IlluminationMaps& maps() const { return maps_; }
  float texelMetres() const { return texelMetres_; }

 private:
  core::Scene scene_;
  std::unique_ptr<World> world_;
  core::IlluminationMaps maps_;
  float texelMetres_ = 0;
};

}  // namespace saccade::raytrace
