// What the base layer shows, against its formula.
#include "core/error.h"
#include "tests/detail_maps.h"
#include "tests/unit/render/base_layer_fixture.h"

namespace saccade::tests {
namespace {

using core::Scene;
using core::Vec3;
using core::Vec4;
using core::View;

class BaseShading : public BaseLayer {};
SACCADE_EACH_CONTEXT(BaseShading);

void expectRadiance(const Vec4& pixel, const Vec3& expected, float relative = 2e-6f) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixel[c], expected[c], relative * expected[c]) << "channel " << c;
}

TEST_P(BaseShading, LitQuadHasTheRadianceOfItsMap) {
  const Scene scene = oneQuad(lambert({0.25f, 0.5f, 1.0f}), 7);
  const core::IlluminationMaps maps = constantMaps({Vec3(2, 4, 0.5f)});  // exact in half precision
  const auto frame = draw(scene, &maps);
  const float factor = core::baseDiffuseFactor(scene, scene.materials[0]) / core::kPi;
  expectRadiance(frame->baseAndId[frame->index(16, 16)], factor * Vec3(0.5f, 2.0f, 0.5f));
  EXPECT_EQ(frame->idAt(16, 16), 7u);
  EXPECT_EQ(frame->baseAndId[frame->index(0, 0)], Vec4(0));
  EXPECT_EQ(frame->depth[frame->index(0, 0)], 0.0f);
}

TEST_P(BaseShading, WithoutMapsIrradianceIsPi) {
  const Scene scene = oneQuad(lambert({0.25f, 0.5f, 1.0f}));
  expectRadiance(center(scene), core::baseDiffuseFactor(scene, scene.materials[0]) * Vec3(0.25f, 0.5f, 1.0f));
}

TEST_P(BaseShading, MapsCanBeExchanged) {
  const Scene scene = oneQuad(lambert(Vec3(1)));
  render::BaseRenderer renderer(*context_, scene);
  const View view({}, 8, 8, scene.bounds);
  const float factor = core::baseDiffuseFactor(scene, scene.materials[0]) / core::kPi;
  for (const float irradiance : {1.0f, 8.0f}) {
    const core::IlluminationMaps maps = constantMaps({Vec3(irradiance)});
    renderer.setMaps(&maps);
    expectRadiance(renderer.render(view, 1, kNMin)->baseAndId[4 * 8 + 4], Vec3(irradiance * factor));
  }
  renderer.setMaps(nullptr);
  expectRadiance(renderer.render(view, 1, kNMin)->baseAndId[4 * 8 + 4], Vec3(factor * core::kPi));
}

TEST_P(BaseShading, MetalAndTransmissionTakeFromTheDiffusePart) {
  core::Material m = lambert(Vec3(1));
  m.metallic = 0.75f;
  m.transmission = 0.5f;
  Scene scene = oneQuad(m);
  const float factor = core::baseDiffuseFactor(scene, m);
  expectRadiance(center(scene), Vec3(factor * 0.25f * 0.5f));

  // The same from textures: B of one, R of the other.
  scene.textures.push_back(makeTexture(1, 1, {{0, 0, 255, 255}}, false));
  scene.textures.push_back(makeTexture(1, 1, {{255, 0, 0, 255}}, false));
  scene.materials[0].metallicRoughnessTexture.texture = 0;
  scene.materials[0].transmissionTexture = {1, 1};
  expectRadiance(center(scene), Vec3(core::baseDiffuseFactor(scene, scene.materials[0]) * 0.25f * 0.5f));

  scene.materials[0].metallic = 1;
  EXPECT_EQ(Vec3(center(scene)), Vec3(0));
}

TEST_P(BaseShading, TextureIsDecodedFromSrgb) {
  Scene scene = oneQuad(lambert(Vec3(1)));
  scene.textures.push_back(makeTexture(1, 1, {{188, 188, 188, 255}}, true));
  scene.materials[0].baseColorTexture.texture = 0;
  const float linear = std::pow((188 / 255.0f + 0.055f) / 1.055f, 2.4f);
  expectRadiance(center(scene), Vec3(core::baseDiffuseFactor(scene, scene.materials[0]) * linear), 2e-3f);
}

TEST_P(BaseShading, VertexColourMultiplies) {
  Scene scene = oneQuad(lambert(Vec3(1)));
  scene.meshes[0].colors.assign(4, {0.5f, 0.25f, 1, 1});
  expectRadiance(center(scene), core::baseDiffuseFactor(scene, scene.materials[0]) * Vec3(0.5f, 0.25f, 1));
}

TEST_P(BaseShading, EmittersShineFromTheFrontUnlessDoubleSided) {
  core::Material m = lambert(Vec3(0));
  m.emission = {3, 2, 1};
  EXPECT_EQ(Vec3(center(oneQuad(m))), m.emission);
  EXPECT_EQ(Vec3(center(oneQuadFromBehind(m))), Vec3(0));
  m.doubleSided = true;
  EXPECT_EQ(Vec3(center(oneQuadFromBehind(m))), m.emission);
}

TEST_P(BaseShading, UnlitShowsItsColour) {
  core::Material m = lambert({0.25f, 0.5f, 0.75f});
  m.unlit = true;
  m.emission = Vec3(9);
  const core::IlluminationMaps maps = constantMaps({Vec3(100)});
  EXPECT_EQ(Vec3(center(oneQuad(m), &maps)), m.baseColor);
}

TEST_P(BaseShading, BackLayerServesTheBackOfDoubleSidedSurfacesOnly) {
  core::Material m = lambert(Vec3(1));
  const core::IlluminationMaps maps = constantMaps({Vec3(1), Vec3(16)});
  const float factor = core::baseDiffuseFactor(oneQuad(m), m) / core::kPi;
  m.doubleSided = true;
  expectRadiance(center(oneQuad(m), &maps), Vec3(factor));
  expectRadiance(center(oneQuadFromBehind(m), &maps), Vec3(16 * factor));
  const core::IlluminationMaps frontOnly = constantMaps({Vec3(4)});
  expectRadiance(center(oneQuadFromBehind(m), &frontOnly), Vec3(4 * factor));
}

TEST_P(BaseShading, BackFacesOfSingleSidedSurfacesAreNotThereUnlessTheyRefract) {
  core::Material m = lambert(Vec3(1));
  const auto drawn = [&](const Scene& scene) { return draw(scene)->depth[16 * 32 + 16] > 0; };
  EXPECT_TRUE(drawn(oneQuad(m)));
  EXPECT_FALSE(drawn(oneQuadFromBehind(m)));
  m.transmission = 1;
  EXPECT_TRUE(drawn(oneQuadFromBehind(m)));
  m.transmission = 0;
  m.doubleSided = true;
  EXPECT_TRUE(drawn(oneQuadFromBehind(m)));
}

TEST_P(BaseShading, AlphaMaskCutsAndBlendScales) {
  core::Material m = lambert(Vec3(1));
  m.alphaMode = core::AlphaMode::mask;
  m.baseColorTexture.texture = 0;
  Scene scene = oneQuad(m, 3);
  // Left half transparent, right half opaque.
  scene.textures.push_back(makeTexture(2, 1, {{255, 255, 255, 0}, {255, 255, 255, 255}}, false));
  const auto cut = draw(scene);
  EXPECT_EQ(cut->idAt(12, 16), 0u);
  EXPECT_EQ(cut->depth[cut->index(12, 16)], 0.0f);
  EXPECT_EQ(cut->idAt(20, 16), 3u);

  scene.materials[0].alphaMode = core::AlphaMode::blend;
  scene.materials[0].alpha = 0.5f;
  const auto blended = draw(scene);
  EXPECT_EQ(blended->baseAndId[blended->index(12, 16)], Vec4(0, 0, 0, 3));
  expectRadiance(blended->baseAndId[blended->index(20, 16)],
                 Vec3(0.5f * core::baseDiffuseFactor(scene, scene.materials[0])));
}

TEST_P(BaseShading, MapsWhoseCountsDisagreeAreRefused) {
  const Scene scene = oneQuad(lambert(Vec3(1)));
  render::BaseRenderer renderer(*context_, scene);
  core::IlluminationMaps maps = constantMaps({Vec3(1)});
  maps.texels.pop_back();
  EXPECT_THROW(renderer.setMaps(&maps), core::Error);
  maps = detailMaps(11, 7, 1, 3, 1);
  renderer.setMaps(&maps);
  maps.detail.blocks.back() = core::MapBlock{10, 1, 3, 3}.packed();
  EXPECT_THROW(renderer.setMaps(&maps), core::Error);
}

TEST_P(BaseShading, MapsWithDetailBeyondTheContextsTexturesAreRefused) {
  const Scene scene = oneQuad(lambert(Vec3(1)));
  render::BaseRenderer renderer(*context_, scene);
  core::IlluminationMaps maps = detailMaps(11, 7, 1, 3, 1);
  const auto withRows = [&](int rows) {
    maps.detail.height = rows;
    maps.detail.texels.assign(std::size_t{3} * 11 * rows, 0);
  };
  withRows(context_->maxSize() - 8);  // atlas and guard row
  EXPECT_NO_THROW(renderer.setMaps(&maps));
  withRows(context_->maxSize() - 7);
  EXPECT_THROW(renderer.setMaps(&maps), core::Error);
}

}  // namespace
}  // namespace saccade::tests
