// What GoogleTest's JSON says of the hard cases (tests/hard_case.h writes it).
#pragma once

#include <string>
#include <vector>

namespace saccade::bench {

/// One clause of a hard case as a test reports it.
struct ClauseResult {
  int number = 0;  ///< 1 to 28
  std::string clause;
  std::string test;                  ///< for --gtest_filter: Suite.Name
  double achieved = 0, allowed = 0;  ///< NaN where the test gave no number
  std::string unit;
  bool count = false;  ///< deterministic
  int checks = 0;      ///< how many values were held against what is allowed
  bool failed = false;

  /// Lower case, joined by dashes: the last part of a record's key.
  std::string slug() const;
};

/// The clauses of one --gtest_output=json file, in its order. A test that failed marks all its clauses, and
/// stands for itself (no numbers, its name as the clause) when it reported none. Throws core::Error naming
/// `source` for anything that is not such a file.
std::vector<ClauseResult> parseTestReport(const std::string& json, const std::string& source);

/// Equal clauses of one number (of tests with parameters) become one: the worst, with all checks.
std::vector<ClauseResult> mergeClauses(const std::vector<ClauseResult>& all);

}  // namespace saccade::bench
