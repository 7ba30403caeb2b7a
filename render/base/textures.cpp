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

GlTexture uploadMaps(const Gl& gl, const core::IlluminationMaps& maps, int maxSide) {
  checkSide("the illumination map", maps.width, maps.height, maxSide);
  const std::size_t expected =
      std::size_t{3} * maps.width * maps.height * static_cast<std::size_t>(maps.layers);
  if (maps.layers < 1 || maps.layers > 2 || maps.texels.size() != expected) {
    throw core::Error("the illumination map holds " + std::to_string(maps.texels.size()) + " numbers where " +
                      std::to_string(expected) + " belong; bake it again");
  }
  GlTexture result(gl);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, result.name());
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 2);
  gl.TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGB16F, maps.width, maps.height, maps.layers, 0, GL_RGB,
                GL_HALF_FLOAT, maps.texels.data());
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  return result;
}

}  // namespace saccade::render
