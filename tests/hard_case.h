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
#include <utility>
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

  /// `clause`: unique within its number, ASCII. `unit`: what `achieved` counts or measures, or empty.
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
  ~HardCase() { testing::Test::RecordProperty("hard_case_" + std::to_string(reported_++), json()); }
  HardCase(const HardCase&) = delete;
  HardCase& operator=(const HardCase&) = delete;

  /// Whether `achieved` <= `allowed` (false for NaN): an error's size, with its sign where only one side is
  /// wrong.
  [[nodiscard]] testing::AssertionResult within(double achieved, double allowed) {
    const bool good = achieved <= allowed;
    // How much of what is allowed is used; beside a failure nothing else is the worst, and NaN is worse than
    // any.
    const double share = allowed > 0 ? achieved / allowed : achieved - allowed;
    const std::pair use(!good, std::isnan(share) ? INFINITY : share);
    if (checks_++ == 0 || use > worst_) achieved_ = achieved, allowed_ = allowed, worst_ = use;
    if (good) return testing::AssertionSuccess();
    return testing::AssertionFailure()
           << clause_ << ": " << achieved << ' ' << unit_ << ", allowed " << allowed;
  }
  /// |value - truth| against `allowed`.
  [[nodiscard]] testing::AssertionResult near(double value, double truth, double allowed) {
    return within(std::fabs(value - truth), allowed);
  }

 private:
  static std::string number(double x) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, x).ptr;
    return std::isfinite(x) ? std::string(text, end) : "null";
  }
  static std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
      if (c == '"' || c == '\\') out += '\\';
      out += c;
    }
    return out;
  }
  std::string json() const {
    return "{\"number\":" + std::to_string(number_) + ",\"clause\":\"" + escaped(clause_) +
           "\",\"achieved\":" + number(achieved_) + ",\"allowed\":" + number(allowed_) + ",\"unit\":\"" +
           unit_ + "\",\"kind\":\"" + (kind_ == Kind::count ? "count" : "error") +
           "\",\"checks\":" + std::to_string(checks_) + "}";
  }

  static inline int reported_ = 0;  ///< properties of one test have names of their own
  std::string clause_, unit_;
  Kind kind_;
  int number_ = 0, checks_ = 0;
  std::pair<bool, double> worst_;  ///< failed, share of what is allowed
  double achieved_ = NAN, allowed_ = 0;
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
