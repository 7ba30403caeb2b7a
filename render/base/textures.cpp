#include "render/base/textures.h"

#include <string>

#include "core/error.h"

namespace saccade::render {

namespace {

GLint wrapMode(core::Wrap wrap) {
  switch (wrap) {
    case core::Wrap::clamp:
      return GL_CLAMP_TO_EDGE;
    case core::Wrap::mirror:
      return GL_MIRRORED_REPEAT;
    default:
      return GL_REPEAT;
  }
}

void checkSide(const std::string& what, int width, int height, int maxSide) {
  if (width < 1 || height < 1 || width > maxSide || height > maxSide) {
    throw core::Error(what + " is " + std::to_string(width) + "x" + std::to_string(height) +
                      " texels; this OpenGL context takes 1 to " + std::to_string(maxSide) + " a side");
  }
}

void checkCounts(const core::IlluminationMaps& maps) {
  const std::size_t expected =
      std::size_t{3} * maps.width * maps.height * static_cast<std::size_t>(maps.layers);
  if (maps.layers < 1 || maps.layers > 2 || maps.texels.size() != expected) {
    throw core::Error("the illumination map holds " + std::to_string(maps.texels.size()) + " numbers where " +
                      std::to_string(expected) + " belong; bake it again");
  }
  if (!core::fits(maps.detail, maps.width, maps.height, maps.layers))
    throw core::Error("the illumination map's detail does not fit its texels; bake it again");
}

/// Into the bound array: the atlas, its last row again, so that what lies beyond it is clamped, and the
/// detail.
void copyRows(const Gl& gl, const core::IlluminationMaps& maps) {
  const auto copy = [&](const std::uint16_t* from, int row, int rows, int layer) {
    gl.TexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, row, layer, maps.width, rows, 1, GL_RGB, GL_HALF_FLOAT, from);
  };
  const std::size_t numbers = std::size_t{3} * maps.width;  // of a row
  for (int layer = 0; layer < maps.layers; ++layer) {
    const std::uint16_t* atlas = maps.texels.data() + numbers * maps.height * layer;
    copy(atlas, 0, maps.height, layer);
    copy(atlas + numbers * (maps.height - 1), maps.height, 1, layer);
    copy(maps.detail.texels.data() + numbers * maps.detail.height * layer, maps.height + 1,
         maps.detail.height, layer);
  }
}

GlTexture uploadBlocks(const Gl& gl, const core::IlluminationMaps& maps) {
  GlTexture blocks(gl);
  gl.BindTexture(GL_TEXTURE_2D, blocks.name());
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_R32UI, maps.width, maps.height, 0, GL_RED_INTEGER, GL_UNSIGNED_INT,
                maps.detail.blocks.data());
  for (const GLenum filter : {GL_TEXTURE_MAG_FILTER, GL_TEXTURE_MIN_FILTER})
    gl.TexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
  return blocks;
}

}  // namespace

GlTexture uploadTexture(const Gl& gl, const core::Texture& texture, int maxSide) {
  const core::ImageRgba8& image = texture.image;
  checkSide("texture '" + texture.name + "'", image.width(), image.height(), maxSide);
  GlTexture result(gl);
  gl.BindTexture(GL_TEXTURE_2D, result.name());
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl.TexImage2D(GL_TEXTURE_2D, 0, texture.srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, image.width(), image.height(), 0,
                GL_RGBA, GL_UNSIGNED_BYTE, image.pixels().data());
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrapMode(texture.wrapS));
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrapMode(texture.wrapT));
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, texture.nearest ? GL_NEAREST : GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl.GenerateMipmap(GL_TEXTURE_2D);
  return result;
}

MapTextures uploadMaps(const Gl& gl, const core::IlluminationMaps& maps, int maxSide) {
  checkCounts(maps);
  const bool detailed = !maps.detail.empty();
  const int width = maps.width, height = maps.height + (detailed ? 1 + maps.detail.height : 0);
  checkSide(detailed ? "the illumination map with its detail" : "the illumination map", width, height,
            maxSide);
  MapTextures out;
  out.layers = maps.layers;
  out.texels = GlTexture(gl);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, out.texels.name());
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 2);
  gl.TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGB16F, width, height, maps.layers, 0, GL_RGB, GL_HALF_FLOAT,
                detailed ? nullptr : maps.texels.data());
  for (const GLenum direction : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    gl.TexParameteri(GL_TEXTURE_2D_ARRAY, direction, GL_CLAMP_TO_EDGE);
  for (const GLenum filter : {GL_TEXTURE_MAG_FILTER, GL_TEXTURE_MIN_FILTER})
    gl.TexParameteri(GL_TEXTURE_2D_ARRAY, filter, GL_LINEAR);
  if (!detailed) return out;
  copyRows(gl, maps);
  out.blocks = uploadBlocks(gl, maps);
  return out;
}

}  // namespace saccade::render
