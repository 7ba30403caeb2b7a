// The bundled scenes as binary glTF 2.0, over core::GlbBuilder.
#pragma once

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/scene/glb_builder.h"
#include "core/scene/scene.h"
#include "data/make_scenes/mesh_data.h"

namespace saccade::data {

/// Textures are indices from addJpeg or addPng, -1 = none. Meanings as in core::Material.
struct MaterialDesc {
  std::string name;
  Vec3 baseColor{1};  ///< linear
  int baseColorTexture = -1;
  float metallic = 0;
  float roughness = 1;
  int metallicRoughnessTexture = -1;
  int normalTexture = -1;
  float normalScale = 1;
  Vec3 emission{0};  ///< radiance; above 1 it becomes KHR_materials_emissive_strength
  float transmission = 0;
  float ior = 1.5f;
  float specular = 1;
  bool doubleSided = false;
  std::optional<core::WardLobe> ward;  ///< in `extras`; anisotropic: uvs and tangents are kept
};

/// Where a node stands: translation, then rotation, then scale, as in glTF.
struct Placement {
  Vec3 translation{0};
  glm::quat rotation{1, 0, 0, 0};
  Vec3 scale{1};
};
/// Standing at `translation`, turned by `degrees` around Y (counter-clockwise seen from above), scaled alike.
Placement standing(const Vec3& translation, float degrees = 0, float scale = 1);

class GlbWriter {
 public:
  int addJpeg(const std::string& name, const core::ImageRgba8& image, int quality);
  int addPng(const std::string& name, const core::ImageRgba8& image);
  int addMaterial(const MaterialDesc& material);
  /// Vertices are stored once and may be drawn with several materials. `textured` keeps the uvs, `bumpy` adds
  /// tangents for a normal map; a material that needs neither is not given them.
  int addGeometry(const MeshData& mesh, bool textured = false, bool bumpy = false);
  /// A node in the scene's root.
  void addNode(const std::string& name, int geometry, int material, const Placement& placement = {});
  void addCamera(const core::Camera& camera);
  /// The whole file.
  std::vector<std::uint8_t> bytes() const;

 private:
  int addImage(const std::string& name, std::vector<std::uint8_t> file, const char* mimeType);

  core::GlbBuilder glb_;
  std::vector<bool> isTextured_, isBumpy_;     ///< by material
  std::vector<nlohmann::json> primitives_;     ///< by geometry, without material
  std::map<std::pair<int, int>, int> meshes_;  ///< (geometry, material) -> mesh
};

}  // namespace saccade::data
