#include "bench/harness/baseline.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

namespace saccade::bench {
namespace {

bool finite(const Value& v) {
  return std::isfinite(v.median) && std::isfinite(v.min) && std::isfinite(v.max);
}

bool ratioMoved(const Value& before, const Value& now) {
  const bool apart = now.min > before.max || now.max < before.min;
  return apart && std::abs(now.median - before.median) > kNoiseFloor * std::abs(before.median);
}

bool moved(const Value& before, const Value& now) {
  if (!finite(before) || !finite(now)) return finite(before) != finite(now);
  return now.kind == Kind::ratio ? ratioMoved(before, now) : now.median != before.median;
}

Verdict verdictOn(const Value& before, const Value& now) {
  if (!finite(now)) return Verdict::worse;
  if (!finite(before)) return Verdict::better;
  if (now.better == Better::neither) return Verdict::changed;
  return (now.median > before.median) == (now.better == Better::higher) ? Verdict::better : Verdict::worse;
}

std::set<std::string> experimentsOf(const RecordBook& book) {
  std::set<std::string> names;
  for (const Record& record : book.records) names.insert(record.experiment);
  return names;
}

/// What `book` holds and `other` does not.
std::vector<std::string> onlyIn(const RecordBook& book, const RecordBook& other) {
  const std::set<std::string> known = experimentsOf(other);
  std::vector<std::string> only;
  for (const std::string& name : experimentsOf(book)) {
    if (known.count(name) == 0) only.push_back("every record of " + name);
  }
  for (const Record& record : book.records) {
    if (known.count(record.experiment) == 0) continue;
    const Record* same = other.find(record.key);
    if (!same) only.push_back(record.key);
    for (const auto& [metric, value] : record.values) {
      if (same && same->values.count(metric) == 0) only.push_back(record.key + ":" + metric);
    }
  }
  return only;
}

/// Adds to the report what the values of two records of one key say.
void compareRecords(const Record& before, const Record& now, bool sameSeed, BaselineReport& report) {
  for (const auto& [metric, value] : now.values) {
    const auto earlier = before.values.find(metric);
    if (earlier == before.values.end() || earlier->second.kind != value.kind) continue;
    if (value.kind != Kind::ratio && value.kind != Kind::count) continue;
    if (value.kind == Kind::count && !sameSeed) {
      ++report.otherSeeds;
      continue;
    }
    ++(value.kind == Kind::ratio ? report.ratios : report.counts);
    if (!moved(earlier->second, value)) continue;
    report.changes.push_back({now.key, metric, earlier->second, value, verdictOn(earlier->second, value),
                              before.loaded || now.loaded});
  }
}

const char* nameOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::worse:
      return "worse";
    case Verdict::better:
      return "better";
    default:
      return "changed";
  }
}

/// Counts in full, ratios with their range.
std::string written(const Value& v) {
  char text[96];
  if (v.kind == Kind::count) {
    std::snprintf(text, sizeof text, "%.17g", v.median);
  } else {
    std::snprintf(text, sizeof text, "%.3g [%.3g, %.3g]", v.median, v.min, v.max);
  }
  return text;
}

std::string lineOf(const Change& c) {
  std::string line = std::string(nameOf(c.verdict)) + ": " + c.key + ":" + c.metric + " " +
                     written(c.before) + " -> " + written(c.now);
  const double percent = 100 * (c.now.median - c.before.median) / std::abs(c.before.median);
  if (std::isfinite(percent)) {
    char text[32];
    std::snprintf(text, sizeof text, " (%+.3g %%)", percent);
    line += text;
  }
  if (c.loaded) line += ", on a loaded machine";
  return line + "\n";
}

}  // namespace

std::size_t BaselineReport::howMany(Verdict verdict) const {
  return static_cast<std::size_t>(
      std::count_if(changes.begin(), changes.end(), [&](const Change& c) { return c.verdict == verdict; }));
}

BaselineReport compareToBaseline(const RecordBook& before, const RecordBook& now) {
  BaselineReport report;
  for (const Record& record : now.records) {
    const Record* earlier = before.find(record.key);
    if (!earlier) continue;
    compareRecords(*earlier, record, before.runs[earlier->run].seed == now.runs[record.run].seed, report);
  }
  std::stable_sort(report.changes.begin(), report.changes.end(), [](const Change& a, const Change& b) {
    return a.verdict == Verdict::worse && b.verdict != Verdict::worse;
  });
  report.onlyBefore = onlyIn(before, now);
  report.onlyNow = onlyIn(now, before);
  return report;
}

std::string toText(const BaselineReport& r) {
  std::string text;
  for (const Change& change : r.changes) text += lineOf(change);
  for (const std::string& name : r.onlyBefore) text += "only in the baseline: " + name + "\n";
  for (const std::string& name : r.onlyNow) text += "only in this run: " + name + "\n";
  text += std::to_string(r.ratios) + " ratios and " + std::to_string(r.counts) + " counts compared: ";
  for (const Verdict v : {Verdict::worse, Verdict::better, Verdict::changed})
    text += std::to_string(r.howMany(v)) + " " + nameOf(v) + (v == Verdict::changed ? "" : ", ");
  if (r.otherSeeds > 0) text += "; " + std::to_string(r.otherSeeds) + " counts of another seed left out";
  return text + "\n";
}

}  // namespace saccade::bench
