// The regression guard on books made by hand.
#include "bench/harness/baseline.h"

#include <gtest/gtest.h>

#include <limits>

namespace saccade::bench {
namespace {

using Values = std::map<std::string, Value>;

RecordBook bookOf(const std::vector<std::pair<std::string, Values>>& records, std::uint32_t seed = 1) {
  RecordBook book;
  book.runs.emplace_back();
  book.runs[0].seed = seed;
  for (const auto& [key, values] : records) {
    Record record;
    record.key = key;
    record.experiment = key.substr(0, key.find('/'));
    record.values = values;
    book.records.push_back(record);
  }
  return book;
}

Value ratio(double median, double min, double max, Better better = Better::higher) {
  Value v = Value::ratio({median}, better);
  v.min = min;
  v.max = max;
  v.repeats = 5;
  return v;
}

BaselineReport between(const Value& before, const Value& now) {
  return compareToBaseline(bookOf({{"rays/a", {{"m", before}}}}), bookOf({{"rays/a", {{"m", now}}}}));
}

void expectOnly(const BaselineReport& report, Verdict verdict) {
  ASSERT_EQ(report.changes.size(), 1u) << toText(report);
  EXPECT_EQ(report.changes[0].verdict, verdict) << toText(report);
  EXPECT_EQ(report.changes[0].key, "rays/a");
  EXPECT_EQ(report.changes[0].metric, "m");
}

TEST(Baseline, EqualBooksHaveNothingToSay) {
  const RecordBook book = bookOf({{"rays/a", {{"m", ratio(0.7, 0.6, 0.8)}, {"n", Value::count(3)}}}});
  const BaselineReport report = compareToBaseline(book, book);
  EXPECT_TRUE(report.changes.empty() && report.onlyBefore.empty() && report.onlyNow.empty());
  EXPECT_EQ(report.ratios, 1u);
  EXPECT_EQ(report.counts, 1u);
  EXPECT_EQ(toText(report), "1 ratios and 1 counts compared: 0 worse, 0 better, 0 changed\n");
}

TEST(Baseline, ARatioBeyondItsNoiseIsJudgedByItsDirection) {
  const Value high = ratio(0.7, 0.69, 0.71), low = ratio(0.6, 0.59, 0.61);
  expectOnly(between(high, low), Verdict::worse);
  expectOnly(between(low, high), Verdict::better);
  const auto turned = [](Value v, Better better) {
    v.better = better;
    return v;
  };
  expectOnly(between(turned(high, Better::lower), turned(low, Better::lower)), Verdict::better);
  expectOnly(between(turned(low, Better::lower), turned(high, Better::lower)), Verdict::worse);
  expectOnly(between(turned(low, Better::neither), turned(high, Better::neither)), Verdict::changed);
}

TEST(Baseline, ARatioWithinItsNoiseIsNot) {
  // The ranges touch, whichever run is the noisy one.
  EXPECT_TRUE(between(ratio(1, 0.99, 1.2), ratio(1.3, 1.2, 1.4)).changes.empty());
  EXPECT_TRUE(between(ratio(1, 0.99, 1.01), ratio(1.3, 1.01, 1.4)).changes.empty());
  EXPECT_EQ(between(ratio(1, 0.99, 1.01), ratio(1.3, 1.02, 1.4)).changes.size(), 1u);
  // The ranges are apart, the medians too close.
  EXPECT_TRUE(between(ratio(1, 1, 1), ratio(1 + 0.99 * kNoiseFloor, 1.02, 1.04)).changes.empty());
  EXPECT_EQ(between(ratio(1, 1, 1), ratio(1 + 1.01 * kNoiseFloor, 1.02, 1.04)).changes.size(), 1u);
}

TEST(Baseline, ACountIsSaidWhenItChangesAtAll) {
  expectOnly(between(Value::count(1000000), Value::count(1000001)), Verdict::changed);
  expectOnly(between(Value::count(100, Better::lower), Value::count(101, Better::lower)), Verdict::worse);
  expectOnly(between(Value::count(100, Better::lower), Value::count(99, Better::lower)), Verdict::better);
}

TEST(Baseline, CountsOfAnotherSeedAreNotCompared) {
  const BaselineReport report = compareToBaseline(bookOf({{"rays/a", {{"m", Value::count(1)}}}}, 1),
                                                  bookOf({{"rays/a", {{"m", Value::count(2)}}}}, 2));
  EXPECT_TRUE(report.changes.empty());
  EXPECT_EQ(report.counts, 0u);
  EXPECT_EQ(report.otherSeeds, 1u);
  EXPECT_NE(toText(report).find("another seed"), std::string::npos);
}

TEST(Baseline, WhatBelongsToAMachineIsNotJudged) {
  const Values before{{"a", Value::milliseconds({1})},
                      {"b", Value::rate({100})},
                      {"c", Value::bytes(10)},
                      {"d", Value::error(0.1)},
                      {"e", Value::seconds({1})}};
  const Values now{{"a", Value::milliseconds({100})},
                   {"b", Value::rate({1})},
                   {"c", Value::bytes(1000)},
                   {"d", Value::error(1)},
                   {"e", Value::seconds({9})}};
  const BaselineReport report = compareToBaseline(bookOf({{"rays/a", before}}), bookOf({{"rays/a", now}}));
  EXPECT_TRUE(report.changes.empty()) << toText(report);
}

TEST(Baseline, AFigureThatStoppedBeingANumberIsWorse) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Value gone = ratio(nan, nan, nan), there = ratio(1, 1, 1);
  expectOnly(between(there, gone), Verdict::worse);
  expectOnly(between(gone, there), Verdict::better);
  EXPECT_TRUE(between(gone, gone).changes.empty());
}

TEST(Baseline, MissingRecordsAreListed) {
  const Values one{{"m", ratio(1, 1, 1)}}, two{{"m", ratio(1, 1, 1)}, {"n", Value::count(1)}};
  const RecordBook before = bookOf({{"rays/a", two}, {"rays/b", one}, {"peers/x", one}, {"peers/y", one}});
  const RecordBook now = bookOf({{"rays/a", one}, {"rays/c", one}});
  const BaselineReport report = compareToBaseline(before, now);
  EXPECT_EQ(report.onlyBefore, (std::vector<std::string>{"every record of peers", "rays/a:n", "rays/b"}));
  EXPECT_EQ(report.onlyNow, std::vector<std::string>{"rays/c"});
  EXPECT_EQ(report.howMany(Verdict::worse), 0u) << "missing is not worse";
}

TEST(Baseline, LoadedRecordsAreJudgedAndMarked) {
  RecordBook before = bookOf({{"rays/a", {{"m", ratio(1, 1, 1)}}}});
  const RecordBook now = bookOf({{"rays/a", {{"m", ratio(0.5, 0.5, 0.5)}}}});
  before.records[0].loaded = true;
  const BaselineReport report = compareToBaseline(before, now);
  expectOnly(report, Verdict::worse);
  EXPECT_EQ(toText(report),
            "worse: rays/a:m 1 [1, 1] -> 0.5 [0.5, 0.5] (-50 %), on a loaded machine\n"
            "1 ratios and 0 counts compared: 1 worse, 0 better, 0 changed\n");
}

TEST(Baseline, WhatGotWorseComesFirst) {
  const RecordBook before = bookOf({{"r/a", {{"m", Value::count(1)}}},
                                    {"r/b", {{"m", ratio(1, 1, 1)}}},
                                    {"r/c", {{"m", ratio(1, 1, 1)}}}});
  const RecordBook now = bookOf({{"r/a", {{"m", Value::count(2)}}},
                                 {"r/b", {{"m", ratio(2, 2, 2)}}},
                                 {"r/c", {{"m", ratio(0.5, 0.5, 0.5)}}}});
  const std::vector<Change> changes = compareToBaseline(before, now).changes;
  ASSERT_EQ(changes.size(), 3u);
  EXPECT_EQ(changes[0].key, "r/c");
  EXPECT_EQ(changes[1].key, "r/a");
  EXPECT_EQ(changes[2].key, "r/b");
}

}  // namespace
}  // namespace saccade::bench
