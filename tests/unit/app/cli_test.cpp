// The command line as a stranger and a script meet it: exit statuses, one error line, names that others rely
// on.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "app/viewer/panel.h"
#include "core/image_io.h"
#include "tests/command_line.h"
#include "tests/unit/app/fixtures.h"

namespace saccade {
namespace {

using tests::errorLines;
using tests::Ran;
using tests::saccade;
using tests::slurp;

std::string quoted(const std::filesystem::path& file) { return "'" + file.string() + "'"; }
std::filesystem::path output(const std::string& name) { return tests::temporaryFolder() / name; }

const std::string kCornell = quoted(tests::bundled("cornell.glb"));
const std::string kQuick = " --quality preview --size 96x64 ";

TEST(Cli, WrongUsageIsStatusTwoWithAHint) {
  for (const char* arguments :
       {"", "frobnicate", "render", "render a.glb", "render a.glb -o b.png --frobnicate",
        "info a.glb --unit-scale 0", "render a.glb -o b.png --size 12", "render a.glb -o b.txt",
        "render a.glb -o b.png --order sideways", "render a.glb -o b.png --samples 3 --converge"}) {
    const Ran ran = saccade(arguments);
    EXPECT_EQ(ran.status, 2) << arguments << "\n" << ran.err;
    EXPECT_EQ(errorLines(ran.err), 1) << arguments << "\n" << ran.err;
    EXPECT_NE(ran.err.find("--help"), std::string::npos) << ran.err;
  }
}

TEST(Cli, FailuresAreStatusOneAndOneLine) {
  const std::filesystem::path empty = output("empty.glb");
  std::ofstream(empty).close();
  for (const std::string& arguments : {std::string("info /no/such/scene.glb"), "info " + quoted(empty),
                                       "render /no/such.obj -o " + quoted(output("x.png")),
                                       "render " + kCornell + " -o /no/such/folder/x.png" + kQuick}) {
    const Ran ran = saccade(arguments);
    EXPECT_EQ(ran.status, 1) << arguments << "\n" << ran.err;
    EXPECT_EQ(errorLines(ran.err), 1) << arguments << "\n" << ran.err;
  }
  EXPECT_FALSE(std::filesystem::exists(output("x.png")));
}

TEST(Cli, HelpNamesEveryCommandAndEveryOptionHasText) {
  const Ran ran = saccade("--help");
  EXPECT_EQ(ran.status, 0);
  for (const char* command : {"info", "bake", "render", "walk", "compare", "attention"}) {
    EXPECT_NE(ran.out.find(command), std::string::npos);
    const Ran help = saccade(std::string(command) + " --help");
    EXPECT_EQ(help.status, 0);
    EXPECT_GT(help.out.size(), 200u) << command;
  }
}

TEST(Cli, LightsMayStandBeforeTheScene) {
  const Ran ran = saccade(
      "info --json --light point:pos=0,1.5,0,power=9,9,9 --light directional:dir=0,-1,0,irradiance=1,1,1 " +
      kCornell);
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(nlohmann::json::parse(ran.out)["lights"], 3);
}

TEST(Cli, InfoAsJsonHasThePromisedKeys) {
  const Ran ran = saccade("info " + kCornell + " --json");
  ASSERT_EQ(ran.status, 0) << ran.err;
  const nlohmann::json json = nlohmann::json::parse(ran.out);
  for (const char* key :
       {"objects", "triangles", "materials", "lights", "cameras", "bounds", "warnings", "plan"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  for (const auto& line : json["plan"]) {
    EXPECT_TRUE(line.contains("stage") && line["on"].is_boolean() &&
                !line["reason"].get<std::string>().empty());
  }
}

TEST(Cli, RenderBakesByItselfOnceAndConvergesToRaytrace) {
  const Ran first = saccade("render " + kCornell + kQuick + "--method corrective --converge -o " +
                            quoted(output("c.exr")) + " --stats " + quoted(output("c.json")));
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_NE(first.err.find("baking"), std::string::npos) << "says so: " << first.err;
  const Ran second =
      saccade("render " + kCornell + kQuick + "--method raytrace -o " + quoted(output("r.exr")));
  ASSERT_EQ(second.status, 0) << second.err;
  EXPECT_EQ(second.err.find("baking"), std::string::npos) << "the maps were there: " << second.err;
  const Ran compared = saccade("compare --json " + quoted(output("r.exr")) + " " + quoted(output("c.exr")));
  ASSERT_EQ(compared.status, 0) << compared.err;
  const nlohmann::json json = nlohmann::json::parse(compared.out);
  for (const char* key : {"rmse", "relmse", "psnr", "ssim", "flip", "flip_median", "flip_p95", "max_abs"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["max_abs"].get<double>(), 0);
  const nlohmann::json stats = nlohmann::json::parse(slurp(output("c.json")));
  for (const char* key : {"frame_ms", "missed_deadlines", "frames", "samples", "levels", "nondiffuse_pixels",
                          "rays", "rays_per_second", "stages_ms", "peak_bytes", "converged", "seed",
                          "threads", "context", "renderer"}) {
    EXPECT_TRUE(stats.contains(key)) << key;
  }
  EXPECT_EQ(stats["samples"]["traced"], stats["nondiffuse_pixels"]);
  EXPECT_TRUE(stats["converged"].get<bool>());
}

TEST(Cli, EveryMethodAndAovWritesAPicture) {
  for (const char* extra :
       {"--method base", "--method path --spp 2", "--aov id", "--aov level", "--aov thread", "--aov age",
        "--aov saliency", "--samples 50",
        "--base baked --aging haber --order largest --delta 0.2 --max-age 5 --job-size 16", "--budget-ms 5",
        "--lobes diffuse --method path --spp 1", "--diffuse burley --method path --spp 1"}) {
    for (const char* name : {"picture.png", "picture.exr"}) {
      std::filesystem::remove(output(name));
      const Ran ran = saccade("render " + kCornell + kQuick + extra + " -o " + quoted(output(name)));
      ASSERT_EQ(ran.status, 0) << extra << "\n" << ran.err;
      EXPECT_TRUE(std::filesystem::exists(output(name))) << extra;
    }
  }
}

TEST(Cli, PathsMayHoldSpacesAndOtherAlphabets) {
  const std::filesystem::path folder = output("Räume und 部屋");
  std::filesystem::create_directories(folder);
  std::filesystem::copy_file(tests::bundled("cornell.glb"), folder / "ein Raum.glb",
                             std::filesystem::copy_options::overwrite_existing);
  const Ran ran = saccade("render " + quoted(folder / "ein Raum.glb") + kQuick + "--method base -o " +
                          quoted(folder / "Bild é.png"));
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "Bild é.png"));
}

TEST(Cli, WalkOffScreenWritesFramesAndStats) {
  const std::filesystem::path frames = output("frames");
  const Ran ran = saccade(
      "walk " + kCornell + kQuick + "--headless --orbit --fps 20 --seconds 0.5 --frames " + quoted(frames) +
      " --converge -o " + quoted(output("last.exr")) + " --stats " + quoted(output("walk.json")));
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(frames), {}), 10);
  EXPECT_EQ(core::readImage8(frames / "frame_00009.png").width(), 96);
  const nlohmann::json stats = nlohmann::json::parse(slurp(output("walk.json")));
  EXPECT_TRUE(stats["converged"].get<bool>());
  EXPECT_EQ(stats["frames"], 11);
}

TEST(Cli, TheWindowShowsThePictureAndThePanel) {
  if (!std::getenv("DISPLAY")) GTEST_SKIP() << "no display; run under xvfb-run";
  const std::filesystem::path shot = output("window.png");
  const Ran ran =
      saccade("walk " + kCornell + " --quality preview --size 400x400 --exit-after 2 --ui-screenshot " +
                  quoted(shot) + " --stats " + quoted(output("window.json")),
              "XDG_CONFIG_HOME=" + quoted(output("config")) + " ");
  ASSERT_EQ(ran.status, 0) << ran.err;
  const core::ImageRgba8 picture = core::readImage8(shot);
  ASSERT_EQ(picture.width(), 400 + app::kPanelWidth);
  ASSERT_EQ(picture.height(), 400);
  // Cornell's walls: red on the left, green on the right; the panel is dark with bright text.
  const core::Rgba8 left = picture.at(8, 200), right = picture.at(391, 200);
  EXPECT_GT(left.r, left.g + 30);
  EXPECT_GT(right.g, right.r + 30);
  int bright = 0;
  for (int y = 0; y < 400; ++y) {
    for (int x = 400; x < picture.width(); ++x) bright += picture.at(x, y).g > 200 ? 1 : 0;
  }
  EXPECT_GT(bright, 500);
  const nlohmann::json stats = nlohmann::json::parse(slurp(output("window.json")));
  EXPECT_EQ(stats["context"], "window");
  EXPECT_GT(stats["samples"]["traced"].get<int>(), 0);
}

TEST(Cli, WithoutADisplayTheWindowSaysWhatToDo) {
  const Ran ran = saccade("walk " + kCornell + " --quality preview", "DISPLAY= WAYLAND_DISPLAY= ");
  EXPECT_EQ(ran.status, 1);
  EXPECT_EQ(errorLines(ran.err), 1) << ran.err;
  EXPECT_NE(ran.err.find("--headless"), std::string::npos) << ran.err;
}

TEST(Cli, CompareTellsSizesAndKindsApart) {
  core::writeExr(output("a.exr"), core::ImageRgb(4, 4, core::Vec3(1)));
  core::writeExr(output("b.exr"), core::ImageRgb(5, 4, core::Vec3(1)));
  core::writePng(output("a.png"), core::ImageRgba8(4, 4));
  EXPECT_EQ(saccade("compare " + quoted(output("a.exr")) + " " + quoted(output("b.exr"))).status, 1);
  EXPECT_EQ(saccade("compare " + quoted(output("a.exr")) + " " + quoted(output("a.png"))).status, 2);
  EXPECT_EQ(saccade("compare " + quoted(output("a.exr")) + " " + quoted(output("a.exr"))).status, 0);
}

TEST(Cli, MapsOfAnotherSceneAreRefusedNotOverwritten) {
  const std::filesystem::path maps = output("cornell.maps");
  ASSERT_EQ(saccade("bake " + kCornell + " --quality preview --photons 20000 -o " + quoted(maps)).status, 0);
  const auto before = std::filesystem::last_write_time(maps);
  const Ran ran = saccade("render " + quoted(tests::bundled("table.glb")) + kQuick + "--maps " +
                          quoted(maps) + " --method base -o " + quoted(output("t.png")));
  EXPECT_EQ(ran.status, 1) << ran.err;
  EXPECT_EQ(std::filesystem::last_write_time(maps), before);
}

}  // namespace
}  // namespace saccade
