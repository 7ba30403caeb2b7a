#include "data/make_scenes/materials.h"

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

MaterialDesc emitter(const std::string& name, const Vec3& radiance) {
  MaterialDesc m = lambert(name, Vec3(0));
  m.emission = radiance;
  return m;
}

}  // namespace saccade::data
