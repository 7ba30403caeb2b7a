// Records survive the way through their file, and what is not one of ours is refused.
#include "bench/harness/record.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/harness/runner.h"
#include "core/error.h"

namespace saccade::bench {
namespace {

RunInfo someRun(const std::string& commit) {
  RunInfo run;
  run.commit = commit;
  run.command = "saccade bench quick -o out";
  run.started = "2026-01-02T03:04:05Z";
  run.cpu = "a \"quoted\" processor";
  run.cores = 2;
  run.memoryBytes = std::uint64_t{1} << 40;
  run.software = {{"embree", "3.13.5"}};
  run.otherLoad = 0.1;
  run.finished = {"still"};
  return run;
}

Record someRecord(const std::string& key, std::size_t run) {
  Record r;
  r.key = key;
  r.experiment = key.substr(0, key.find('/'));
  r.run = run;
  r.labels = {{"scene", "cornell, the box"}};
  r.at = {{"budget_ms", 1.0 / 3}};
  r.values = {{"frame", Value::milliseconds({3, 1.1, 2})}, {"relmse", Value::error(1e-17)}};
  r.files = {{"picture", "pictures/x.png"}};
  r.loaded = true;
  return r;
}

TEST(Records, SurviveTheFileExactly) {
  const RecordBook book{{someRun("abc")}, {someRecord("still/a", 0), someRecord("still/b", 0)}};
  const std::string json = toJson(book);
  const RecordBook back = parseRecordBook(json, "test");
  EXPECT_EQ(toJson(back), json);
  ASSERT_EQ(back.records.size(), 2u);
  EXPECT_EQ(back.records[0].at.at("budget_ms"), 1.0 / 3);
  EXPECT_EQ(back.records[0].values.at("relmse").median, 1e-17);
  EXPECT_EQ(back.runs[0].memoryBytes, std::uint64_t{1} << 40);
  EXPECT_NE(back.find("still/b"), nullptr);
  EXPECT_EQ(back.find("still/c"), nullptr);
}

TEST(Records, MedianAndRangeOfRepeats) {
  const Value v = Value::milliseconds({3, 1.1, 2});
  EXPECT_EQ(v.median, 2);
  EXPECT_EQ(v.min, 1.1);
  EXPECT_EQ(v.max, 3);
  EXPECT_EQ(v.repeats, 3);
  EXPECT_EQ(Value::rate({4, 1}).median, 1);  // the lower of two
}

TEST(Records, WhatIsNotFiniteIsNull) {
  RecordBook book{{someRun("abc")}, {someRecord("still/a", 0)}};
  book.records[0].values = {{"psnr", Value::error(std::numeric_limits<double>::infinity())}};
  const RecordBook back = parseRecordBook(toJson(book), "test");
  EXPECT_TRUE(std::isnan(back.records[0].values.at("psnr").median));
}

TEST(Records, CsvHasALineAValueAndQuotesCommas) {
  const RecordBook book{{someRun("abc")}, {someRecord("still/a", 0)}};
  const std::string csv = toCsv(book);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  EXPECT_NE(csv.find("\"scene=cornell, the box\""), std::string::npos);
}

TEST(Records, RefusesWhatIsNoRecordFile) {
  EXPECT_THROW(parseRecordBook("", "f"), core::Error);
  EXPECT_THROW(parseRecordBook("[1]", "f"), core::Error);
  EXPECT_THROW(parseRecordBook(R"({"schema": 2, "runs": [], "records": []})", "f"), core::Error);
  RecordBook book{{someRun("abc")}, {someRecord("still/a", 7)}};
  EXPECT_THROW(parseRecordBook(toJson(book), "f"), core::Error) << "names a run that is not there";
}

TEST(Records, ARunGoesOnOnlyFromItsOwnCommitAndCommand) {
  RunInfo stopped = someRun("abc");
  RecordBook before{{someRun("old"), stopped},
                    {someRecord("still/a", 0), someRecord("still/b", 1), someRecord("moving/a", 1)}};
  const RecordBook kept = keptRecords(before, someRun("abc"));
  ASSERT_EQ(kept.records.size(), 1u) << "moving was not finished, still/a is of another commit";
  EXPECT_EQ(kept.records[0].key, "still/b");
  EXPECT_EQ(kept.records[0].run, 0u);

  RunInfo dirty = someRun("abc");
  dirty.dirty = true;
  EXPECT_TRUE(keptRecords(before, dirty).records.empty());
  RunInfo other = someRun("abc");
  other.command = "saccade bench paper -o out";
  EXPECT_TRUE(keptRecords(before, other).records.empty());
}

}  // namespace
}  // namespace saccade::bench
