// Material presets. Lambert surfaces switch the dielectric's 4 % lobe off (KHR_materials_specular 0), so that
// what is called diffuse here is nothing else.
#pragma once

#include <string>

#include "data/make_scenes/glb_writer.h"

namespace saccade::data {

MaterialDesc lambert(const std::string& name, const Vec3& color, int colorTexture = -1);
MaterialDesc metal(const std::string& name, const Vec3& color, float roughness);
/// Smooth clear glass, index of refraction 1.5.
MaterialDesc glass(const std::string& name, const Vec3& tint = Vec3(1));
/// Colour under a strong clear coat: glazed ceramic, lacquer, polished stone. `ior` well above 1.5 lifts its
/// reflection over the threshold of non-diffuse.
MaterialDesc glazed(const std::string& name, const Vec3& color, int colorTexture, float ior, float roughness);
/// Ward's lobe over Lambert (core::WardLobe), which glTF lacks: it goes into `extras`; programs that do not
/// read it see a metal or a plastic of about the same gloss. `alpha` x is along the surface's u.
MaterialDesc ward(const std::string& name, const Vec3& diffuse, const Vec3& specular, const Vec2& alpha);
MaterialDesc emitter(const std::string& name, const Vec3& radiance);

inline const Vec3 kGold{1.00f, 0.77f, 0.34f};
inline const Vec3 kCopper{0.95f, 0.64f, 0.54f};
inline const Vec3 kSilver{0.97f, 0.96f, 0.92f};
inline const Vec3 kSteel{0.66f, 0.66f, 0.68f};
inline const Vec3 kBrass{0.90f, 0.75f, 0.43f};
inline const Vec3 kBronze{0.72f, 0.47f, 0.28f};

}  // namespace saccade::data
