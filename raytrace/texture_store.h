// The scene's texels in the order in which rays want them: 4 x 4 texels to a cache line, on huge pages.
#pragma once

#include <cstdint>
#include <glm/mat3x2.hpp>
#include <vector>

#include "core/scene/scene.h"
#include "raytrace/huge_pages.h"
#include "raytrace/ray.h"

namespace saccade::raytrace {

/// The texels that one bilinear sample reads and how they mix. Found apart from reading them, so that their
/// way from memory passes behind other work.
struct TexelFootprint {
  std::uint32_t at[4] = {};   ///< upper left, upper right, lower left, lower right
  float right = 0, down = 0;  ///< shares of the right and of the lower texels, [0, 1]
};

/// One texture as a material reads it. Points into a TextureStore.
struct TextureView {
  const std::uint32_t* texels = nullptr;  ///< RGBA, R in the lowest byte; tiled
  const float* decode = nullptr;          ///< byte to linear colour, 256 entries
  int width = 0, height = 0;
  int tilesAcross = 0;
  core::Wrap wrapS = core::Wrap::repeat, wrapT = core::Wrap::repeat;
  bool nearest = false;
  bool transformed = false;
  std::uint8_t uvSet = 0;
  glm::mat3x2 uvMatrix{1};  ///< read only where `transformed` (core/scene/texture_transform.h)

  explicit operator bool() const { return texels != nullptr; }
  /// Where a mesh's uv falls in the texture, wrapping left out.
  Vec2 place(const Vec2& meshUv) const { return transformed ? uvMatrix * Vec3(meshUv, 1) : meshUv; }
  /// Bilinear (or nearest) RGBA at the mesh's uv, which KHR_texture_transform moves first; colour decoded to
  /// linear. v runs downwards. Beyond +-1e6 and for NaN, uv = 0.
  core::Vec4 sample(const Vec2& meshUv) const { return mix(footprint(meshUv)); }
  /// The two halves of sample().
  TexelFootprint footprint(const Vec2& meshUv) const;
  core::Vec4 mix(const TexelFootprint& f) const;
  void prefetch(const TexelFootprint& f) const {
    __builtin_prefetch(texels + f.at[0]);
    __builtin_prefetch(texels + f.at[3]);
  }
};

class TextureStore {
 public:
  explicit TextureStore(const core::Scene& scene);
  /// False (no texels) for an empty slot.
  TextureView view(const core::TextureSlot& slot) const;

 private:
  HugeVector<std::uint32_t> texels_;
  std::vector<TextureView> views_;  ///< by texture
};

}  // namespace saccade::raytrace
