// What the parsers behind our loaders take by themselves.
#pragma once

#include <string>

namespace saccade::bench {

/// Reads a .glb with tinygltf or an .obj with tinyobjloader (its MTL too), with none of our checks, and drops
/// the result. `decodeImages` decodes the images that a .glb holds (an .obj's are never read). Throws
/// core::Error.
void parseBare(const std::string& file, bool decodeImages);

}  // namespace saccade::bench
