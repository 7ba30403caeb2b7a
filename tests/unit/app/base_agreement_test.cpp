// What the base layer draws (OpenGL) is what the tracer takes off again (raytrace::baseLight), for every way
// in which a material's textures and coverage may be read: else corrections would be wrong by the difference.
#include <cmath>

#include "core/math/half.h"
#include "raytrace/surface.h"
#include "raytrace/world.h"
#include "render/base/base_renderer.h"
#include "tests/detail_maps.h"
#include "tests/unit/app/fixtures.h"
#include "tests/unit/render/scene_fixture.h"

namespace saccade {
namespace {

using core::Vec2;
using core::Vec3;
using core::Vec4;

constexpr int kSide = 32;
/// GL decodes sRGB with 8 to 12 bits and keeps maps in halves of 11 bits.
constexpr float kRelative = 1.0f / 256, kAbsolute = 1.0f / 2048;

/// 4 x 4 texels, all different, with coverages on both sides of the cutoff; nearest, so that GL's mipmaps and
/// 8-bit filter weights stay out of it.
core::Texture patches(std::uint8_t seed, bool srgb) {
  std::vector<core::Rgba8> texels;
  for (int i = 0; i < 16; ++i) {
    const auto value = [&](int k) { return static_cast<std::uint8_t>((37 * i + 71 * k + 13 * seed) % 256); };
    texels.push_back({value(0), value(1), value(2), value(3)});
  }
  core::Texture texture = tests::makeTexture(4, 4, std::move(texels), srgb);
  texture.wrapS = core::Wrap::repeat;
  texture.wrapT = core::Wrap::mirror;
  return texture;
}

/// A quad with two different UV sets (and vertex colours) whose material reads every texture the base layer
/// knows, seen from its front or its back.
struct Case {
  core::AlphaMode alphaMode = core::AlphaMode::opaque;
  int uvSet = 0;
  bool transformed = false, colored = false, unlit = false, doubleSided = false, behind = false, ward = false,
       layered = false, vertexLit = false;
};

core::TextureSlot slotOf(const Case& c, int texture) {
  core::TextureSlot slot;
  slot.texture = texture;
  slot.uvSet = c.uvSet;
  if (c.transformed) {
    slot.offset = {0.13f, -0.37f};
    slot.rotation = 0.61f + 0.2f * static_cast<float>(texture);
    slot.scale = {1.7f, -0.8f};
  }
  return slot;
}

core::Material materialOf(const Case& c) {
  core::Material m = tests::lambert({0.9f, 0.7f, 0.5f});
  m.alphaMode = c.alphaMode;
  m.alpha = 0.9f;
  m.alphaCutoff = 0.4f;
  m.doubleSided = c.doubleSided;
  m.unlit = c.unlit;
  m.baseColorTexture = slotOf(c, 0);
  m.emission = {0.25f, 0, 0.5f};
  m.emissionTexture = slotOf(c, 1);
  if (c.ward) {
    m.specular = 0;
    m.ward = core::WardLobe{m.baseColor, Vec3(0.1f), 0.1f, 0.2f};
    return m;
  }
  if (c.layered) {
    m.sheenColor = {0.2f, 0.6f, 0.4f};
    m.sheenRoughness = 0.4f;
    m.clearcoat = 0.7f;
    m.clearcoatRoughness = 0.2f;
  }
  m.metallic = 0.5f;
  m.metallicRoughnessTexture = slotOf(c, 2);
  m.transmission = 0.25f;
  m.transmissionTexture = slotOf(c, 3);
  return m;
}

core::Scene sceneOf(const Case& c) {
  core::Scene scene = c.behind ? tests::oneQuadFromBehind(materialOf(c)) : tests::oneQuad(materialOf(c), 1);
  for (int i = 0; i < 4; ++i) scene.textures.push_back(patches(static_cast<std::uint8_t>(i), i < 2));
  core::Mesh& mesh = scene.meshes[0];
  mesh.vertexLit = c.vertexLit;
  for (std::size_t v = 0; v < mesh.uv1.size(); ++v) {
    if (c.vertexLit) mesh.lightmapUv[v] = (Vec2(static_cast<float>(v), 1) + 0.5f) / Vec2(5, 3);
    mesh.uv1[v] = Vec2(0.9f, 0.8f) - 0.6f * mesh.uv0[v];
    const auto shade = static_cast<float>(v);
    if (c.colored) mesh.colors.emplace_back(0.2f + 0.2f * shade, 1 - 0.25f * shade, 0.5f, 1 - 0.15f * shade);
  }
  return scene;
}

/// Pixels compared, of an image of `side` x `side`.
int expectAgreement(const core::Scene& scene, const core::IlluminationMaps& maps, int side) {
  static const auto context = render::makeHeadlessContext(render::ContextKind::osmesa);
  render::BaseRenderer renderer(*context, scene);
  renderer.setMaps(&maps);
  const core::View view({}, side, side, scene.bounds);
  const auto frame = renderer.render(view, 1, 10);
  raytrace::World world(scene, core::makePlan(scene));
  world.setMaps(&maps);
  raytrace::RayCounters counters;
  int compared = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const Vec3 direction =
          glm::normalize(view.direction({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}));
      raytrace::Hit hit;
      const bool there =
          world.intersectVisible({view.camera().eye, direction, 0, core::kInfinity}, hit, counters);
      EXPECT_EQ(there, frame->depth[frame->index(x, y)] > 0) << x << ", " << y;
      if (!there) continue;
      const raytrace::BaseLight light = raytrace::baseLight(world, hit, direction);
      const Vec3 traced = light.coverage * (light.reflected + light.emitted);
      const Vec4 drawn = frame->baseAndId[frame->index(x, y)];
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(drawn[k], traced[k], kAbsolute + kRelative * traced[k]) << x << ", " << y;
      ++compared;
      if (testing::Test::HasFailure()) return compared;
    }
  }
  return compared;
}

core::IlluminationMaps mapsOf(const Case& c) {
  core::IlluminationMaps maps = tests::constantMaps({Vec3(2, 3, 4), Vec3(5, 1, 0.5f)});
  if (!c.vertexLit) return maps;
  // Vertex v of the quad has texel (v, 1) of its own; every number there differs.
  for (std::size_t i = 0; i < maps.texels.size(); ++i)
    maps.texels[i] = core::toHalf(1 + 0.02f * static_cast<float>(i * 7 % 90));
  return maps;
}

/// A block for the texel (0, 0) alone.
core::IlluminationMaps withDetail(core::IlluminationMaps maps) {
  maps.detail.height = 4;
  maps.detail.blocks.assign(static_cast<std::size_t>(maps.width) * maps.height, 0);
  maps.detail.blocks[0] = core::MapBlock{1, 1, 1, 1}.packed();
  maps.detail.texels.assign(std::size_t{3} * maps.width * maps.detail.height * maps.layers, core::toHalf(9));
  return maps;
}

/// Pixels compared.
int expectAgreement(const Case& c) { return expectAgreement(sceneOf(c), mapsOf(c), kSide); }

std::string describe(const Case& c) {
  return "alpha mode " + std::to_string(static_cast<int>(c.alphaMode)) + ", uv set " +
         std::to_string(c.uvSet) + (c.transformed ? ", transformed" : "") + (c.colored ? ", colours" : "") +
         (c.unlit ? ", unlit" : "") + (c.doubleSided ? ", double-sided" : "") +
         (c.behind ? ", from behind" : "") + (c.ward ? ", Ward" : "") +
         (c.layered ? ", coat and sheen" : "") + (c.vertexLit ? ", lit by vertex" : "");
}

TEST(BaseAgreement, EveryAlphaModeUvSetTransformAndColour) {
  for (const core::AlphaMode mode :
       {core::AlphaMode::opaque, core::AlphaMode::mask, core::AlphaMode::blend}) {
    for (int bits = 0; bits < 16; ++bits) {
      Case c;
      c.alphaMode = mode;
      c.uvSet = bits & 1;
      c.transformed = bits & 2;
      c.colored = bits & 4;
      c.unlit = bits & 8;
      SCOPED_TRACE(describe(c));
      EXPECT_GT(expectAgreement(c), kSide * kSide / 8);
      if (HasFailure()) return;
    }
  }
}

TEST(BaseAgreement, BothSidesUnderEveryLayer) {
  for (const bool behind : {false, true}) {
    for (const bool ward : {false, true}) {
      Case c;
      c.transformed = c.doubleSided = true;
      c.behind = behind;
      c.ward = ward;
      c.layered = !ward;
      SCOPED_TRACE(describe(c));
      EXPECT_GT(expectAgreement(c), kSide * kSide / 8);
    }
  }
}

TEST(BaseAgreement, DetailOfTheMapsInBlocksOfEverySide) {
  core::Material material = tests::lambert(Vec3(0.8f));
  material.doubleSided = true;
  // 8 bits of filter weights over steps of up to 1 between values of 1 and more are within kRelative.
  for (const auto& [width, height, mostLog2] : {std::tuple{11, 7, 3}, {157, 3, 7}}) {
    const core::IlluminationMaps maps = tests::detailMaps(width, height, 2, mostLog2, 12);
    for (const bool behind : {false, true}) {
      SCOPED_TRACE(std::to_string(width) + (behind ? ", from behind" : ""));
      const core::Scene scene = behind ? tests::oneQuadFromBehind(material) : tests::oneQuad(material);
      EXPECT_GT(expectAgreement(scene, maps, 4 * kSide), kSide * kSide);
    }
  }
}

TEST(BaseAgreement, LightByVertexOnBothSides) {
  for (const auto& [behind, doubleSided] : {std::pair(false, false), {false, true}, {true, true}}) {
    Case c;
    c.vertexLit = true;
    c.behind = behind;
    c.doubleSided = doubleSided;
    SCOPED_TRACE(describe(c));
    EXPECT_GT(expectAgreement(c), kSide * kSide / 8);
    EXPECT_GT(expectAgreement(sceneOf(c), withDetail(mapsOf(c)), kSide), kSide * kSide / 8);
  }
}

TEST(BaseAgreement, AUvSetThatTheMeshLacksIsTheFirst) {
  Case c;
  c.uvSet = 1;
  core::Scene scene = sceneOf(c), first = sceneOf({});
  scene.meshes[0].uv1.clear();
  const auto context = render::makeHeadlessContext(render::ContextKind::osmesa);
  const auto draw = [&](const core::Scene& s) {
    render::BaseRenderer renderer(*context, s);
    return renderer.render(core::View({}, kSide, kSide, s.bounds), 1, 10)->baseAndId;
  };
  EXPECT_EQ(draw(scene), draw(first));
}

}  // namespace
}  // namespace saccade
