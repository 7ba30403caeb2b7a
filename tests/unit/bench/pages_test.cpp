// The pages that Python makes of records: its own tests, run here so that the suite counts them, and
// docs/results.md against the records.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace saccade {
namespace {

/// Runs Debian's own Python (its packages are not those of another one on the PATH) in the source folder; the
/// output goes to `out`, the exit status is returned.
int python(const std::string& arguments, std::string& out) {
  const std::string command = "cd '" SACCADE_SOURCE_DIR "' && /usr/bin/python3 -B " + arguments + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    out.append(buffer.data(), n);
  const int status = pclose(pipe);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(Pages, ReportOfAMeasurement) {
  std::string out;
  EXPECT_EQ(python("-m unittest tests/report/test_report.py", out), 0) << out;
  EXPECT_NE(out.find("\nRan "), std::string::npos) << out;
}

TEST(Pages, ResultsPageAndItsCheck) {
  std::string out;
  EXPECT_EQ(python("-m unittest tests/report/test_results.py", out), 0) << out;
  EXPECT_NE(out.find("\nRan "), std::string::npos) << out;
}

TEST(Pages, ResultsAreWhatTheCommittedRecordsGive) {
  std::string out;
  EXPECT_EQ(python("bench/report/results.py --check", out), 0) << out;
}

}  // namespace
}  // namespace saccade
