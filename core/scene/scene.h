// The scene as every room sees it. Read-only once loaded and charted; any thread may read.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/error.h"
#include "core/image.h"
#include "core/math/types.h"

namespace saccade::core {

enum class Wrap { repeat, clamp, mirror };

/// 8-bit RGBA texels as in the file; `srgb` says how the colour channels are to be decoded (alpha never).
struct Texture {
  std::string name;
  ImageRgba8 image;
  Wrap wrapS = Wrap::repeat;
  Wrap wrapT = Wrap::repeat;
  bool nearest = false;  ///< the sampler asks for nearest magnification
  bool srgb = false;
};

/// A texture slot of a material; texture -1 means none. v runs downwards (glTF).
struct TextureSlot {
  int texture = -1;
  int uvSet = 0;  ///< 0 or 1
  explicit operator bool() const { return texture >= 0; }
};

enum class AlphaMode { opaque, mask, blend };

/// glTF metallic-roughness with the extensions of this capability. Factors multiply textures.
struct Material {
  std::string name;
  Vec3 baseColor{1};  ///< linear
  float alpha = 1;
  TextureSlot baseColorTexture;  ///< RGB sRGB, A coverage
  float metallic = 1;
  float roughness = 1;                   ///< perceptual; GGX alpha = roughness^2
  TextureSlot metallicRoughnessTexture;  ///< G roughness, B metallic
  TextureSlot normalTexture;             ///< tangent space
  float normalScale = 1;
  Vec3 emission{0};  ///< radiance, KHR_materials_emissive_strength multiplied in
  TextureSlot emissionTexture;
  float ior = 1.5f;       ///< KHR_materials_ior
  float specular = 1;     ///< KHR_materials_specular, A of its texture
  Vec3 specularColor{1};  ///< KHR_materials_specular, RGB of its texture
  TextureSlot specularTexture;
  TextureSlot specularColorTexture;
  float transmission = 0;  ///< KHR_materials_transmission, R of its texture
  TextureSlot transmissionTexture;
  AlphaMode alphaMode = AlphaMode::opaque;
  float alphaCutoff = 0.5f;
  bool doubleSided = false;
  bool unlit = false;  ///< KHR_materials_unlit: shows baseColor as radiance, lights nothing

  bool emits() const { return !unlit && (emission.x > 0 || emission.y > 0 || emission.z > 0); }
};

/// Triangles; every attribute array is empty or as long as positions. World space in Object.
struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;   ///< unit, always filled by the loader (flat ones where the file has none)
  std::vector<Vec4> tangents;  ///< xyz unit, w = +-1; filled when the material has a normal map
  std::vector<Vec2> uv0, uv1;
  std::vector<Vec4> colors;  ///< COLOR_0, linear
  std::vector<Vec2>
      lightmapUv;  ///< into the illumination map atlas, [0, 1]^2; filled by applyCharts (core/maps.h)
  std::vector<std::uint32_t> indices;  ///< 3 per triangle, counter-clockwise seen from the front

  std::size_t triangleCount() const { return indices.size() / 3; }
};

struct Node {
  std::string name;
  int parent = -1;
  Mat4 localToParent{1};
  Mat4 localToWorld{1};  ///< at the scene's time
};

/// A group of near primitives of one material: what the ID mask names (Haber 2001, section 4.1).
struct Object {
  std::string name;  ///< node name, with primitive and cluster where there are several
  int node = -1;
  int primitive = 0;
  int cluster = 0;
  int material = 0;
  std::uint32_t id = 0;  ///< 1.. for non-diffuse objects, in order of (node, primitive, cluster); 0 = diffuse
  bool closed = false;   ///< watertight: transmission refracts as a solid, else as a thin sheet
  float nonDiffuseAlbedo = 0;  ///< cosine-averaged albedo of the lobes other than Lambert, [0, 1]
  Mesh mesh;                   ///< world space
  Bounds bounds;
};

/// Punctual light, KHR_lights_punctual; 1 cd = 1 W/sr, 1 lx = 1 W/m^2.
struct PunctualLight {
  enum class Type { point, spot, directional } type = Type::point;
  std::string name;
  Vec3 position{0};
  Vec3 direction{0, -1, 0};  ///< unit, the way the light travels (spot, directional)
  Vec3 intensity{1};         ///< W/sr per steradian (point, spot), W/m^2 (directional)
  float range = 0;           ///< metres; 0 = unlimited
  float cosInner = 1, cosOuter = 0.7071f;
};

/// One node of the object hierarchy: grouped by material, then by nearness. Leaves name one object.
struct HierarchyNode {
  Bounds bounds;
  int object = -1;  ///< >= 0: a leaf
  int child[2] = {-1, -1};
};

struct Scene {
  std::string path;
  double timeSeconds = 0;
  std::uint64_t lightEpoch = 0;  ///< raised when a light changes
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Node> nodes;
  std::vector<Object> objects;
  std::vector<PunctualLight> lights;
  std::vector<Camera> cameras;
  std::vector<HierarchyNode> hierarchy;  ///< [0] is the root; empty for an empty scene
  Bounds bounds;
  bool defaultLight =
      false;  ///< the scene had no light: a panel was added (design: 1 m, 0.95 of the height, radiance 15)
  bool defaultCamera = false;  ///< the scene had no camera: cameras[0] frames the bounds
  Warnings warnings;

  std::size_t triangleCount() const {
    std::size_t n = 0;
    for (const Object& o : objects) n += o.mesh.triangleCount();
    return n;
  }
  /// Number of non-diffuse objects = largest id.
  std::uint32_t idCount() const {
    std::uint32_t n = 0;
    for (const Object& o : objects) n = o.id > n ? o.id : n;
    return n;
  }
};

}  // namespace saccade::core
