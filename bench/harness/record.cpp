#include "bench/harness/record.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "bench/harness/trials.h"
#include "core/error.h"

namespace saccade::bench {
namespace {

constexpr std::array<std::pair<Kind, const char*>, 6> kKinds{{{Kind::error, "error"},
                                                              {Kind::time, "time"},
                                                              {Kind::rate, "rate"},
                                                              {Kind::ratio, "ratio"},
                                                              {Kind::count, "count"},
                                                              {Kind::bytes, "bytes"}}};
constexpr std::array<std::pair<Better, const char*>, 3> kBetter{
    {{Better::lower, "lower"}, {Better::higher, "higher"}, {Better::neither, "neither"}}};

template <class Table, class E>
std::string nameIn(const Table& table, E value) {
  const auto it = std::find_if(table.begin(), table.end(), [&](const auto& e) { return e.first == value; });
  assert(it != table.end());
  return it->second;
}

template <class Table>
auto valueIn(const Table& table, const std::string& name) {
  const auto it = std::find_if(table.begin(), table.end(), [&](const auto& e) { return e.second == name; });
  if (it == table.end()) throw core::Error("records know no \"" + name + "\"");
  return it->first;
}

Value over(const std::vector<double>& repeats, const char* unit, Kind kind, Better better) {
  const Spread s = spread(repeats);
  return {s.median, s.min, s.max, static_cast<int>(repeats.size()), unit, kind, better};
}

}  // namespace

std::string nameOf(Kind kind) { return nameIn(kKinds, kind); }
std::string nameOf(Better better) { return nameIn(kBetter, better); }
Kind kindOf(const std::string& name) { return valueIn(kKinds, name); }
Better betterOf(const std::string& name) { return valueIn(kBetter, name); }

Value Value::error(double value) { return over({value}, "", Kind::error, Better::lower); }
Value Value::errors(const std::vector<double>& repeats) {
  return over(repeats, "", Kind::error, Better::lower);
}
Value Value::count(double value, Better better) { return over({value}, "", Kind::count, better); }
Value Value::milliseconds(const std::vector<double>& repeats) {
  return over(repeats, "ms", Kind::time, Better::lower);
}
Value Value::seconds(const std::vector<double>& repeats) {
  return over(repeats, "s", Kind::time, Better::lower);
}
Value Value::rate(const std::vector<double>& repeats) {
  return over(repeats, "1/s", Kind::rate, Better::higher);
}
Value Value::perFrame(const std::vector<double>& repeats) {
  Value value = rate(repeats);
  value.unit = "1/frame";
  return value;
}

Value Value::ratio(const std::vector<double>& repeats, Better better) {
  return over(repeats, "", Kind::ratio, better);
}
Value Value::bytes(double value) { return over({value}, "bytes", Kind::bytes, Better::lower); }

Value Value::times(double factor) const {
  Value value = *this;
  value.median *= factor;
  value.min *= factor;
  value.max *= factor;
  return value;
}

const Record* RecordBook::find(const std::string& key) const {
  const auto it = std::find_if(records.begin(), records.end(), [&](const Record& r) { return r.key == key; });
  return it == records.end() ? nullptr : &*it;
}

}  // namespace saccade::bench
