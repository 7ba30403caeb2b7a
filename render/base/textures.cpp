#include "render/base/textures.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

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

void makeTexture(const Gl& gl, const core::Texture& texture, GlTexture& into) {
  const core::ImageRgba8& image = texture.image;
  into = GlTexture(gl);
  gl.BindTexture(GL_TEXTURE_2D, into.name());
  gl.TexImage2D(GL_TEXTURE_2D, 0, texture.srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, image.width(), image.height(), 0,
                GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrapMode(texture.wrapS));
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrapMode(texture.wrapT));
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, texture.nearest ? GL_NEAREST : GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
}

/// Rows of the maps: the atlas, its last row again, so that what lies beyond it is clamped, and the detail.
struct MapRows {
  const std::uint16_t* texels = nullptr;  ///< of the first
  int count = 0;
  int at = 0;  ///< of the texture
  int layer = 0;
};

std::vector<MapRows> rowsOf(const core::IlluminationMaps& maps) {
  const std::size_t numbers = std::size_t{3} * maps.width;  // of a row
  std::vector<MapRows> out;
  for (int layer = 0; layer < maps.layers; ++layer) {
    const std::uint16_t* atlas = maps.texels.data() + numbers * maps.height * layer;
    out.push_back({atlas, maps.height, 0, layer});
    if (maps.detail.empty()) continue;
    out.push_back({atlas + numbers * (maps.height - 1), 1, maps.height, layer});
    out.push_back({maps.detail.texels.data() + numbers * maps.detail.height * layer, maps.detail.height,
                   maps.height + 1, layer});
  }
  return out;
}

void copyRows(const Gl& gl, const MapTextures& into, int width, const MapRows& rows) {
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, into.texels.name());
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 2);
  gl.TexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, rows.at, rows.layer, width, rows.count, 1, GL_RGB,
                   GL_HALF_FLOAT, rows.texels);
}

int heightOf(const core::IlluminationMaps& maps) {
  return maps.height + (maps.detail.empty() ? 0 : 1 + maps.detail.height);
}

void makeMaps(const Gl& gl, const core::IlluminationMaps& maps, MapTextures& into) {
  into.layers = maps.layers;
  into.texels = GlTexture(gl);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, into.texels.name());
  gl.TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGB16F, maps.width, heightOf(maps), maps.layers, 0, GL_RGB,
                GL_HALF_FLOAT, nullptr);
  for (const GLenum direction : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    gl.TexParameteri(GL_TEXTURE_2D_ARRAY, direction, GL_CLAMP_TO_EDGE);
  for (const GLenum filter : {GL_TEXTURE_MAG_FILTER, GL_TEXTURE_MIN_FILTER})
    gl.TexParameteri(GL_TEXTURE_2D_ARRAY, filter, GL_LINEAR);
}

void addBlocks(const Gl& gl, const core::IlluminationMaps& maps, GlTexture& into, Portions& portions) {
  portions.add([&gl, &maps, &into] {
    into = GlTexture(gl);
    gl.BindTexture(GL_TEXTURE_2D, into.name());
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_R32UI, maps.width, maps.height, 0, GL_RED_INTEGER, GL_UNSIGNED_INT,
                  nullptr);
    for (const GLenum filter : {GL_TEXTURE_MAG_FILTER, GL_TEXTURE_MIN_FILTER})
      gl.TexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
  });
  rowsInPortions(maps.width, maps.height, [&](int row, int rows) {
    portions.add([&gl, &maps, &into, row, rows] {
      gl.BindTexture(GL_TEXTURE_2D, into.name());
      gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
      gl.TexSubImage2D(GL_TEXTURE_2D, 0, 0, row, maps.width, rows, GL_RED_INTEGER, GL_UNSIGNED_INT,
                       maps.detail.blocks.data() + static_cast<std::size_t>(row) * maps.width);
    });
  });
}

}  // namespace

void addUpload(const Gl& gl, const core::Texture& texture, int maxSide, GlTexture& into, Portions& portions) {
  const core::ImageRgba8& image = texture.image;
  checkSide("texture '" + texture.name + "'", image.width(), image.height(), maxSide);
  portions.add([&gl, &texture, &into] { makeTexture(gl, texture, into); });
  rowsInPortions(image.width(), image.height(), [&](int row, int rows) {
    portions.add([&gl, &image, &into, row, rows] {
      gl.BindTexture(GL_TEXTURE_2D, into.name());
      gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
      gl.TexSubImage2D(GL_TEXTURE_2D, 0, 0, row, image.width(), rows, GL_RGBA, GL_UNSIGNED_BYTE,
                       &image.at(0, row));
    });
  });
  portions.add([&gl, &into] {
    gl.BindTexture(GL_TEXTURE_2D, into.name());
    gl.GenerateMipmap(GL_TEXTURE_2D);
  });
}

void addUpload(const Gl& gl, const core::IlluminationMaps& maps, int maxSide, MapTextures& into,
               Portions& portions) {
  checkCounts(maps);
  checkSide(maps.detail.empty() ? "the illumination map" : "the illumination map with its detail", maps.width,
            heightOf(maps), maxSide);
  portions.add([&gl, &maps, &into] { makeMaps(gl, maps, into); });
  const std::size_t numbers = std::size_t{3} * maps.width;
  for (const MapRows& all : rowsOf(maps)) {
    rowsInPortions(maps.width, all.count, [&](int row, int rows) {
      portions.add(
          [&gl, &maps, &into, part = MapRows{all.texels + numbers * row, rows, all.at + row, all.layer}] {
            copyRows(gl, into, maps.width, part);
          });
    });
  }
  if (!maps.detail.empty()) addBlocks(gl, maps, into.blocks, portions);
  portions.add([&gl] { checkGl(gl, "uploading the illumination maps"); });
}

}  // namespace saccade::render
