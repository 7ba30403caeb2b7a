// The base layer against what its formula and geometry say.
#include "render/base/base_renderer.h"

#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <thread>

#include "core/error.h"
#include "core/scene/instances.h"
#include "scene_fixture.h"

namespace saccade::tests {
namespace {

using core::FrameSnapshot;
using core::Scene;
using core::Vec3;
using core::Vec4;
using core::View;

constexpr int kNMin = 10;

class BaseLayer : public EachContext {
 protected:
  std::shared_ptr<FrameSnapshot> draw(const Scene& scene, const core::IlluminationMaps* maps = nullptr,
                                      int width = 32, int height = 32, const core::Camera& camera = {}) {
    render::BaseRenderer renderer(*context_, scene);
    renderer.setMaps(maps);
    auto frame = renderer.render(View(camera, width, height, scene.bounds), 1, kNMin);
    stats_ = renderer.lastDraw();
    return frame;
  }
  Vec4 center(const Scene& scene, const core::IlluminationMaps* maps = nullptr) {
    const auto frame = draw(scene, maps);
    return frame->baseAndId[frame->index(16, 16)];
  }
  render::DrawStats stats_;
};
SACCADE_EACH_CONTEXT(BaseLayer);

void expectRadiance(const Vec4& pixel, const Vec3& expected, float relative = 2e-6f) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixel[c], expected[c], relative * expected[c]) << "channel " << c;
}

TEST_P(BaseLayer, LitQuadHasTheRadianceOfItsMap) {
  const Scene scene = oneQuad(lambert({0.25f, 0.5f, 1.0f}), 7);
  const core::IlluminationMaps maps = constantMaps({Vec3(2, 4, 0.5f)});  // exact in half precision
  const auto frame = draw(scene, &maps);
  const float factor = core::baseDiffuseFactor(scene, scene.materials[0]) / core::kPi;
  expectRadiance(frame->baseAndId[frame->index(16, 16)], factor * Vec3(0.5f, 2.0f, 0.5f));
  EXPECT_EQ(frame->idAt(16, 16), 7u);
  EXPECT_EQ(frame->baseAndId[frame->index(0, 0)], Vec4(0));
  EXPECT_EQ(frame->depth[frame->index(0, 0)], 1.0f);
}

TEST_P(BaseLayer, WithoutMapsIrradianceIsPi) {
  const Scene scene = oneQuad(lambert({0.25f, 0.5f, 1.0f}));
  expectRadiance(center(scene), core::baseDiffuseFactor(scene, scene.materials[0]) * Vec3(0.25f, 0.5f, 1.0f));
}

TEST_P(BaseLayer, MapsCanBeExchanged) {
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

TEST_P(BaseLayer, MetalAndTransmissionTakeFromTheDiffusePart) {
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

TEST_P(BaseLayer, TextureIsDecodedFromSrgb) {
  Scene scene = oneQuad(lambert(Vec3(1)));
  scene.textures.push_back(makeTexture(1, 1, {{188, 188, 188, 255}}, true));
  scene.materials[0].baseColorTexture.texture = 0;
  const float linear = std::pow((188 / 255.0f + 0.055f) / 1.055f, 2.4f);
  expectRadiance(center(scene), Vec3(core::baseDiffuseFactor(scene, scene.materials[0]) * linear), 2e-3f);
}

TEST_P(BaseLayer, VertexColourMultiplies) {
  Scene scene = oneQuad(lambert(Vec3(1)));
  scene.meshes[0].colors.assign(4, {0.5f, 0.25f, 1, 1});
  expectRadiance(center(scene), core::baseDiffuseFactor(scene, scene.materials[0]) * Vec3(0.5f, 0.25f, 1));
}

TEST_P(BaseLayer, EmittersShineFromTheFrontUnlessDoubleSided) {
  core::Material m = lambert(Vec3(0));
  m.emission = {3, 2, 1};
  EXPECT_EQ(Vec3(center(oneQuad(m))), m.emission);
  EXPECT_EQ(Vec3(center(oneQuadFromBehind(m))), Vec3(0));
  m.doubleSided = true;
  EXPECT_EQ(Vec3(center(oneQuadFromBehind(m))), m.emission);
}

TEST_P(BaseLayer, UnlitShowsItsColour) {
  core::Material m = lambert({0.25f, 0.5f, 0.75f});
  m.unlit = true;
  m.emission = Vec3(9);
  const core::IlluminationMaps maps = constantMaps({Vec3(100)});
  EXPECT_EQ(Vec3(center(oneQuad(m), &maps)), m.baseColor);
}

TEST_P(BaseLayer, BackLayerServesTheBackOfDoubleSidedSurfacesOnly) {
  core::Material m = lambert(Vec3(1));
  const core::IlluminationMaps maps = constantMaps({Vec3(1), Vec3(16)});
  const float factor = core::baseDiffuseFactor(oneQuad(m), m) / core::kPi;
  m.doubleSided = true;
  expectRadiance(center(oneQuad(m), &maps), Vec3(factor));
  expectRadiance(center(oneQuadFromBehind(m), &maps), Vec3(16 * factor));
  const core::IlluminationMaps frontOnly = constantMaps({Vec3(4)});
  expectRadiance(center(oneQuadFromBehind(m), &frontOnly), Vec3(4 * factor));
}

TEST_P(BaseLayer, BackFacesOfSingleSidedSurfacesAreNotThereUnlessTheyRefract) {
  core::Material m = lambert(Vec3(1));
  const auto drawn = [&](const Scene& scene) { return draw(scene)->depth[16 * 32 + 16] < 1; };
  EXPECT_TRUE(drawn(oneQuad(m)));
  EXPECT_FALSE(drawn(oneQuadFromBehind(m)));
  m.transmission = 1;
  EXPECT_TRUE(drawn(oneQuadFromBehind(m)));
  m.transmission = 0;
  m.doubleSided = true;
  EXPECT_TRUE(drawn(oneQuadFromBehind(m)));
}

TEST_P(BaseLayer, AlphaMaskCutsAndBlendScales) {
  core::Material m = lambert(Vec3(1));
  m.alphaMode = core::AlphaMode::mask;
  m.baseColorTexture.texture = 0;
  Scene scene = oneQuad(m, 3);
  // Left half transparent, right half opaque.
  scene.textures.push_back(makeTexture(2, 1, {{255, 255, 255, 0}, {255, 255, 255, 255}}, false));
  const auto cut = draw(scene);
  EXPECT_EQ(cut->idAt(12, 16), 0u);
  EXPECT_EQ(cut->depth[cut->index(12, 16)], 1.0f);
  EXPECT_EQ(cut->idAt(20, 16), 3u);

  scene.materials[0].alphaMode = core::AlphaMode::blend;
  scene.materials[0].alpha = 0.5f;
  const auto blended = draw(scene);
  EXPECT_EQ(blended->baseAndId[blended->index(12, 16)], Vec4(0, 0, 0, 3));
  expectRadiance(blended->baseAndId[blended->index(20, 16)],
                 Vec3(0.5f * core::baseDiffuseFactor(scene, scene.materials[0])));
}

TEST_P(BaseLayer, RowZeroIsTheTopAndColumnZeroTheLeft) {
  Scene scene;
  scene.materials.push_back(lambert(Vec3(1)));
  addObject(scene, makeQuad({0.2f, 0.2f, -2}, {0.6f, 0, 0}, {0, 0.6f, 0}, 0, 5));  // up and to the right
  const auto frame = draw(scene);
  const core::PixelBox box = frame->extents[5].box;
  EXPECT_GE(box.x0, 16);
  EXPECT_LE(box.y1, 16);
  EXPECT_EQ(frame->extents[5].pixels, frame->nonDiffusePixels);
  EXPECT_GT(frame->nonDiffusePixels, 0u);
}

TEST_P(BaseLayer, DepthIsTheDistanceAlongTheLineOfSight) {
  Scene scene;
  scene.materials.push_back(lambert(Vec3(1)));
  const Vec3 corner(-4, -3, -2), a(8, 0, -6), b(0, 6, 0);  // a slanted wall that fills the picture
  addObject(scene, makeQuad(corner, a, b));
  const auto frame = draw(scene, nullptr, 33, 21);
  const Vec3 normal = glm::normalize(glm::cross(a, b));
  int seen = 0;
  for (int y = 0; y < 21; ++y) {
    for (int x = 0; x < 33; ++x) {
      const float stored = frame->depth[frame->index(x, y)];
      if (stored == 1) continue;
      ++seen;
      const Vec3 direction = frame->view.direction({x + 0.5f, y + 0.5f});
      const float expected = glm::dot(normal, corner) / glm::dot(normal, direction);
      EXPECT_NEAR(frame->view.viewDepth(stored), expected, 1e-3f * expected) << x << ", " << y;
    }
  }
  EXPECT_GT(seen, 300);
}

TEST_P(BaseLayer, ThousandObjectsKeepTheirIds) {
  constexpr int kSide = 32;  // 1,024 objects
  Scene scene;
  scene.materials.push_back(lambert(Vec3(1)));
  const float cell = 2.0f / kSide;
  for (int i = 0; i < kSide * kSide; ++i) {
    const Vec3 corner(-1 + cell * (i % kSide), 1 - cell * (i / kSide + 1), -1);
    addObject(scene, makeQuad(corner, {cell, 0, 0}, {0, cell, 0}, 0, static_cast<std::uint32_t>(i + 1)));
  }
  core::Camera camera;
  camera.fovYDegrees = 90;
  const auto frame = draw(scene, nullptr, 4 * kSide, 4 * kSide, camera);
  ASSERT_EQ(frame->extents.size(), 1025u);
  for (int i = 0; i < kSide * kSide; ++i) {
    EXPECT_EQ(frame->idAt(4 * (i % kSide) + 2, 4 * (i / kSide) + 2), static_cast<std::uint32_t>(i + 1));
    EXPECT_EQ(frame->extents[static_cast<std::size_t>(i) + 1].pixels, 16u);
  }
}

TEST_P(BaseLayer, LargeIdsAreExact) {
  constexpr std::uint32_t kLarge = (1u << 20) + 1;  // neither 16 bits nor a half float hold it
  const Scene scene = oneQuad(lambert(Vec3(1)), kLarge);
  render::BaseRenderer renderer(*context_, scene);
  EXPECT_EQ(renderer.render(View({}, 4, 4, scene.bounds), 1, kNMin)->idAt(2, 2), kLarge);
}

/// Boxes all around the origin; a hierarchy of one level above the leaves.
Scene surroundings() {
  Scene scene;
  scene.materials.push_back(lambert(Vec3(0.5f)));
  scene.materials.push_back(lambert(Vec3(1, 0, 0)));
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-6, 6), size(0.2f, 1.5f);
  for (int i = 0; i < 120; ++i) {
    const Vec3 lo(place(random), place(random), place(random));
    addObject(scene, makeBox(lo, lo + Vec3(size(random), size(random), size(random)), i % 2,
                             static_cast<std::uint32_t>(i + 1)));
  }
  return scene;
}

void addHierarchy(Scene& scene) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    scene.hierarchy.push_back({});
    scene.hierarchy.back().bounds = scene.objects[i].bounds;
    scene.hierarchy.back().object = static_cast<int>(i);
  }
  // Pairs, pairs of pairs, ... up to one root, which must stand first.
  std::vector<int> level(scene.hierarchy.size());
  for (std::size_t i = 0; i < level.size(); ++i) level[i] = static_cast<int>(i);
  while (level.size() > 1) {
    std::vector<int> above;
    for (std::size_t i = 0; i < level.size(); i += 2) {
      if (i + 1 == level.size()) {
        above.push_back(level[i]);
        continue;
      }
      core::HierarchyNode node;
      node.child[0] = level[i];
      node.child[1] = level[i + 1];
      node.bounds = scene.hierarchy[static_cast<std::size_t>(level[i])].bounds;
      node.bounds.add(scene.hierarchy[static_cast<std::size_t>(level[i + 1])].bounds);
      above.push_back(static_cast<int>(scene.hierarchy.size()));
      scene.hierarchy.push_back(node);
    }
    level = above;
  }
  const core::HierarchyNode root = scene.hierarchy.back();
  scene.hierarchy.insert(scene.hierarchy.begin(), root);
  for (core::HierarchyNode& node : scene.hierarchy) {
    for (int& child : node.child) child += child >= 0 ? 1 : 0;
  }
}

TEST_P(BaseLayer, CullingLeavesTheImageAlone) {
  Scene open = surroundings(), culled = surroundings();
  addHierarchy(culled);
  for (core::Object& object : open.objects) object.closed = false;  // back faces drawn as well
  std::size_t outside = 0;
  for (int turn = 0; turn < 6; ++turn) {
    core::Camera camera;
    camera.eye = {0.3f * turn, 0.1f, -0.2f * turn};
    camera.at = camera.eye + Vec3(std::sin(1.1f * turn), 0.3f * (turn - 3), std::cos(1.1f * turn));
    const auto all = draw(open, nullptr, 48, 40, camera);
    EXPECT_EQ(stats_.objectsCulled, 0u);
    const auto some = draw(culled, nullptr, 48, 40, camera);
    outside += stats_.objectsCulled;
    EXPECT_EQ(stats_.objectsDrawn + stats_.objectsCulled, culled.objects.size());
    EXPECT_EQ(all->baseAndId, some->baseAndId) << "turn " << turn;
    EXPECT_EQ(all->depth, some->depth) << "turn " << turn;
  }
  EXPECT_GT(outside, 200u);
}

/// Boxes as instances of one mesh and light from the maps: turned, stretched, mirrored.
Scene instancedBoxes() {
  Scene scene;
  scene.materials = {lambert(Vec3(1)), lambert(Vec3(0.2f, 0.9f, 0.4f))};
  scene.materials[1].doubleSided = true;
  Thing box = makeBox(Vec3(-0.5f), Vec3(0.5f));
  box.mesh.instanced = true;
  scene.meshes.push_back(box.mesh);
  std::mt19937 random(6);
  std::uniform_real_distribution<float> place(-3, 3), size(-1.5f, 1.5f);
  for (int i = 0; i < 60; ++i) {
    core::Object o = box.object;
    o.material = i % 2;
    o.id = static_cast<std::uint32_t>(i + 1);
    o.meshToWorld = glm::translate(core::Mat4(1), Vec3(place(random), place(random), place(random) - 5)) *
                    glm::rotate(core::Mat4(1), static_cast<float>(i), Vec3(0.6f, 0, 0.8f)) *
                    glm::scale(core::Mat4(1), Vec3(size(random), size(random), 0.7f));
    o.lightmapScaleOffset = {0.25f, 0.5f, 0.25f * static_cast<float>(i % 4),
                             0.5f * static_cast<float>(i % 2)};
    o.bounds = {};
    for (const Vec3& p : box.mesh.positions) o.bounds.add(Vec3(o.meshToWorld * core::Vec4(p, 1)));
    scene.bounds.add(o.bounds);
    scene.objects.push_back(o);
  }
  return scene;
}

TEST_P(BaseLayer, InstancesAreDrawnAsTheFlattenedSceneIs) {
  const Scene scene = instancedBoxes();
  Scene flat = scene;
  core::chooseInstances(flat, ~std::size_t{0});
  for (core::Object& o : flat.objects) {
    for (core::Vec2& uv : flat.meshOf(o).lightmapUv) uv = core::placeInAtlas(o.lightmapScaleOffset, uv);
    o.lightmapScaleOffset = {1, 1, 0, 0};
  }
  core::IlluminationMaps maps;
  maps.width = 4;
  maps.height = 2;
  maps.layers = 2;
  for (int i = 0; i < 4 * 2 * 2 * 3; ++i)
    maps.texels.push_back(glm::packHalf1x16(1 + 0.25f * static_cast<float>(i)));
  const auto a = draw(scene, &maps, 96, 96, {}), b = draw(flat, &maps, 96, 96, {});
  EXPECT_GT(b->nonDiffusePixels, 3000);
  int others = 0;
  for (std::size_t i = 0; i < a->baseAndId.size(); ++i) {
    const bool same = a->baseAndId[i].w == b->baseAndId[i].w && std::abs(a->depth[i] - b->depth[i]) < 1e-5f &&
                      glm::length(Vec3(a->baseAndId[i]) - Vec3(b->baseAndId[i])) < 0.02f;
    others += !same;  // an edge on this side of a pixel's centre or on that
  }
  EXPECT_LE(others, 10);
}

TEST_P(BaseLayer, SolidAroundTheCameraShowsItsInside) {
  Scene scene;
  scene.materials.push_back(lambert(Vec3(1)));
  scene.materials[0].doubleSided = true;
  addObject(scene, makeBox(Vec3(-1), Vec3(1), 0, 9));
  const auto frame = draw(scene);
  EXPECT_EQ(frame->nonDiffusePixels, 32u * 32u);
}

TEST_P(BaseLayer, SizesChangeAtAnyTime) {
  const Scene scene = surroundings();
  render::BaseRenderer renderer(*context_, scene);
  const auto at = [&](int w, int h) { return renderer.render(View({}, w, h, scene.bounds), 1, kNMin); };
  const auto first = at(64, 48);
  EXPECT_EQ(at(1, 1)->baseAndId.size(), 1u);
  EXPECT_EQ(at(3, 5)->depth.size(), 15u);
  EXPECT_EQ(at(517, 3)->extents.size(), 121u);
  const auto again = at(64, 48);
  EXPECT_EQ(first->baseAndId, again->baseAndId);
  EXPECT_EQ(first->depth, again->depth);
}

TEST_P(BaseLayer, SizeBeyondTheLimitIsRefusedAndNothingIsLost) {
  const Scene scene = oneQuad(lambert(Vec3(1)), 1);
  render::BaseRenderer renderer(*context_, scene);
  EXPECT_THROW(renderer.render(View({}, context_->maxSize() + 1, 2, scene.bounds), 1, kNMin), core::Error);
  EXPECT_EQ(renderer.render(View({}, 4, 4, scene.bounds), 1, kNMin)->idAt(2, 2), 1u);
}

TEST_P(BaseLayer, EmptySceneIsBackground) {
  const auto frame = draw(Scene{}, nullptr, 3, 2);
  EXPECT_EQ(frame->baseAndId, std::vector<Vec4>(6, Vec4(0)));
  EXPECT_EQ(frame->depth, std::vector<float>(6, 1.0f));
  EXPECT_EQ(frame->nonDiffusePixels, 0u);
}

TEST_P(BaseLayer, MapsWhoseCountsDisagreeAreRefused) {
  const Scene scene = oneQuad(lambert(Vec3(1)));
  render::BaseRenderer renderer(*context_, scene);
  core::IlluminationMaps maps = constantMaps({Vec3(1)});
  maps.texels.pop_back();
  EXPECT_THROW(renderer.setMaps(&maps), core::Error);
}

TEST_P(BaseLayer, HeldFramesStayAndReleasedBuffersAreReused) {
  const Scene scene = oneQuad(lambert(Vec3(1)), 1);
  render::BaseRenderer renderer(*context_, scene);
  core::Camera away;
  away.at = {0, 0, 1};
  auto held = renderer.render(View({}, 8, 8, scene.bounds), 1, kNMin);
  const std::vector<Vec4> copy = held->baseAndId;
  const auto other = renderer.render(View(away, 8, 8, scene.bounds), 2, kNMin);
  EXPECT_EQ(held->baseAndId, copy);
  EXPECT_EQ(held->epoch, 1u);
  EXPECT_EQ(other->epoch, 2u);
  EXPECT_EQ(other->nonDiffusePixels, 0u);
  const Vec4* buffer = held->baseAndId.data();
  std::thread([frame = std::move(held)]() mutable { frame.reset(); }).join();
  EXPECT_EQ(renderer.render(View({}, 8, 8, scene.bounds), 3, kNMin)->baseAndId.data(), buffer);
}

TEST_P(BaseLayer, OtherThreadsAreRefused) {
  const Scene scene = oneQuad(lambert(Vec3(1)));
  render::BaseRenderer renderer(*context_, scene);
  const View view({}, 4, 4, scene.bounds);
  bool refused = false;
  std::thread([&] {
    try {
      renderer.render(view, 1, kNMin);
    } catch (const core::Error&) {
      refused = true;
    }
  }).join();
  EXPECT_TRUE(refused);
}

/// Bit-identical on the same renderer; a GPU behind EGL may place edges otherwise.
TEST(BaseLayers, OsmesaAndEglDrawTheSame) {
  Scene scene = surroundings();
  scene.textures.push_back(
      makeTexture(2, 2, {{255, 0, 0, 255}, {0, 255, 0, 255}, {9, 9, 9, 255}, {200, 99, 0, 255}}, true));
  scene.materials[0].baseColorTexture.texture = 0;
  const core::IlluminationMaps maps = constantMaps({Vec3(2)});
  std::shared_ptr<FrameSnapshot> frames[2];
  std::string renderers[2];
  for (const int i : {0, 1}) {
    const auto context =
        render::makeHeadlessContext(i ? render::ContextKind::egl : render::ContextKind::osmesa);
    renderers[i] = context->renderer();
    render::BaseRenderer renderer(*context, scene);
    renderer.setMaps(&maps);
    frames[i] = renderer.render(View({}, 96, 64, scene.bounds), 1, kNMin);
  }
  if (renderers[0] == renderers[1]) {
    EXPECT_EQ(frames[0]->baseAndId, frames[1]->baseAndId);
    EXPECT_EQ(frames[0]->depth, frames[1]->depth);
    return;
  }
  int differing = 0;
  for (std::size_t i = 0; i < frames[0]->baseAndId.size(); ++i) {
    differing += glm::length(frames[0]->baseAndId[i] - frames[1]->baseAndId[i]) > 0.01f;
  }
  EXPECT_LT(differing, 96 * 64 / 50);
}

}  // namespace
}  // namespace saccade::tests
