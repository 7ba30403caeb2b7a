// Memory and time of one file: every large allocation is refused before it is made.
#include "core/load_budget.h"

#include <gtest/gtest.h>

#include "core/image_io.h"
#include "core/scene/load.h"
#include "tests/unit/core/gltf_builder.h"
#include "tests/unit/core/temporary_folder.h"

namespace saccade::core {
namespace {

using saccade::tests::GltfBuilder;
using saccade::tests::TemporaryFolder;

constexpr std::uint64_t kMebi = 1u << 20;

template <class Action>
std::string messageOf(Action&& action) {
  try {
    action();
    return "";
  } catch (const Error& e) {
    return e.what();
  }
}

std::string refusal(const std::filesystem::path& file, std::uint64_t mebibytes, double seconds = 300) {
  LoadOptions options;
  options.limits.memoryBytes = mebibytes * kMebi;
  options.limits.seconds = seconds;
  return messageOf([&] { loadScene(file, options); });
}

void expectPart(const std::string& whole, const std::string& part) {
  EXPECT_NE(whole.find(part), std::string::npos) << "'" << whole << "' lacks '" << part << "'";
}

TEST(LoadBudget, ChargesUpToTheLimitAndNoFurther) {
  LoadLimits limits;
  limits.memoryBytes = 10 * kMebi;
  LoadBudget budget(limits, "room.glb");
  budget.charge(10 * kMebi, "images[0]");
  budget.release(kMebi);
  EXPECT_EQ(messageOf([&] { budget.charge(kMebi + 1, "images[1]"); }),
            "room.glb: images[1]: needs 2 MiB besides the 9 MiB in use; --max-memory allows 10 MiB in all");
  EXPECT_EQ(messageOf([&] { budget.charge(2 * kMebi, "room.glb: images[1]"); }),
            "room.glb: images[1]: needs 2 MiB besides the 9 MiB in use; --max-memory allows 10 MiB in all");
  budget.charge(kMebi, "images[1]");
  EXPECT_EQ(budget.used(), 10 * kMebi);
}

TEST(LoadBudget, ProductsThatOverflowAreRefused) {
  LoadBudget budget({}, "a");
  EXPECT_NE(messageOf([&] { budget.charge(1ull << 62, 12, "accessors[0]"); }), "");
}

TEST(LoadBudget, TimeRunsOut) {
  LoadLimits limits;
  limits.seconds = 0;
  LoadBudget budget(limits, "room.glb");
  while (!budget.timeIsUp()) {
  }
  EXPECT_EQ(messageOf([&] { budget.checkTime(); }),
            "room.glb: takes longer than the 0 s that --max-load-seconds allows");
}

TEST(LoadBudget, AnAccessorOfZerosCostsNothingInTheFile) {
  TemporaryFolder folder;
  GltfBuilder b;
  b.json["accessors"][0].erase("bufferView");
  b.json["accessors"][0]["count"] = 200'000'000;
  expectPart(refusal(b.write(folder / "a.glb"), 1024), "meshes[0]: needs");
}

TEST(LoadBudget, ImagesThatEachPassMayNotTogether) {
  TemporaryFolder folder;
  writePng(folder / "a.png", ImageRgba8(1024, 1024, Rgba8{1, 2, 3, 255}));  // 4 MiB, in a few kilobytes
  GltfBuilder b;
  for (int i = 0; i < 8; ++i) {
    b.json["images"].push_back({{"uri", "a.png"}});
    b.json["textures"].push_back({{"source", i}});
    b.material();
    b.json["materials"][static_cast<std::size_t>(i)] = {{"normalTexture", {{"index", i}}}};
  }
  const auto file = b.write(folder / "a.glb");
  EXPECT_EQ(refusal(file, 256), "");
  expectPart(refusal(file, 20), "images[");
}

TEST(LoadBudget, JsonIsChargedByWhatItBecomes) {
  TemporaryFolder folder;
  GltfBuilder b;
  b.json["extras"] = std::vector<int>(500'000, 1);
  const auto file = b.write(folder / "a.glb");  // 1 MB of text
  EXPECT_EQ(refusal(file, 1024), "");
  expectPart(refusal(file, 30), "JSON");
}

TEST(LoadBudget, LoadingStopsWhenTheTimeIsUp) {
  TemporaryFolder folder;
  GltfBuilder b;
  expectPart(refusal(b.write(folder / "a.glb"), 1024, 1e-9), "--max-load-seconds");
}

}  // namespace
}  // namespace saccade::core
