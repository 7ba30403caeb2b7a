// Which channel of which texture each extension's parameter reads, at a hit.
#include <gtest/gtest.h>

#include "core/image_io.h"
#include "raytrace/surface.h"
#include "tests/unit/raytrace/test_scene.h"

namespace saccade::raytrace {
namespace {

using tests::planOf;
using tests::SceneMaker;

/// What one textured square shows a ray straight from above. u runs along +x, v along +z; the tangent is +x.
class TexturedSquare {
 public:
  core::Material material = tests::metalMaterial(Vec3(1), 0.5f);

  /// A texture of one colour.
  core::TextureSlot slot(core::Rgba8 texel, bool srgb = false) {
    core::Texture t;
    t.image = core::ImageRgba8(1, 1);
    t.image.at(0, 0) = texel;
    t.srgb = srgb;
    maker_.scene.textures.push_back(t);
    core::TextureSlot s;
    s.texture = static_cast<int>(maker_.scene.textures.size()) - 1;
    return s;
  }

  Surface seen() {
    core::Object& square = maker_.quad(maker_.material(material), 1, {0, 0, 1}, {1, 0, 0}, {0, 0, -1});
    core::Mesh& mesh = maker_.scene.meshOf(square);
    mesh.tangents.assign(mesh.positions.size(), {1, 0, 0, 1});
    const World world(maker_.scene, planOf());
    Hit hit;
    RayCounters counters;
    const Ray down{{0.3f, 1, 0.4f}, {0, -1, 0}, 0, core::kInfinity};
    if (!world.intersect(down, hit, counters)) throw core::Error("the ray misses the square");
    Surface s = makeSurface(world, hit, down.direction);
    s.material = nullptr;  // dies with the world
    return s;
  }
  ExtensionPoint extension() { return seen().point.extension.value(); }

 private:
  SceneMaker maker_;
};

const core::Rgba8 kTexel = {51, 102, 153, 204};  // 0.2, 0.4, 0.6, 0.8

TEST(ExtensionTextures, ClearcoatReadsRedAndItsRoughnessGreen) {
  TexturedSquare square;
  square.material.clearcoat = 0.5f;
  square.material.clearcoatRoughness = 0.5f;
  square.material.clearcoatTexture = square.slot(kTexel);
  square.material.clearcoatRoughnessTexture = square.slot(kTexel);
  const ExtensionPoint p = square.extension();
  EXPECT_FLOAT_EQ(p.clearcoat, 0.1f);
  EXPECT_FLOAT_EQ(p.clearcoatRoughness, 0.2f);
}

TEST(ExtensionTextures, SheenReadsDecodedColourAndAlpha) {
  TexturedSquare square;
  square.material.sheenColor = Vec3(1, 0.5f, 1);
  square.material.sheenRoughness = 0.5f;
  square.material.sheenColorTexture = square.slot(kTexel, true);
  square.material.sheenRoughnessTexture = square.slot(kTexel, true);
  const ExtensionPoint p = square.extension();
  EXPECT_NEAR(p.sheenColor.x, core::decodeSrgb(0.2f), 1e-6f);
  EXPECT_NEAR(p.sheenColor.y, 0.5f * core::decodeSrgb(0.4f), 1e-6f);
  EXPECT_NEAR(p.sheenColor.z, core::decodeSrgb(0.6f), 1e-6f);
  EXPECT_FLOAT_EQ(p.sheenRoughness, 0.4f);
}

TEST(ExtensionTextures, IridescenceReadsRedAndTheFilmBetweenItsBoundsGreen) {
  TexturedSquare square;
  square.material.iridescence = 0.5f;
  square.material.iridescenceThicknessMin = 100;
  square.material.iridescenceThicknessMax = 600;
  square.material.iridescenceTexture = square.slot(kTexel);
  EXPECT_FLOAT_EQ(square.extension().film.thickness, 600);  // without a texture: the maximum
  TexturedSquare mapped;
  mapped.material = square.material;
  mapped.material.iridescenceTexture = mapped.slot(kTexel);
  mapped.material.iridescenceThicknessTexture = mapped.slot(kTexel);
  const ExtensionPoint p = mapped.extension();
  EXPECT_FLOAT_EQ(p.film.weight, 0.1f);
  EXPECT_FLOAT_EQ(p.film.thickness, 300);
}

TEST(ExtensionTextures, AnisotropyReadsStrengthInBlueAndTurnsByRedAndGreen) {
  TexturedSquare square;
  square.material.anisotropy = 0.5f;
  square.material.anisotropyTexture = square.slot({128, 255, 153, 255});  // (0, 1): a quarter turn
  const ExtensionPoint quarter = square.extension();
  EXPECT_FLOAT_EQ(quarter.anisotropy, 0.3f);
  // The bitangent: cross(normal, tangent) = (0, 1, 0) x (1, 0, 0) = (0, 0, -1).
  EXPECT_NEAR(glm::dot(glm::normalize(quarter.tangent), Vec3(0, 0, -1)), 1, 1e-4f);

  TexturedSquare turned;
  turned.material.anisotropy = 1;
  turned.material.anisotropyRotation = core::kPi / 2;
  turned.material.anisotropyTexture = turned.slot({128, 255, 255, 255});  // a quarter turn more
  EXPECT_NEAR(glm::dot(glm::normalize(turned.extension().tangent), Vec3(-1, 0, 0)), 1, 1e-4f);
}

TEST(ExtensionTextures, TheCoatsNormalMapBendsTheCoatAlone) {
  TexturedSquare square;
  square.material.clearcoat = 1;
  square.material.clearcoatNormalTexture = square.slot({204, 128, 230, 255});  // (0.6, 0, 0.8)
  const Surface s = square.seen();
  const Vec3 mapped(0.6f, 0.8f, 0);
  EXPECT_NEAR(glm::dot(s.point.extension->coatNormal, mapped), 1, 1e-3f);
  EXPECT_NEAR(glm::dot(s.ns, Vec3(0, 1, 0)), 1, 1e-6f);

  TexturedSquare flat;
  flat.material = square.material;
  flat.material.clearcoatNormalTexture = flat.slot({204, 128, 230, 255});
  flat.material.clearcoatNormalScale = 0;
  EXPECT_NEAR(glm::dot(flat.extension().coatNormal, Vec3(0, 1, 0)), 1, 1e-5f);
}

TEST(ExtensionTextures, AMaterialWithoutExtensionsCarriesNone) {
  EXPECT_FALSE(TexturedSquare().seen().point.extension.has_value());
}

}  // namespace
}  // namespace saccade::raytrace
