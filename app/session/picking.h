// What lies under a pixel of a frame.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/corrective/messages.h"
#include "core/image.h"
#include "core/scene/scene.h"

namespace saccade::raytrace {
class World;
}

namespace saccade::app {

struct PickedObject {
  std::uint32_t object = 0;  ///< index into the scene's objects
  std::uint32_t id = 0;      ///< 0 = diffuse
  std::string name, material;
  std::vector<std::string> lobes;  ///< what light its material sends back, in a few words each
  float distance = 0;              ///< metres from the eye
  core::Vec3 position{0};          ///< of the point, in the world
};

/// The object that the frame shows at a pixel inside the image: by the id mask, where that says diffuse by
/// one ray. Nothing where the frame shows the background. The world must be of the frame's scene. Any thread.
std::optional<PickedObject> pick(const core::FrameSnapshot& frame, const raytrace::World& world, int x,
                                 int y);

/// Lobes of a material: "diffuse", "metal, roughness 0.2", "glass, index 1.5", ...
std::vector<std::string> lobesOf(const core::Material& material);

/// Light around the object's pixels, dark just inside, by the id mask; of a diffuse object, whose pixels
/// nothing tells apart, the edges of its bounding box. Sizes agree.
void outline(const PickedObject& picked, const core::Scene& scene, const core::FrameSnapshot& frame,
             core::ImageRgba8& picture);

inline constexpr core::Rgba8 kOutlineColor{255, 230, 60, 255};

}  // namespace saccade::app
