#include "bench/hard/test_report.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.h"

namespace saccade::bench {
namespace {

using nlohmann::json;

constexpr const char* kProperty = "hard_case_";

double numberOf(const json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

ClauseResult clauseOf(const json& property, const std::string& test, bool failed) {
  const json c = json::parse(property.get<std::string>());
  ClauseResult result;
  result.number = c.at("number");
  result.clause = c.at("clause");
  result.test = test;
  result.achieved = numberOf(c.at("achieved"));
  result.allowed = numberOf(c.at("allowed"));
  result.unit = c.at("unit");
  result.count = c.at("kind") == "count";
  result.checks = c.at("checks");
  result.failed = failed;
  return result;
}

/// Of "Hard<number>..." in a test's name; 0 for another.
int numberIn(const std::string& name) {
  int number = 0;
  const std::size_t at = name.find("Hard");
  if (at != name.npos) std::from_chars(name.data() + at + 4, name.data() + name.size(), number);
  return number;
}

void appendTest(const json& test, std::vector<ClauseResult>& out) {
  const std::string name = test.at("name");
  const std::string fullName = test.at("classname").get<std::string>() + "." + name;
  const bool failed = test.contains("failures");
  const std::size_t before = out.size();
  for (const auto& [key, value] : test.items())
    if (key.starts_with(kProperty)) out.push_back(clauseOf(value, fullName, failed));
  if (!failed || out.size() > before) return;
  ClauseResult silent;
  silent.number = numberIn(name);
  silent.clause = name;
  silent.test = fullName;
  silent.achieved = silent.allowed = std::numeric_limits<double>::quiet_NaN();
  silent.failed = true;
  out.push_back(silent);
}

/// How close to what is allowed, or beyond it.
bool worse(const ClauseResult& a, const ClauseResult& b) {
  if (a.failed != b.failed) return a.failed;
  const auto use = [](const ClauseResult& c) {
    return c.allowed > 0 ? c.achieved / c.allowed : c.achieved - c.allowed;
  };
  return use(a) > use(b);
}

}  // namespace

std::string ClauseResult::slug() const {
  std::string s;
  for (const char letter : clause) {
    const auto c = static_cast<unsigned char>(letter);
    if (std::isalnum(c)) {
      s += static_cast<char>(std::tolower(c));
    } else if (!s.empty() && s.back() != '-') {
      s += '-';
    }
  }
  while (!s.empty() && s.back() == '-') s.pop_back();
  return s;
}

std::vector<ClauseResult> parseTestReport(const std::string& text, const std::string& source) {
  std::vector<ClauseResult> out;
  try {
    const json report = json::parse(text);
    for (const json& suite : report.at("testsuites"))
      for (const json& test : suite.at("testsuite")) appendTest(test, out);
  } catch (const json::exception& e) {
    throw core::Error(source + ": is no report of a test program: " + e.what());
  }
  return out;
}

std::vector<ClauseResult> mergeClauses(const std::vector<ClauseResult>& all) {
  std::vector<ClauseResult> merged;
  for (const ClauseResult& c : all) {
    const auto same = std::find_if(merged.begin(), merged.end(), [&](const ClauseResult& m) {
      return m.number == c.number && m.slug() == c.slug();
    });
    if (same == merged.end()) {
      merged.push_back(c);
      continue;
    }
    const int checks = same->checks + c.checks;
    if (worse(c, *same)) *same = c;
    same->checks = checks;
  }
  return merged;
}

}  // namespace saccade::bench
