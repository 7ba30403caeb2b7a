#include "raytrace/extension.h"

namespace saccade::raytrace {

std::shared_ptr<const CompiledExtension> compileExtension(const core::Material& m,
                                                          const TextureStore& textures) {
  if (m.ward) {
    CompiledExtension c;
    c.ward = Ward{m.ward->specular, m.ward->alphaX, m.ward->alphaY};
    return std::make_shared<const CompiledExtension>(c);
  }
  if (!(m.clearcoat > 0 || m.anisotropy > 0 || m.sheenColor != Vec3(0) || m.iridescence > 0)) return nullptr;
  CompiledExtension c;
  c.clearcoat = m.clearcoat;
  c.clearcoatRoughness = m.clearcoatRoughness;
  c.clearcoatNormalScale = m.clearcoatNormalScale;
  c.anisotropy = m.anisotropy;
  c.anisotropyDirection = {std::cos(m.anisotropyRotation), std::sin(m.anisotropyRotation)};
  c.sheenColor = m.sheenColor;
  c.sheenRoughness = m.sheenRoughness;
  c.iridescence = m.iridescence;
  c.iridescenceIor = m.iridescenceIor;
  c.thicknessMin = m.iridescenceThicknessMin;
  c.thicknessMax = m.iridescenceThicknessMax;
  c.iridescenceTexture = textures.view(m.iridescenceTexture);
  c.iridescenceThicknessTexture = textures.view(m.iridescenceThicknessTexture);
  c.clearcoatTexture = textures.view(m.clearcoatTexture);
  c.clearcoatRoughnessTexture = textures.view(m.clearcoatRoughnessTexture);
  c.clearcoatNormalTexture = textures.view(m.clearcoatNormalTexture);
  c.anisotropyTexture = textures.view(m.anisotropyTexture);
  c.sheenColorTexture = textures.view(m.sheenColorTexture);
  c.sheenRoughnessTexture = textures.view(m.sheenRoughnessTexture);
  return std::make_shared<const CompiledExtension>(c);
}

}  // namespace saccade::raytrace
