// The reader of what test programs report of the hard cases.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/hard/cases.h"
#include "bench/hard/test_report.h"
#include "bench/harness/process.h"
#include "core/error.h"
#include "tests/hard_case.h"

namespace saccade::bench {
namespace {

using nlohmann::json;
using tests::HardCase;

/// A report of one test with these properties.
std::string reportOf(const std::string& name, const json& properties, bool failed = false) {
  json test = {{"name", name}, {"classname", "Suite"}, {"status", "RUN"}, {"time", "0.1s"}};
  test.update(properties);
  if (failed) test["failures"] = json::array({{{"failure", "no"}}});
  return json({{"tests", 1},
               {"testsuites", json::array({{{"name", "Suite"}, {"testsuite", json::array({test})}}})}})
      .dump();
}

/// What the running test recorded so far, as a report of it.
std::string recorded(const std::string& name) {
  const testing::TestResult& result = *testing::UnitTest::GetInstance()->current_test_info()->result();
  json properties;
  for (int i = 0; i < result.test_property_count(); ++i)
    properties[result.GetTestProperty(i).key()] = result.GetTestProperty(i).value();
  return reportOf(name, properties);
}

TEST(HardReport, Hard13IsReadAsItWasWritten) {
  {
    HardCase error("glass, 50 % \"tilted\"", "m"), count = HardCase::counting("Rays that leak", "rays");
    EXPECT_TRUE(error.within(0.25, 0.5));
    EXPECT_TRUE(error.within(-3, 1e-9));
    EXPECT_TRUE(count.within(0, 0));
  }
  std::vector<ClauseResult> read = parseTestReport(recorded("Hard13X"), "here");
  ASSERT_EQ(read.size(), 2u);
  if (read[0].count) std::swap(read[0], read[1]);
  EXPECT_EQ(read[0].number, 13);
  EXPECT_EQ(read[0].clause, "glass, 50 % \"tilted\"");
  EXPECT_EQ(read[0].slug(), "glass-50-tilted");
  EXPECT_EQ(read[0].test, "Suite.Hard13X");
  EXPECT_EQ(read[0].achieved, 0.25);
  EXPECT_EQ(read[0].allowed, 0.5);
  EXPECT_EQ(read[0].unit, "m");
  EXPECT_EQ(read[0].checks, 2);
  EXPECT_FALSE(read[0].count);
  EXPECT_FALSE(read[0].failed);
  EXPECT_TRUE(read[1].count);
}

/// What a clause reports once these pairs of achieved and allowed were held against each other.
ClauseResult worstOf(const std::string& clause, const std::vector<std::pair<double, double>>& checks) {
  {
    HardCase c(clause);
    for (const auto& [achieved, allowed] : checks)
      EXPECT_EQ(static_cast<bool>(c.within(achieved, allowed)), achieved <= allowed);
  }
  for (const ClauseResult& c : parseTestReport(recorded("Hard1X"), "here"))
    if (c.clause == clause) return c;
  throw core::Error(clause + " was not recorded");
}

TEST(HardReport, Hard1TheWorstIsWhatUsesMostOfItsAllowance) {
  EXPECT_EQ(worstOf("a", {{1, 10}, {1, 2}, {1, 5}}).allowed, 2);
  EXPECT_EQ(worstOf("b", {{-1, 0}, {0, 0}, {-3, 0}}).achieved, 0);
  EXPECT_EQ(worstOf("c", {{9, 9.5}, {1e-9, 0}, {1, 5}}).achieved, 1e-9)
      << "a failure, however small, is the worst";
  EXPECT_TRUE(std::isnan(worstOf("d", {{3, 2}, {NAN, 1}, {9, 1}}).achieved));
  EXPECT_EQ(worstOf("e", {{1, 2}, {1, 2}}).checks, 2);
}

TEST(HardReport, AFailedTestMarksItsClausesOrStandsForItself) {
  const json properties = {
      {"hard_case_a",
       R"({"number":3,"clause":"a","achieved":null,"allowed":0,"unit":"","kind":"error","checks":1})"},
      {"other", "1"}};
  const auto marked = parseTestReport(reportOf("Hard3X", properties, true), "here");
  ASSERT_EQ(marked.size(), 1u);
  EXPECT_TRUE(marked[0].failed);
  EXPECT_TRUE(std::isnan(marked[0].achieved));
  const auto silent = parseTestReport(reportOf("Hard21Crashes", json::object(), true), "here");
  ASSERT_EQ(silent.size(), 1u);
  EXPECT_TRUE(silent[0].failed);
  EXPECT_EQ(silent[0].number, 21);
  EXPECT_EQ(silent[0].test, "Suite.Hard21Crashes");
  EXPECT_TRUE(parseTestReport(reportOf("Hard21Skipped", json::object()), "here").empty());
}

TEST(HardReport, OtherFilesAreRefusedByName) {
  for (const std::string& text :
       {std::string("no"), std::string("{}"), reportOf("Hard1", {{"hard_case_x", "no"}}),
        reportOf("Hard1", {{"hard_case_x", "{}"}})}) {
    try {
      parseTestReport(text, "that.json");
      ADD_FAILURE() << text;
    } catch (const core::Error& e) {
      EXPECT_NE(std::string(e.what()).find("that.json"), std::string::npos) << e.what();
    }
  }
}

TEST(HardReport, EqualClausesBecomeTheWorst) {
  const auto clause = [](int number, const char* text, double achieved, double allowed, bool failed) {
    ClauseResult c;
    c.number = number;
    c.clause = text;
    c.achieved = achieved;
    c.allowed = allowed;
    c.checks = 2;
    c.failed = failed;
    return c;
  };
  const auto merged =
      mergeClauses({clause(1, "x", 1, 4, false), clause(2, "x", 0, 0, false), clause(1, "X", 1, 2, false),
                    clause(1, "x", 3, 100, false), clause(2, "x", -1, 0, true)});
  ASSERT_EQ(merged.size(), 2u);
  EXPECT_EQ(merged[0].allowed, 2);
  EXPECT_EQ(merged[0].checks, 6);
  EXPECT_TRUE(merged[1].failed);
}

TEST(HardCases, AreTwentyEightInOrder) {
  ASSERT_EQ(hardCaseTitles().size(), 28u);
  for (int i = 0; i < 28; ++i) EXPECT_EQ(hardCaseTitles()[static_cast<std::size_t>(i)].number, i + 1);
}

TEST(RunToEnd, GivesOutputAndStatus) {
  const Outcome good = runToEnd("it", {"sh", "-c", "echo one; exit 3"}, {});
  EXPECT_EQ(good.status, 3);
  EXPECT_EQ(good.output, "one\n");
  EXPECT_EQ(runToEnd("it", {"sh", "-c", "kill -9 $$"}, {}).status, 137);
  EXPECT_THROW(runToEnd("it", {"/nowhere/at/all"}, {}), core::Error);
}

}  // namespace
}  // namespace saccade::bench
