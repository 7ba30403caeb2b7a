// The scene's textures and the illumination maps on the GL side. GL thread only.
#pragma once

#include "core/maps.h"
#include "core/scene/scene.h"
#include "render/base/portions.h"
#include "render/context/gl_object.h"

namespace saccade::render {

/// SRGB8_ALPHA8 or RGBA8 with mipmaps. Throws core::Error when the texture exceeds `maxSide`. The arguments
/// must stay where they are until the portions are done.
void addUpload(const Gl& gl, const core::Texture& texture, int maxSide, GlTexture& into, Portions& portions);

/// Illumination maps: one texture for the atlas and its detail, so that a look-up reads one.
struct MapTextures {
  int layers = 0;    ///< 0: no maps
  GlTexture texels;  ///< RGB16F array, linear filter, one layer per side: atlas, its last row again, detail
  GlTexture blocks;  ///< R32UI, MapBlock::packed by texel of the atlas; none without detail
};

/// Likewise; also throws for maps whose counts disagree.
void addUpload(const Gl& gl, const core::IlluminationMaps& maps, int maxSide, MapTextures& into,
               Portions& portions);

}  // namespace saccade::render
