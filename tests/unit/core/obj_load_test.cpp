// OBJ and MTL to scenes.
#include <gtest/gtest.h>

#include <fstream>

#include "core/image_io.h"
#include "core/scene/load.h"
#include "core/scene/specular_albedo.h"
#include "core/scene/texture_transform.h"
#include "tests/unit/core/temporary_folder.h"

namespace saccade::core {
namespace {

using saccade::tests::TemporaryFolder;

constexpr const char* kQuad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

Scene load(const std::string& obj, const std::string& mtl = "", const LoadOptions& options = {}) {
  TemporaryFolder folder;
  write(folder / "a.obj", obj);
  if (!mtl.empty()) write(folder / "a.mtl", mtl);
  return loadScene(folder / "a.obj", options);
}

Material materialOf(const std::string& mtl) {
  return load(std::string("mtllib a.mtl\n") + kQuad + "usemtl m\nf 1 2 3 4\n", "newmtl m\n" + mtl)
      .materials[0];
}

bool warned(const Scene& scene, const std::string& part) {
  for (const std::string& w : scene.warnings)
    if (w.find(part) != std::string::npos) return true;
  return false;
}

TEST(ObjLoad, AQuadInMetres) {
  LoadOptions options;
  options.unitScale = 0.5f;
  const Scene scene = load(std::string(kQuad) + "f 1 2 3 4\r\n", "", options);
  const Object& o = scene.objects[0];
  EXPECT_EQ(scene.meshOf(o).triangleCount(), 2u);
  EXPECT_EQ(scene.meshOf(o).positions.size(), 4u);  // a plane's corners are shared
  EXPECT_EQ(o.bounds.hi, Vec3(0.5f, 0.5f, 0));
  for (const Vec3& n : scene.meshOf(o).normals) EXPECT_EQ(n, Vec3(0, 0, 1));
}

TEST(ObjLoad, ShapesAndMaterialsAreObjects) {
  const Scene scene = load(std::string("mtllib a.mtl\n") + kQuad +
                               "o first\nusemtl x\nf 1 2 3\nusemtl y\nf 1 3 4\no second\nusemtl x\nf 2 3 4\n",
                           "newmtl x\nKd 1 0 0\nnewmtl y\nKd 0 1 0\nKe 1 1 1\n");
  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(scene.objects[0].name, "first/0");
  EXPECT_EQ(scene.objects[1].name, "first/1");
  EXPECT_EQ(scene.objects[2].name, "second");
  EXPECT_EQ(scene.materials[scene.objects[1].material].baseColor, Vec3(0, 1, 0));
  EXPECT_FALSE(scene.materials[1].doubleSided);  // a lamp shines from its front
  EXPECT_TRUE(scene.materials[0].doubleSided);
}

TEST(ObjLoad, EdgesAreKeptAndCurvesAreSmoothed) {
  // Three faces of a prism: the first two meet at 20 degrees, the third at 90.
  const Scene scene = load(
      "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 1 0 1\nv 1.9397 0.34202 0\nv 1.9397 0.34202 1\nv 1.9397 -1 0\nv 1.9397 "
      "-1 1\n"
      "f 1 2 4 3\nf 3 4 6 5\nf 5 6 8 7\n");
  const Mesh& m = scene.meshes[0];
  int blended = 0, sharp = 0;
  for (std::size_t i = 0; i < m.positions.size(); ++i) {
    if (m.positions[i].x == 1) {
      ++blended;
      EXPECT_LT(std::abs(m.normals[i].x), 0.3f);
      EXPECT_GT(std::abs(m.normals[i].x), 0.05f);  // between the two faces' 0 and 0.342
    }
    if (m.positions[i].x > 1.9f && std::abs(m.normals[i].y) < 1e-3f) ++sharp;  // the third face on its own
  }
  EXPECT_EQ(blended, 2);
  EXPECT_EQ(sharp, 4);
}

TEST(ObjLoad, GivenNormalsAndTextureCoordinatesAreTaken) {
  const Scene scene = load(std::string(kQuad) + "vt 0 0\nvt 0.25 0.75\nvn 0 1 1\nf 1/1/1 2/2/1 3/1/1\n");
  const Mesh& m = scene.meshes[0];
  EXPECT_LT(glm::length(m.normals[0] - glm::normalize(Vec3(0, 1, 1))), 1e-6f);
  EXPECT_EQ(m.uv0[1], Vec2(0.25f, 0.25f));  // v runs down
}

TEST(ObjLoad, BadIndicesAreDroppedAndCounted) {
  const Scene scene = load(std::string(kQuad) + "f 1 2 3\nf 1 2 99\nf -9 -8 -7\n");
  EXPECT_EQ(scene.meshes[0].triangleCount(), 1u);
  EXPECT_TRUE(warned(scene, "dropped"));
  EXPECT_THROW(load(std::string(kQuad) + "f 1 2 99999999999\n"), Error);
}

TEST(ObjLoad, OddFilesAreRefusedOrRepaired) {
  EXPECT_THROW(load("nothing here\n"), Error);
  EXPECT_THROW(load("v 0 0 0\nv 1 0 0\nf 1 2\n"), Error);
  EXPECT_THROW(load("v nan 0 0\nv 1e999 0 0\nv 0 1 0\nf 1 2 3\n"), Error);
  std::string round = "", face = "f";
  for (int i = 0; i < 300; ++i) {
    round +=
        "v " + std::to_string(std::cos(i * 0.020944)) + " " + std::to_string(std::sin(i * 0.020944)) + " 0\n";
    face += " " + std::to_string(i + 1);
  }
  EXPECT_EQ(load(round + face + "\n").meshes[0].triangleCount(), 298u);
}

TEST(ObjLoad, MaterialLibrariesStayInTheFolder) {
  TemporaryFolder folder;
  std::filesystem::create_directories(folder / "scene");
  write(folder / "outside.mtl", "newmtl m\nKd 1 0 0\n");
  write(folder / "scene/a.obj", std::string("mtllib ../outside.mtl\n") + kQuad + "usemtl m\nf 1 2 3\n");
  EXPECT_THROW(loadScene(folder / "scene/a.obj", {}), Error);
  write(folder / "scene/b.obj", std::string("mtllib missing.mtl\n") + kQuad + "usemtl m\nf 1 2 3\n");
  const Scene scene = loadScene(folder / "scene/b.obj", {});
  EXPECT_TRUE(warned(scene, "missing.mtl"));
  EXPECT_EQ(scene.materials[scene.objects[0].material].name, "OBJ default");
}

TEST(ObjMaterials, PlainKdIsLambert) {
  const Material m = materialOf("Kd 0.2 0.3 0.4\nKs 0 0 0\nNs 10\nillum 2\n");
  EXPECT_EQ(m.baseColor, Vec3(0.2f, 0.3f, 0.4f));
  EXPECT_EQ(m.metallic, 0);
  EXPECT_EQ(baseDiffuseFactor(Scene{}, m), 1);
}

TEST(ObjMaterials, Illum5IsAPerfectMirror) {
  const Material m = materialOf("Kd 0.01 0.01 0.01\nKs 0.95 0.9 0.8\nNs 1000\nillum 5\n");
  EXPECT_EQ(m.metallic, 1);
  EXPECT_EQ(m.roughness, 0);
  EXPECT_EQ(m.baseColor, Vec3(0.95f, 0.9f, 0.8f));
}

TEST(ObjMaterials, Illum7IsClearGlass) {
  const Material m = materialOf("Kd 0.01 0.01 0.01\nKs 0.3 0.3 0.3\nTf 0.1 0.1 0.1\nNi 2.5\nillum 7\n");
  EXPECT_EQ(m.transmission, 1);
  EXPECT_EQ(m.ior, 2.5f);
  EXPECT_EQ(m.roughness, 0);
  EXPECT_EQ(m.baseColor, Vec3(1));
  EXPECT_EQ(materialOf("Tf 0.2 0.4 0.4\nNi 1.5\nillum 4\n").baseColor, Vec3(0.5f, 1, 1));
}

TEST(ObjMaterials, PlasticReflectsKsAtNormalIncidence) {
  const Material m = materialOf("Kd 0.5 0.5 0.5\nKs 0.2 0.1 0.3\nNs 38\nillum 2\n");
  EXPECT_EQ(m.metallic, 0);
  EXPECT_LT(glm::length(dielectricF0(m) - Vec3(0.2f, 0.1f, 0.3f)), 1e-6f);
  EXPECT_NEAR(m.roughness * m.roughness, std::sqrt(2.0f / 40), 1e-6f);
}

TEST(ObjMaterials, DissolveIsCoverage) {
  const Material m = materialOf("Kd 0.5 0.5 0.5\nd 0.25\nillum 2\n");
  EXPECT_EQ(m.alphaMode, AlphaMode::blend);
  EXPECT_EQ(m.alpha, 0.25f);
}

TEST(ObjMaterials, TexturesBesideTheScene) {
  TemporaryFolder folder;
  writePng(folder / "red.png", ImageRgba8(1, 1, {200, 0, 0, 255}));
  write(folder / "a.mtl", "newmtl m\nKd 1 1 1\nmap_Kd red.png\nnewmtl n\nmap_Kd gone.png\n");
  write(folder / "a.obj",
        std::string("mtllib a.mtl\n") + kQuad + "vt 0 0\nusemtl m\nf 1/1 2/1 3/1\nusemtl n\nf 1 3 4\n");
  const Scene scene = loadScene(folder / "a.obj", {});
  ASSERT_EQ(scene.textures.size(), 1u);
  EXPECT_TRUE(scene.textures[0].srgb);
  EXPECT_EQ(scene.materials[0].baseColorTexture.texture, 0);
  EXPECT_FALSE(scene.materials[1].baseColorTexture);
  EXPECT_TRUE(warned(scene, "gone.png"));
  write(folder / "a.mtl", "newmtl m\nmap_Kd ../red.png\n");
  std::filesystem::copy_file(folder / "red.png", folder.path().parent_path() / "red.png",
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_THROW(loadScene(folder / "a.obj", {}), Error);
  std::filesystem::remove(folder.path().parent_path() / "red.png");
}

TEST(ObjMaterials, ThePhysicallyBasedExtension) {
  const Material m = materialOf(
      "Kd 0.8 0.4 0.2\nKs 0.5 0.5 0.5\nNs 100\nNi 1.8\nillum 3\nPr 0.3\nPm 0.6\nPs 0.25\nPc 0.75\nPcr 0.125\n"
      "aniso 0.5\nanisor 0.25\nKe 1 2 3\n");
  EXPECT_EQ(m.baseColor, Vec3(0.8f, 0.4f, 0.2f));
  EXPECT_EQ(m.roughness, 0.3f);
  EXPECT_EQ(m.metallic, 0.6f);
  EXPECT_EQ(m.ior, 1.8f);
  EXPECT_EQ(m.specular, 1);
  EXPECT_EQ(m.specularColor, Vec3(1));
  EXPECT_EQ(m.sheenColor, Vec3(0.25f));
  EXPECT_EQ(m.clearcoat, 0.75f);
  EXPECT_EQ(m.clearcoatRoughness, 0.125f);
  EXPECT_EQ(m.anisotropy, 0.5f);
  EXPECT_FLOAT_EQ(m.anisotropyRotation, kPi / 2);
  EXPECT_EQ(m.emission, Vec3(1, 2, 3));
  const Scene scene = load(std::string("mtllib a.mtl\n") + kQuad + "usemtl m\nf 1 2 3 4\n",
                           "newmtl m\nTf 1 1 1\nNi 1.5\nillum 6\nPr 0.25\nPc 9\nPs -1\n");
  const Material& frosted = scene.materials[0];
  EXPECT_EQ(frosted.transmission, 1);
  EXPECT_EQ(frosted.roughness, 0.25f);
  EXPECT_EQ(frosted.clearcoat, 1);
  EXPECT_EQ(frosted.sheenColor, Vec3(0));
  EXPECT_TRUE(warned(scene, "2 material factors out of range were clamped (first: material m)"));
}

TEST(ObjMaterials, TextureOptionsPlaceClampAndScale) {
  TemporaryFolder folder;
  writePng(folder / "a.png", ImageRgba8(2, 2, {200, 0, 0, 255}));
  write(folder / "a.mtl",
        "newmtl m\nmap_Kd -s 2 4 1 -o 0.25 0.5 0 a.png\nnorm -bm 0.5 -clamp on a.png\nmap_Ke a.png\n");
  write(folder / "a.obj", std::string("mtllib a.mtl\n") + kQuad + "vt 0.1 0.2\nusemtl m\nf 1/1 2/1 3/1\n");
  const Scene scene = loadScene(folder / "a.obj", {});
  const Material& m = scene.materials[0];
  // MTL, v up: (0.1, 0.2) * (2, 4) + (0.25, 0.5) = (0.45, 1.3); v down: 1 - 1.3.
  const Vec2 at = uvMatrix(m.baseColorTexture) * Vec3(scene.meshOf(scene.objects[0]).uv0[0], 1);
  EXPECT_LT(glm::length(at - Vec2(0.45f, -0.3f)), 1e-6f);
  EXPECT_FALSE(m.emissionTexture.transformed());
  EXPECT_EQ(m.normalScale, 0.5f);
  EXPECT_EQ(scene.textures[static_cast<std::size_t>(m.normalTexture.texture)].wrapS, Wrap::clamp);
  EXPECT_EQ(scene.textures[static_cast<std::size_t>(m.baseColorTexture.texture)].wrapT, Wrap::repeat);
}

TEST(ObjMaterials, RoughnessAndMetalMapsAreOneTexture) {
  TemporaryFolder folder;
  writePng(folder / "rough.png", ImageRgba8(4, 2, {50, 50, 50, 255}));
  ImageRgba8 metal(2, 1, {0, 0, 0, 255});
  metal.at(1, 0) = {255, 255, 255, 255};
  writePng(folder / "metal.png", metal);
  const auto load = [&](const std::string& mtl) {
    write(folder / "a.mtl", "newmtl m\n" + mtl);
    write(folder / "a.obj", std::string("mtllib a.mtl\n") + kQuad + "vt 0 0\nusemtl m\nf 1/1 2/1 3/1\n");
    return loadScene(folder / "a.obj", {});
  };
  const Scene both = load("Pr 0.1\nPm 0.1\nmap_Pr rough.png\nmap_Pm metal.png\n");
  const Material& m = both.materials[0];
  EXPECT_EQ(m.roughness, 1);
  EXPECT_EQ(m.metallic, 1);
  ASSERT_TRUE(m.metallicRoughnessTexture);
  const Texture& t = both.textures[static_cast<std::size_t>(m.metallicRoughnessTexture.texture)];
  EXPECT_FALSE(t.srgb);
  EXPECT_EQ(t.image.at(0, 1), (Rgba8{255, 50, 0, 255}));
  EXPECT_EQ(t.image.at(3, 0), (Rgba8{255, 50, 255, 255}));
  const Scene one = load("Pr 0.1\nPm 0.2\nmap_Pr gone.png\nmap_Pm metal.png\n");
  EXPECT_EQ(one.materials[0].roughness, 0.1f);
  EXPECT_EQ(one.materials[0].metallic, 1);
  EXPECT_TRUE(warned(one, "gone.png"));
}

}  // namespace
}  // namespace saccade::core
