#include "data/make_scenes/materials.h"

#include <cmath>

namespace saccade::data {

MaterialDesc lambert(const std::string& name, const Vec3& color, int colorTexture) {
  MaterialDesc m;
  m.name = name;
  m.baseColor = color;
  m.baseColorTexture = colorTexture;
  m.specular = 0;
  return m;
}

MaterialDesc metal(const std::string& name, const Vec3& color, float roughness) {
  MaterialDesc m;
  m.name = name;
  m.baseColor = color;
  m.metallic = 1;
  m.roughness = roughness;
  return m;
}

MaterialDesc glass(const std::string& name, const Vec3& tint) {
  MaterialDesc m;
  m.name = name;
  m.baseColor = tint;
  m.roughness = 0;
  m.transmission = 1;
  return m;
}

MaterialDesc glazed(const std::string& name, const Vec3& color, int colorTexture, float ior,
                    float roughness) {
  MaterialDesc m;
  m.name = name;
  m.baseColor = color;
  m.baseColorTexture = colorTexture;
  m.ior = ior;
  m.roughness = roughness;
  return m;
}

MaterialDesc ward(const std::string& name, const Vec3& diffuse, const Vec3& specular, const Vec2& alpha) {
  const bool metallic = core::luminance(specular) > core::luminance(diffuse);
  MaterialDesc m;
  m.name = name;
  m.baseColor = metallic ? specular : diffuse;
  m.metallic = metallic ? 1 : 0;
  m.roughness = std::pow(alpha.x * alpha.y, 0.25f);  // GGX's alpha is about Ward's
  m.ward = core::WardLobe{diffuse, specular, alpha.x, alpha.y};
  return m;
}

MaterialDesc emitter(const std::string& name, const Vec3& radiance) {
  MaterialDesc m = lambert(name, Vec3(0));
  m.emission = radiance;
  return m;
}

}  // namespace saccade::data
