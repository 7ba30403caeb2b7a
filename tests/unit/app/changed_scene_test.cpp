// A scene file that was edited between two bakes, through the program itself: what is baked again, and said.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "app/session/maps_note.h"
#include "core/maps.h"
#include "core/scene_state.h"
#include "tests/command_line.h"
#include "tests/temporary_folder.h"

namespace saccade {
namespace {

using tests::Ran;
using tests::saccade;

struct Edit {
  double boxX = 0.4;
  double boxRed = 0.7;
  double lamp = 5;
  bool box = true;
};

/// Writes an OBJ of two closed rooms, a lamp in each and a box in the first, with its materials.
class RoomsFile {
 public:
  explicit RoomsFile(const std::string& name) : file_(tests::temporaryFolder() / (name + ".obj")) {}

  std::string write(const Edit& edit) {
    vertices_ = {};
    faces_ = {};
    corners_ = 0;
    for (int i = 0; i < 2; ++i) {
      const double x = 2.2 * i;
      const std::string n = std::to_string(i);
      box("room" + n + "-", "wall", {x, 0, 0}, {2, 2, 2}, true);
      quad("lamp" + n, i == 0 ? "first" : "second", {x + 0.7, 1.9, 0.7}, {0.6, 0, 0}, {0, 0, 0.6});
    }
    if (edit.box) box("crate-", "crate", {edit.boxX, 0.01, 0.4}, {0.5, 0.6, 0.5}, false);
    std::filesystem::path materials = file_;
    materials.replace_extension(".mtl");
    std::ofstream(materials) << "newmtl wall\nKd 0.6 0.6 0.6\nnewmtl first\nKd 0 0 0\nKe " << edit.lamp
                             << " 5 5\n"
                             << "newmtl second\nKd 0 0 0\nKe 5 5 5\nnewmtl crate\nKd " << edit.boxRed
                             << " 0.2 0.2\n";
    std::ofstream(file_) << "mtllib " << materials.filename().string() << "\n"
                         << vertices_.str() << faces_.str();
    return "'" + file_.string() + "'";
  }

 private:
  using V = std::array<double, 3>;
  static V plus(const V& a, const V& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

  void quad(const std::string& name, const std::string& material, const V& corner, const V& u, const V& v) {
    for (const V& p : {corner, plus(corner, u), plus(plus(corner, u), v), plus(corner, v)})
      vertices_ << "v " << p[0] << " " << p[1] << " " << p[2] << "\n";
    faces_ << "o " << name << "\nusemtl " << material << "\nf";
    for (int k = 0; k < 4; ++k) faces_ << " " << ++corners_;
    faces_ << "\n";
  }
  void box(const std::string& name, const std::string& material, const V& lo, const V& e, bool inside) {
    const V x{e[0], 0, 0}, y{0, e[1], 0}, z{0, 0, e[2]};
    int n = 0;
    const auto side = [&](const V& corner, const V& u, const V& v) {
      quad(name + std::to_string(n++), material, corner, inside ? v : u, inside ? u : v);
    };
    side(lo, x, z);
    side(plus(lo, y), z, x);
    side(lo, y, x);
    side(plus(lo, z), x, y);
    side(lo, z, y);
    side(plus(lo, x), y, z);
  }

  std::filesystem::path file_;
  std::ostringstream vertices_, faces_;
  int corners_ = 0;
};

/// `saccade bake` in a hurry.
Ran bake(const std::string& scene, const std::string& maps, const std::string& options = "") {
  return saccade("bake " + scene + " -o '" + (tests::temporaryFolder() / maps).string() +
                 "' --quality preview --photons 50000 --threads 2 " + options);
}

/// What the line about a change says, from "changed (" on; empty where there is none.
std::string changeOf(const Ran& ran) {
  EXPECT_EQ(ran.status, 0) << ran.err;
  const std::size_t at = ran.err.find("changed (");
  return at == std::string::npos ? "" : ran.err.substr(at, ran.err.find('\n', at) - at);
}

bool mentions(const std::string& line, const std::string& what) {
  return line.find(what) != std::string::npos;
}

/// Of "A of B charts (C % of texels) baked again".
struct Counts {
  int again = -1, all = -1, percent = -1;
};
Counts countsOf(const std::string& line) {
  Counts c;
  const std::size_t at = line.find("): ");
  if (at != std::string::npos)
    std::sscanf(line.c_str() + at, "): %d of %d charts (%d %% of texels) baked again", &c.again, &c.all,
                &c.percent);
  return c;
}

TEST(ChangedScene, EachBakeOfAnEditedFileSaysWhatItBakesAgain) {
  RoomsFile rooms("edited");
  EXPECT_EQ(changeOf(bake(rooms.write({}), "first.maps")), "") << "nothing to compare with";

  // The maps go to another file each time: the note knows where the newest are.
  const std::string moved = changeOf(bake(rooms.write({.boxX = 0.9}), "second.maps"));
  EXPECT_TRUE(mentions(moved, "crate-0 (moved)")) << moved;
  const Counts ofMoved = countsOf(moved);
  EXPECT_EQ(ofMoved.all, 18) << moved;
  EXPECT_GE(ofMoved.again, 7) << "the box and the floor: " << moved;
  EXPECT_LE(ofMoved.again, 12) << "never the second room: " << moved;
  EXPECT_LT(ofMoved.percent, 62) << moved;

  const std::string painted = changeOf(bake(rooms.write({.boxX = 0.9, .boxRed = 0.69}), "second.maps"));
  EXPECT_TRUE(mentions(painted, "crate-0 (material)")) << painted;
  EXPECT_EQ(countsOf(painted).again, 0) << painted;

  const std::string gone = changeOf(bake(rooms.write({.box = false}), "second.maps"));
  EXPECT_TRUE(mentions(gone, "crate-0 (gone)")) << gone;
  EXPECT_EQ(countsOf(gone).all, 12) << gone;
  EXPECT_LE(countsOf(gone).again, 6) << gone;

  const std::string lit = changeOf(bake(rooms.write({.lamp = 9, .box = false}), "second.maps"));
  EXPECT_TRUE(mentions(lit, "changed (lamp0)")) << lit;
  EXPECT_EQ(countsOf(lit).again, 6) << lit;

  EXPECT_EQ(changeOf(bake(rooms.write({.lamp = 9, .box = false}), "second.maps")), "")
      << "the same: baked whole";
}

TEST(ChangedScene, MapsOfAnotherSeedOrThatAreGoneAreNotGoneOnWith) {
  RoomsFile rooms("alone");
  bake(rooms.write({}), "alone.maps");
  EXPECT_EQ(changeOf(bake(rooms.write({.lamp = 6}), "alone.maps", "--seed 2")), "");
  std::filesystem::remove(tests::temporaryFolder() / "alone.maps");
  EXPECT_EQ(changeOf(bake(rooms.write({.lamp = 7}), "alone.maps")), "");
}

TEST(ChangedScene, MapsThatWereWrittenAnewSinceAreNotGoneOnWith) {
  RoomsFile rooms("anew");
  bake(rooms.write({}), "anew.maps");
  bake(rooms.write({}), "anew.maps", "--seed 2");  // the same scene, noted elsewhere
  const Ran ran = bake(rooms.write({.lamp = 6}), "anew.maps");
  EXPECT_EQ(changeOf(ran), "");
  EXPECT_NE(ran.err.find("was written anew"), std::string::npos) << ran.err;
}

TEST(ChangedScene, MapsThatKeptTexelsServeTheViewer) {
  RoomsFile rooms("shown");
  bake(rooms.write({}), "shown.maps");
  const std::string scene = rooms.write({.boxX = 0.9});
  EXPECT_NE(changeOf(bake(scene, "shown.maps")), "");
  const std::filesystem::path image = tests::temporaryFolder() / "shown.png";
  const Ran shown =
      saccade("render " + scene + " --maps '" + (tests::temporaryFolder() / "shown.maps").string() +
              "' -o '" + image.string() + "' --size 32x32 --method base --quality preview --threads 2");
  EXPECT_EQ(shown.status, 0) << shown.err;
  EXPECT_EQ(shown.err.find("baking"), std::string::npos) << shown.err;
  EXPECT_TRUE(std::filesystem::exists(image));
}

TEST(ChangedScene, NoteComesBackAsItWasAndDamageIsRefused) {
  app::MapsNote note;
  note.maps = "/somewhere/x.maps";
  note.key = 42;
  note.light = 43;
  note.scene.drift = 0.01;
  core::SceneState& state = note.scene.state;
  state.environment = 7;
  core::PunctualLight& light = state.lights.emplace_back();
  light.name = "bulb";
  light.range = 3;
  state.objects.push_back({1, 2, core::Vec3(3, 4, 5)});
  core::Material& material = state.plain.materials.emplace_back();
  material.baseColor = core::Vec3(0.1f, 0.2f, 0.3f);
  material.doubleSided = true;
  material.alphaMode = core::AlphaMode::blend;
  core::Object object;
  object.name = "thing";
  core::Mesh mesh;
  mesh.positions = {core::Vec3(0), core::Vec3(1, 0, 0), core::Vec3(0, 1, 0)};
  mesh.normals.assign(3, core::Vec3(0, 0, 1));
  mesh.indices = {0, 1, 2};
  state.plain.add(object, mesh);
  const std::filesystem::path file = tests::temporaryFolder() / "x.newest";
  app::writeNote(file, note);
  const app::MapsNote read = app::readNote(file);
  EXPECT_EQ(read.maps, note.maps);
  EXPECT_EQ(read.key, note.key);
  EXPECT_EQ(read.light, note.light);
  EXPECT_EQ(read.scene.drift, note.scene.drift);
  EXPECT_EQ(read.scene.state.environment, 7u);
  ASSERT_EQ(read.scene.state.lights.size(), 1u);
  EXPECT_EQ(read.scene.state.lights[0].name, "bulb");
  EXPECT_EQ(read.scene.state.lights[0].range, 3);
  ASSERT_EQ(read.scene.state.objects.size(), 1u);
  EXPECT_EQ(read.scene.state.objects[0].emission, core::Vec3(3, 4, 5));
  const core::Scene& plain = read.scene.state.plain;
  EXPECT_EQ(plain.materials[0].baseColor, material.baseColor);
  EXPECT_TRUE(plain.materials[0].doubleSided);
  EXPECT_EQ(plain.materials[0].alphaMode, core::AlphaMode::blend);
  EXPECT_EQ(plain.meshes[0].positions, mesh.positions);
  EXPECT_EQ(plain.meshes[0].indices, mesh.indices);
  EXPECT_EQ(plain.objects[0].name, "thing");

  std::string bytes = tests::slurp(file);
  for (const std::size_t at : {std::size_t{3}, bytes.size() / 2, bytes.size() - 1}) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    std::ofstream(file, std::ios::binary) << damaged;
    EXPECT_THROW(app::readNote(file), core::Error) << at;
  }
  std::ofstream(file, std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  EXPECT_THROW(app::readNote(file), core::Error);
}

}  // namespace
}  // namespace saccade
