#include "raytrace/bake/change_scenes.h"

#include <algorithm>
#include <unordered_map>

namespace saccade::raytrace {
namespace {

using core::PunctualLight;
using core::Vec3;

/// Equal but for names and intensities.
bool placedAlike(const PunctualLight& a, const PunctualLight& b) {
  return a.type == b.type && a.position == b.position && a.direction == b.direction && a.range == b.range &&
         a.cosInner == b.cosInner && a.cosOuter == b.cosOuter;
}

/// Punctual lights by what became of them.
struct LightSets {
  std::vector<PunctualLight> stayed;  ///< as bright as before
  std::vector<PunctualLight> added;   ///< new ones; and those of another intensity, by its difference
  std::vector<PunctualLight> gone;
};

LightSets sortLights(const std::vector<PunctualLight>& before, const std::vector<PunctualLight>& now) {
  LightSets sets;
  sets.gone = before;
  for (const PunctualLight& light : now) {
    const auto same = [&](const PunctualLight& o) { return placedAlike(light, o); };
    PunctualLight changed = light;
    const auto found = std::find_if(sets.gone.begin(), sets.gone.end(), same);
    if (found != sets.gone.end()) {
      changed.intensity = glm::abs(light.intensity - found->intensity);
      sets.stayed.push_back(*found);
      sets.gone.erase(found);
    }
    if (changed.intensity != Vec3(0)) sets.added.push_back(changed);
  }
  return sets;
}

/// Gives an object a material of its own.
void dress(core::Scene& scene, core::Object& object, const core::Material& material) {
  object.material = static_cast<int>(scene.materials.size());
  scene.materials.push_back(material);
}

const core::Material& plainOf(const core::SceneState& state, std::size_t object) {
  return state.plain.materials[static_cast<std::size_t>(state.plain.objects[object].material)];
}

core::Bounds allBounds(const ChangedScene& c) {
  core::Bounds bounds = c.now.bounds;
  for (const core::Object& o : c.before.plain.objects) bounds.add(o.bounds);
  return bounds;
}

/// Numbers of non-diffuse objects without gaps.
void renumber(core::Scene& scene) {
  std::uint32_t next = 0;
  for (core::Object& o : scene.objects)
    if (o.id != 0) o.id = ++next;
}

/// Objects that are still there as they were, or as they are with plain materials; new ones not at all.
core::Scene withoutNew(const ChangedScene& c) {
  core::Scene scene = c.now;
  scene.objects.clear();
  for (std::size_t o = 0; o < c.now.objects.size(); ++o) {
    if (c.match.before[o] == SceneMatch::kNone) continue;
    const auto b = static_cast<std::size_t>(c.match.before[o]);
    core::Object object = c.now.objects[o];
    core::Material material = c.now.materials[static_cast<std::size_t>(object.material)];
    if (c.match.sameLook[o])
      material.emission = c.before.objects[b].emission;
    else
      material = plainOf(c.before, b);
    dress(scene, object, material);
    scene.objects.push_back(std::move(object));
  }
  return scene;
}

void addGone(const ChangedScene& c, core::Scene& scene) {
  std::unordered_map<std::uint32_t, std::uint32_t> meshes;
  for (const std::uint32_t b : c.match.gone) {
    core::Object object = c.before.plain.objects[b];
    const auto [place, fresh] =
        meshes.try_emplace(object.mesh, static_cast<std::uint32_t>(scene.meshes.size()));
    if (fresh) {
      core::Mesh mesh = c.before.plain.meshes[object.mesh];
      mesh.lightmapUv.assign(mesh.positions.size(), core::Vec2(0));
      scene.meshes.push_back(std::move(mesh));
    }
    object.mesh = place->second;
    object.lightmapScaleOffset = core::Vec4(1, 1, 0, 0);
    dress(scene, object, plainOf(c.before, b));
    scene.objects.push_back(std::move(object));
  }
}

/// The earlier objects as they shone.
core::Scene earlierScene(const ChangedScene& c) {
  core::Scene scene = withoutNew(c);
  addGone(c, scene);
  renumber(scene);
  scene.bounds = allBounds(c);
  return scene;
}

/// By how much the emission of an object changed that is where it was; textures' means where its look did.
Vec3 emissionChange(const ChangedScene& c, std::size_t o) {
  const auto b = static_cast<std::size_t>(c.match.before[o]);
  if (c.match.sameLook[o]) return glm::abs(c.stateNow.objects[o].emission - c.before.objects[b].emission);
  return glm::abs(plainOf(c.stateNow, o).emission - plainOf(c.before, b).emission);
}

}  // namespace

core::Scene sceneNow(const ChangedScene& c) {
  core::Scene scene = c.now;
  scene.bounds = allBounds(c);
  scene.lights = sortLights(c.before.lights, c.now.lights).stayed;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    core::Object& object = scene.objects[o];
    const std::int32_t before = c.match.before[o];
    core::Material material = c.match.sameLook[o] ? scene.materials[static_cast<std::size_t>(object.material)]
                                                  : plainOf(c.stateNow, o);
    if (before == SceneMatch::kNone)
      material.emission = Vec3(0);
    else if (c.match.sameLook[o])
      material.emission = c.before.objects[static_cast<std::size_t>(before)].emission;
    else
      material.emission = plainOf(c.before, static_cast<std::size_t>(before)).emission;
    dress(scene, object, material);
  }
  return scene;
}

core::Scene sceneBefore(const ChangedScene& c) {
  core::Scene scene = earlierScene(c);
  scene.lights = sortLights(c.before.lights, c.now.lights).stayed;
  for (std::size_t i = scene.objects.size() - c.match.gone.size(); i < scene.objects.size(); ++i)
    scene.materials[static_cast<std::size_t>(scene.objects[i].material)].emission = Vec3(0);
  return scene;
}

core::Scene newLight(const ChangedScene& c) {
  core::Scene scene = c.now;
  LightSets sets = sortLights(c.before.lights, c.now.lights);
  scene.lights = std::move(sets.added);
  if (c.match.sameObjects()) scene.lights.insert(scene.lights.end(), sets.gone.begin(), sets.gone.end());
  scene.environment = nullptr;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    if (c.match.before[o] == SceneMatch::kNone) continue;
    core::Material material = scene.materials[static_cast<std::size_t>(scene.objects[o].material)];
    material.emission = emissionChange(c, o);
    if (!c.match.sameLook[o]) material.emissionTexture = {};
    dress(scene, scene.objects[o], material);
  }
  return scene;
}

core::Scene goneLight(const ChangedScene& c) {
  if (c.match.sameObjects()) return {};
  core::Scene scene = earlierScene(c);
  scene.lights = sortLights(c.before.lights, c.now.lights).gone;
  scene.environment = nullptr;
  for (std::size_t i = 0; i + c.match.gone.size() < scene.objects.size(); ++i)
    scene.materials[static_cast<std::size_t>(scene.objects[i].material)].emission = Vec3(0);
  return scene;
}

std::vector<std::string> namesOfLights(const ChangedScene& c) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    const std::string shown = name.empty() ? "(unnamed)" : name;
    if (std::find(names.begin(), names.end(), shown) == names.end()) names.push_back(shown);
  };
  const LightSets sets = sortLights(c.before.lights, c.now.lights);
  for (const PunctualLight& light : sets.added) add(light.name);
  for (const PunctualLight& light : sets.gone) add(light.name);
  for (std::size_t o = 0; o < c.now.objects.size(); ++o) {
    if (c.match.sameLook[o] && emissionChange(c, o) != Vec3(0)) add(c.now.objects[o].name);
  }
  return names;
}

}  // namespace saccade::raytrace
