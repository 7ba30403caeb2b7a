// Binary glTF 2.0, written: vertex data, images and the container; what the JSON says is the caller's.
// The same input gives the same bytes.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "core/math/types.h"

namespace saccade::core {

/// A glTF vector of numbers as exact as its floats.
template <class Vector>
nlohmann::json jsonArray(const Vector& v) {
  nlohmann::json out = nlohmann::json::array();
  for (int c = 0; c < Vector::length(); ++c) out.push_back(static_cast<double>(v[c]));
  return out;
}

/// One buffer with a view for each kind of vertex data and for each image. Not for several threads at once.
class GlbBuilder {
 public:
  /// All of the JSON but asset, accessors, buffers, bufferViews, images and extensionsUsed.
  nlohmann::json root = nlohmann::json::object();

  // Indices of accessors. Nothing may be empty, every float must be finite.
  int addPositions(const std::vector<Vec3>& values);  ///< with min and max, which glTF asks for
  int addNormals(const std::vector<Vec3>& values);
  int addUvs(const std::vector<Vec2>& values);
  int addVec4s(const std::vector<Vec4>& values);  ///< tangents, colours
  /// Of 16 bits where `vertexCount` vertices allow it.
  int addIndices(const std::vector<std::uint32_t>& indices, std::size_t vertexCount);
  /// Index of the image; `file` is an encoded one.
  int addImage(const std::string& name, std::vector<std::uint8_t> file, const char* mimeType);
  /// Goes into extensionsUsed.
  void useExtension(const std::string& name) { extensionsUsed_.insert(name); }
  /// The whole file. Throws core::Error when it is larger than the 4 GiB that the container can hold.
  std::vector<std::uint8_t> bytes(const std::string& generator) const;

 private:
  /// One buffer view, shared by all accessors of one kind.
  struct Stream {
    std::vector<std::uint8_t> data;
    int stride = 0;  ///< bytes, 0 = not stated
    int target = 0;  ///< ARRAY_BUFFER or ELEMENT_ARRAY_BUFFER
  };
  enum StreamKind { kPositions, kNormals, kUvs, kVec4s, kShortIndices, kLongIndices, kStreamKinds };

  template <class T>
  int addAccessor(StreamKind kind, const char* type, int componentType, const std::vector<T>& values);
  void checkSize() const;
  nlohmann::json withBufferViews(std::vector<std::uint8_t>& binary) const;

  Stream streams_[kStreamKinds]{{{}, 12, 34962}, {{}, 12, 34962}, {{}, 8, 34962},
                                {{}, 16, 34962}, {{}, 0, 34963},  {{}, 0, 34963}};
  std::vector<std::vector<std::uint8_t>> imageFiles_;
  nlohmann::json accessors_ = nlohmann::json::array(), images_ = nlohmann::json::array();
  std::set<std::string> extensionsUsed_;
};

}  // namespace saccade::core
