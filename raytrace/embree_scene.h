// Embree's side of World: included by its sources only.
#pragma once

#include <embree3/rtcore.h>

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "raytrace/world.h"

namespace saccade::raytrace {

inline constexpr std::uint32_t kNoObject = RTC_INVALID_GEOMETRY_ID;

/// What Embree hands to the filters. `base` comes first: Embree knows only that.
struct TraceContext {
  RTCIntersectContext base;
  /// One object is traced alone: its duplicates of other objects' triangles count.
  std::uint32_t alone = kNoObject;
  float transmittance = 1;  ///< of a shadow ray so far

  explicit TraceContext(std::uint32_t object = kNoObject) : alone(object) { rtcInitIntersectContext(&base); }
};

/// Per geometry, for the filters; geometries without either need none.
struct FilterData {
  const World* world = nullptr;
  std::uint32_t object = kNoObject;  ///< kNoObject for an instanced mesh: the instance says
  std::uint32_t firstTriangle = 0;
  bool alpha = false;
  std::vector<bool> duplicate;  ///< by triangle; empty when none
};

void filterIntersect(const RTCFilterFunctionNArguments* args);
void filterOccluded(const RTCFilterFunctionNArguments* args);

struct World::Embree {
  RTCDevice device = nullptr;
  RTCScene world = nullptr;
  std::vector<RTCScene> own;     ///< by object; null for diffuse and for instanced objects
  std::vector<RTCScene> meshes;  ///< by mesh; null unless instanced
  std::vector<std::unique_ptr<FilterData>> filters;
  std::atomic<std::int64_t> bytes{0};  ///< that Embree holds

  ~Embree() {
    for (const auto* scenes : {&own, &meshes}) {
      for (RTCScene s : *scenes) {
        if (s) rtcReleaseScene(s);
      }
    }
    if (world) rtcReleaseScene(world);
    if (device) rtcReleaseDevice(device);
  }
  /// The tree of one object that is not diffuse; that of an instanced one is in the space of its mesh.
  RTCScene alone(const core::Scene& scene, std::uint32_t object) const {
    return own[object] ? own[object] : meshes[scene.objects[object].mesh];
  }
  RTCScene newScene() const {
    RTCScene s = rtcNewScene(device);
    rtcSetSceneFlags(s, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(s, RTC_BUILD_QUALITY_MEDIUM);
    return s;
  }
  void check() const {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_CANCELLED) throw core::Error("stopped on request");
    throw core::Error("Embree failed with error " + std::to_string(static_cast<int>(error)) +
                      (error == RTC_ERROR_OUT_OF_MEMORY ? " (out of memory: use a smaller scene)" : ""));
  }
};

}  // namespace saccade::raytrace
