#include "bench/load/bare_parse.h"

#include <tiny_obj_loader.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/image_io.h"
#include "core/scene/tinygltf.h"

namespace saccade::bench {
namespace {

bool keepEncoded(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int,
                 void*) {
  return true;
}

bool decode(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
            const unsigned char* bytes, int size, void*) {
  const core::ImageRgba8 decoded = core::decodeImage({bytes, static_cast<std::size_t>(size)}, "image");
  const auto* from = reinterpret_cast<const unsigned char*>(decoded.pixels().data());
  image->image.assign(from, from + decoded.pixels().size() * sizeof(core::Rgba8));
  return true;
}

void parseGlb(const std::string& file, bool decodeImages) {
  const std::vector<std::uint8_t> bytes = core::readWholeFile(file);
  tinygltf::TinyGLTF parser;
  parser.SetImageLoader(decodeImages ? &decode : &keepEncoded, nullptr);
  tinygltf::Model model;
  std::string error, warning;
  if (!parser.LoadBinaryFromMemory(&model, &error, &warning, bytes.data(),
                                   static_cast<unsigned>(bytes.size())))
    throw core::Error(file + ": " + error);
}

void parseObj(const std::string& file) {
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warning, error;
  const std::string folder = file.substr(0, file.rfind('/') + 1);
  if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, file.c_str(), folder.c_str()))
    throw core::Error(file + ": " + error);
}

}  // namespace

void parseBare(const std::string& file, bool decodeImages) {
  if (file.ends_with(".obj")) {
    parseObj(file);
  } else {
    parseGlb(file, decodeImages);
  }
}

}  // namespace saccade::bench
