// A thing of a scene file in another material on a stool in a room: what Figure 6 of Haber et al. 2001 shows.
#pragma once

#include <filesystem>

#include "core/scene/scene.h"

namespace saccade::bench {

/// Polished metal without colour of its own: metallic 1, roughness 0.
core::Material chrome();

/// All that does not shine by itself of a scene file, in one material instead of its own, half a metre tall
/// on a stool in a diffuse room with a chequered floor and a lamp. Completed, with one camera. The thing is
/// the only non-diffuse object (or several, where it is in pieces). Throws core::Error: the file cannot be
/// loaded, or it shows nothing.
core::Scene thingInRoom(const std::filesystem::path& file, const core::Material& material);

}  // namespace saccade::bench
