// How a test reports what it achieved on one of the numerical hard cases, for `saccade bench hard`.
//
// The test's own name says which case it is: Hard<number>, for example TEST(Bsdf,
// Hard10MetalAlbedoEqualsTheTable). So --gtest_filter='*Hard10*' repeats it, and nothing that reports is left
// out of the measurement.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace saccade::tests {

/// One clause of a hard case: the worst of all that the test checks against it, a property of the running
/// test when it goes out of scope.
///   HardCase furnace("white furnace of metal");
///   EXPECT_TRUE(furnace.within(e.mean - 1, 3 * e.sigma)) << roughness;
class HardCase {
 public:
  enum class Kind {
    error,  ///< a number that may differ from one processor to another
    count   ///< of things that went wrong: the same on every run
  };

  /// `clause`: unique within its number, plain ASCII. `unit`: what `achieved` counts or measures, or empty.
  explicit HardCase(std::string_view clause, std::string_view unit = "", Kind kind = Kind::error)
      : clause_(clause), unit_(unit), kind_(kind) {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    const std::string_view name = test->name();
    const std::size_t at = name.find("Hard");
    if (at != name.npos) std::from_chars(name.data() + at + 4, name.data() + name.size(), number_);
    if (number_ < 1 || number_ > 28) ADD_FAILURE() << test->name() << " must be named Hard<1..28>";
  }
  static HardCase counting(std::string_view clause, std::string_view unit) {
    return HardCase(clause, unit, Kind::count);
  }
  ~HardCase() { testing::Test::RecordProperty("hard_case_" + slug(), json()); }
  HardCase(const HardCase&) = delete;
  HardCase& operator=(const HardCase&) = delete;

  /// Whether `achieved` <= `allowed` (false for NaN): an error's size, with its sign where only one side is
  /// wrong.
  [[nodiscard]] testing::AssertionResult within(double achieved, double allowed) {
    ++checks_;
    const bool good = achieved <= allowed;
    // The worst is what fails; else the smallest distance to what is allowed, in units of it.
    const double use = allowed > 0 ? achieved / allowed : achieved - allowed;
    if (checks_ == 1 || !good || use > worstUse_) {
      if (!failed_ || !good) achieved_ = achieved, allowed_ = allowed, worstUse_ = use;
    }
    failed_ |= !good;
    if (good) return testing::AssertionSuccess();
    return testing::AssertionFailure()
           << clause_ << ": " << achieved << ' ' << unit_ << ", allowed " << allowed;
  }
  /// |value - truth| against `allowed`.
  [[nodiscard]] testing::AssertionResult near(double value, double truth, double allowed) {
    return within(std::fabs(value - truth), allowed);
  }

  /// Lower case, words joined by dashes.
  std::string slug() const {
    std::string s;
    for (const char c : clause_) {
      const bool letter = std::isalnum(static_cast<unsigned char>(c)) != 0;
      if (letter) s += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      if (!letter && !s.empty() && s.back() != '-') s += '-';
    }
    while (!s.empty() && s.back() == '-') s.pop_back();
    return s;
  }

 private:
  static std::string number(double x) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, x).ptr;
    return std::isfinite(x) ? std::string(text, end) : "null";
  }
  std::string json() const {
    return "{\"number\":" + std::to_string(number_) + ",\"clause\":\"" + clause_ +
           "\",\"achieved\":" + number(achieved_) + ",\"allowed\":" + number(allowed_) + ",\"unit\":\"" +
           unit_ + "\",\"kind\":\"" + (kind_ == Kind::count ? "count" : "error") +
           "\",\"checks\":" + std::to_string(checks_) + "}";
  }

  std::string clause_, unit_;
  Kind kind_;
  int number_ = 0, checks_ = 0;
  bool failed_ = false;
  double achieved_ = NAN, allowed_ = 0, worstUse_ = 0;
};

/// How many entries are not equal (NaN never is); all where the sizes differ.
template <class T>
double differing(const std::vector<T>& a, const std::vector<T>& b) {
  if (a.size() != b.size()) return static_cast<double>(std::max(a.size(), b.size()));
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += !(a[i] == b[i]);
  return static_cast<double>(count);
}

}  // namespace saccade::tests
