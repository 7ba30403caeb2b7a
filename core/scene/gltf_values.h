// Members of tinygltf's values, which the gate has checked for type and range (gltf_schema.h).
#pragma once

#include "core/math/types.h"
#include "core/scene/tinygltf.h"

namespace saccade::core {

/// `otherwise` where the member is absent.
inline float numberOr(const tinygltf::Value& object, const char* key, float otherwise) {
  return object.Has(key) ? static_cast<float>(object.Get(key).GetNumberAsDouble()) : otherwise;
}

template <class Vector>
Vector vectorOr(const tinygltf::Value& object, const char* key, Vector otherwise) {
  if (object.Has(key))
    for (int c = 0; c < Vector::length(); ++c)
      otherwise[c] = static_cast<float>(object.Get(key).Get(c).GetNumberAsDouble());
  return otherwise;
}

}  // namespace saccade::core
