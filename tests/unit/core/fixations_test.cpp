#include "core/metrics/fixations.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <tuple>

#include "core/error.h"
#include "tests/unit/core/temporary_folder.h"

namespace saccade::core {
namespace {

class Fixations : public ::testing::Test {
 protected:
  std::filesystem::path table(const std::string& text) {
    const std::filesystem::path file = folder_ / "fixations.csv";
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  /// What readFixations complains of, one line.
  std::string complaint(const std::filesystem::path& file) {
    try {
      readFixations(file);
    } catch (const Error& e) {
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
      EXPECT_EQ(std::string(e.what()).find(file.string()), 0u) << "names the file: " << e.what();
      return e.what();
    }
    ADD_FAILURE() << "accepted";
    return "";
  }
  tests::TemporaryFolder folder_;
};

TEST_F(Fixations, AreReadByImage) {
  const FixationTable read =
      readFixations(table("image,subject,fix_index,x_px,y_px,duration_ms\n"
                          "a.jpg,0,0,395.5,265.7,246.0\na.jpg,0,1,1e2,-3,1\n\"b, c.png\",1,0,0,0,5\n"));
  ASSERT_EQ(read.size(), 2u);
  ASSERT_EQ(read.at("a.jpg").size(), 2u);
  EXPECT_EQ(read.at("a.jpg")[0].x, 395.5f);
  EXPECT_EQ(read.at("a.jpg")[0].y, 265.7f);
  EXPECT_EQ(read.at("a.jpg")[1].x, 100.0f);
  EXPECT_EQ(read.at("a.jpg")[1].y, -3.0f);
  EXPECT_EQ(read.at("b, c.png").size(), 1u);
}

TEST_F(Fixations, ColumnsMayStandInAnyOrderAndLinesEndAsOnWindows) {
  const FixationTable read = readFixations(table("y_px,image,x_px\r\n2,p,1\r\n4,p,3\r\n"));
  ASSERT_EQ(read.at("p").size(), 2u);
  EXPECT_EQ(read.at("p")[1].x, 3.0f);
  EXPECT_EQ(read.at("p")[1].y, 4.0f);
}

TEST_F(Fixations, BadTablesAreOneLineThatNamesWhatIsWanted) {
  for (const char* text : {"", "image,x,y\na,1,2\n", "image,x_px,y_px\n", "\n\n", "\xff\xfe\0\1garbage",
                           "image,x_px,y_px\na,1\n", "image,x_px,y_px\na,1,2,3\n",
                           "image,x_px,x_px,y_px\na,1,2,3\n", "image,x_px,y_px\n\"a,1,2\n"}) {
    EXPECT_NE(complaint(table(text)).find("image, x_px, y_px"), std::string::npos) << text;
  }
}

TEST_F(Fixations, WhatIsNoNumberIsNamedWithItsLine) {
  for (const char* value : {"left", "", "nan", "inf", "1e999", "1.5px", "0x10", "--1"}) {
    const std::string said = complaint(table("image,x_px,y_px\na,1,2\na,3," + std::string(value) + "\n"));
    EXPECT_NE(said.find("line 3: '" + std::string(value) + "'"), std::string::npos) << said;
  }
}

TEST_F(Fixations, FilesThatAreNoneAreSaidSo) {
  EXPECT_NE(complaint(folder_ / "absent.csv").find("no such file"), std::string::npos);
  EXPECT_NE(complaint(folder_.path()).find("not a file"), std::string::npos);
}

FixationTable threePictures() {
  FixationTable t;
  for (int i = 0; i < 40; ++i) {
    t["a"].push_back({static_cast<float>(i), 0});
    t["b"].push_back({static_cast<float>(i), 1});
    t["c"].push_back({static_cast<float>(i), 2});
  }
  return t;
}

TEST(FixationsOnOthers, AreDrawnOnceEachFromTheOthers) {
  const FixationTable t = threePictures();
  for (const std::size_t count : {std::size_t{0}, std::size_t{30}, std::size_t{80}, std::size_t{1000}}) {
    std::set<std::pair<float, float>> seen;
    for (const Fixation& f : fixationsOnOthers(t, "b", count, 1)) {
      EXPECT_NE(f.y, 1) << "its own";
      EXPECT_TRUE(seen.emplace(f.x, f.y).second) << "twice";
    }
    EXPECT_EQ(seen.size(), std::min<std::size_t>(count, 80));
  }
  EXPECT_TRUE(fixationsOnOthers({{"b", {{1, 2}}}}, "b", 10, 1).empty());
}

TEST(FixationsOnOthers, DependOnTheSeedAlone) {
  const FixationTable t = threePictures();
  const auto xs = [&](std::uint32_t seed) {
    std::vector<float> values;
    for (const Fixation& f : fixationsOnOthers(t, "b", 20, seed)) values.push_back(f.x + 100 * f.y);
    return values;
  };
  EXPECT_EQ(xs(1), xs(1));
  EXPECT_NE(xs(1), xs(2));
}

}  // namespace
}  // namespace saccade::core
