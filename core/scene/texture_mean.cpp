#include "core/scene/texture_mean.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/image_io.h"
#include "core/scene/thin_film.h"

namespace saccade::core {
namespace {

constexpr int kGrid = 512;

const std::array<float, 256>& decodeTable(bool srgb) {
  static const auto make = [](bool curve) {
    std::array<float, 256> t{};
    for (int i = 0; i < 256; ++i) {
      const float x = static_cast<float>(i) / 255.0f;
      t[static_cast<std::size_t>(i)] = curve ? decodeSrgb(x) : x;
    }
    return t;
  };
  static const std::array<float, 256> curved = make(true), straight = make(false);
  return srgb ? curved : straight;
}

Vec4 slotMean(const Scene& scene, const TextureSlot& slot) {
  return slot ? textureMean(scene.textures[static_cast<std::size_t>(slot.texture)]) : Vec4(1);
}

ThinFilm meanFilm(const Scene& scene, const Material& m) {
  if (!(m.iridescence > 0)) return {};
  ThinFilm film{m.iridescence * slotMean(scene, m.iridescenceTexture).x, m.iridescenceIor, 0};
  const float mix = slotMean(scene, m.iridescenceThicknessTexture).y;
  film.thickness = m.iridescenceThicknessMin + (m.iridescenceThicknessMax - m.iridescenceThicknessMin) * mix;
  return film;
}

}  // namespace

Vec4 textureMean(const Texture& texture) {
  const ImageRgba8& image = texture.image;
  if (image.empty()) return Vec4(1);
  const auto& decode = decodeTable(texture.srgb);
  const int stepX = std::max(1, image.width() / kGrid), stepY = std::max(1, image.height() / kGrid);
  double sum[4] = {};
  double count = 0;
  for (int y = stepY / 2; y < image.height(); y += stepY) {
    for (int x = stepX / 2; x < image.width(); x += stepX) {
      const Rgba8& p = image.at(x, y);
      sum[0] += static_cast<double>(decode[p.r]);
      sum[1] += static_cast<double>(decode[p.g]);
      sum[2] += static_cast<double>(decode[p.b]);
      sum[3] += p.a / 255.0;
      ++count;
    }
  }
  return Vec4(sum[0] / count, sum[1] / count, sum[2] / count, sum[3] / count);
}

MaterialMeans materialMeans(const Scene& scene, const Material& material) {
  MaterialMeans m;
  const Vec4 base = slotMean(scene, material.baseColorTexture);
  const Vec4 metallicRoughness = slotMean(scene, material.metallicRoughnessTexture);
  m.baseColor = material.baseColor * Vec3(base);
  m.alpha = material.alpha * base.w;
  m.metallic = material.metallic * metallicRoughness.z;
  m.roughness = material.roughness * metallicRoughness.y;
  m.transmission = material.transmission * slotMean(scene, material.transmissionTexture).x;

  const float specularWeight = slotMean(scene, material.specularTexture).w;
  const Vec3 specularTint(slotMean(scene, material.specularColorTexture));
  const Vec3 f0 = dielectricF0(material) * specularTint * specularWeight;
  const float f90 = dielectricF90(f0, material.specular * specularWeight);
  const ThinFilm film = meanFilm(scene, material);
  const Vec3 dielectric = filmedF0(film, f0, f90), metallic = filmedF0(film, m.baseColor, 1);
  const AlbedoPair mean = meanAlbedo(m.roughness);
  m.dielectricAlbedo = dielectric * mean.scale + f90 * mean.bias;
  m.metallicAlbedo = metallic * mean.scale + mean.bias;

  m.sheenColor = material.sheenColor * Vec3(slotMean(scene, material.sheenColorTexture));
  m.over.f0 = dielectric;
  m.over.f90 = f90;
  const float anisotropy = material.anisotropy * slotMean(scene, material.anisotropyTexture).z;
  m.over.roughness = roughnessOverLambert(m.roughness, anisotropy);
  m.over.sheen = std::max({m.sheenColor.x, m.sheenColor.y, m.sheenColor.z});
  m.over.sheenRoughness = material.sheenRoughness * slotMean(scene, material.sheenRoughnessTexture).w;
  m.over.coat = material.clearcoat * slotMean(scene, material.clearcoatTexture).x;
  m.over.coatRoughness = material.clearcoatRoughness * slotMean(scene, material.clearcoatRoughnessTexture).y;
  return m;
}

}  // namespace saccade::core
