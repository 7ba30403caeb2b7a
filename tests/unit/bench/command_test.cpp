// `saccade bench` as its user meets it: what it writes, what it refuses.
#include <gtest/gtest.h>

#include "bench/harness/experiment.h"
#include "bench/harness/record.h"
#include "core/error.h"
#include "tests/command_line.h"

namespace saccade::bench {
namespace {

using tests::saccade;

TEST(BenchCommand, WritesRecordsAndAPageThatOpensFromDisk) {
  const std::filesystem::path folder = tests::temporaryFolder() / "bench out";
  const tests::Ran ran = saccade("bench quick --experiment many-lights -o '" + folder.string() + "'");
  ASSERT_EQ(ran.status, 0) << ran.err;
  const RecordBook book = parseRecordBook(tests::slurp(folder / "records.json"), "records.json");
  ASSERT_EQ(book.runs.size(), 1u);
  EXPECT_EQ(book.runs[0].finished, std::vector<std::string>{"many-lights"});
  EXPECT_NE(book.runs[0].command.find("bench quick"), std::string::npos);
  EXPECT_FALSE(book.records.empty());
  for (const Record& record : book.records) {
    EXPECT_EQ(record.experiment, "many-lights");
    EXPECT_EQ(record.key.rfind("many-lights/", 0), 0u) << record.key;
  }
  EXPECT_EQ(tests::slurp(folder / "records.csv").rfind("key,", 0), 0u);
  EXPECT_NE(tests::slurp(folder / "index.html").find("many-lights"), std::string::npos);
}

TEST(BenchCommand, RefusesWhatItDoesNotKnow) {
  const std::string folder = " -o '" + (tests::temporaryFolder() / "refused").string() + "'";
  for (const char* arguments : {"bench", "bench quik", "bench quick", "bench quick --experiment nothing",
                                "bench quick --method guess", "bench quick --baseline /nowhere.json"}) {
    const bool whole = std::string(arguments).find("--") != std::string::npos;
    const tests::Ran ran = saccade(arguments + (whole ? folder : ""));
    EXPECT_EQ(ran.status, 2) << arguments;
    EXPECT_EQ(tests::errorLines(ran.err), 1) << ran.err;
  }
  EXPECT_FALSE(std::filesystem::exists(tests::temporaryFolder() / "refused"));
}

TEST(BenchCommand, HelpNamesEveryExperiment) {
  const tests::Ran ran = saccade("bench --help");
  EXPECT_EQ(ran.status, 0);
  for (const Experiment& e : allExperiments())
    EXPECT_NE(ran.out.find(e.question), std::string::npos) << e.name;
}

TEST(BenchCommand, FullRunsEveryExperimentAndOthersTheirOwn) {
  BenchOptions options;
  options.suite = Suite::full;
  EXPECT_EQ(chosenExperiments(options).size(), allExperiments().size());
  options.suite = Suite::quick;
  const std::size_t quick = chosenExperiments(options).size();
  EXPECT_GT(quick, 0u);
  EXPECT_LT(quick, allExperiments().size());
  options.only = {allExperiments().front().name};
  EXPECT_EQ(chosenExperiments(options).size(), 1u);
  options.only = {"nothing"};
  EXPECT_THROW(chosenExperiments(options), core::UsageError);
}

}  // namespace
}  // namespace saccade::bench
