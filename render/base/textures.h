// The scene's textures and the illumination maps on the GL side. GL thread only.
#pragma once

#include "core/maps.h"
#include "core/scene/scene.h"
#include "render/context/gl_object.h"

namespace saccade::render {

/// SRGB8_ALPHA8 or RGBA8 with mipmaps. Throws core::Error when the texture exceeds `maxSide`.
GlTexture uploadTexture(const Gl& gl, const core::Texture& texture, int maxSide);

/// RGB16F array, linear filter, one layer per side. Throws core::Error for maps whose counts disagree.
GlTexture uploadMaps(const Gl& gl, const core::IlluminationMaps& maps, int maxSide);

}  // namespace saccade::render
