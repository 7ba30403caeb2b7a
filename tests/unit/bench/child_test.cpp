// What processes of their own report.
#include "bench/harness/child.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "core/error.h"

namespace saccade::bench {
namespace {

TEST(Child, FiguresSurviveTheWayThroughJson) {
  const Figures figures = {{"seconds", 0.1}, {"bytes", 1.5e11}, {"nothing", 0}};
  EXPECT_EQ(parseFigures(toJson(figures)), figures);
}

TEST(Child, OtherOutputIsAnError) {
  for (const char* text : {"", "seconds 1", "[1]", "{\"seconds\": \"1\"}"})
    EXPECT_THROW(parseFigures(text), core::Error) << text;
}

TEST(Child, JobsHaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const ChildJob& job : allChildJobs()) EXPECT_TRUE(names.insert(job.name).second) << job.name;
  EXPECT_FALSE(names.empty());
}

TEST(Child, TheProgramRefusesAnUnknownJob) {
  EXPECT_NE(std::system(SACCADE_BINARY " bench-child nothing 2> /dev/null"), 0);
}

}  // namespace
}  // namespace saccade::bench
