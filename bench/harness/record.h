// What an experiment leaves behind: records, written as JSON and CSV. docs/benchmarks.md describes the files.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace saccade::bench {

/// What a value is, which says how two runs of it may be compared.
enum class Kind {
  error,  ///< of a picture or a number against its truth
  time,   ///< depends on the machine; unit "ms" or "s"
  rate,   ///< per second; depends on the machine
  ratio,  ///< of two figures of one run: comparable between runs
  count,  ///< deterministic: equal in every run of one seed
  bytes
};
enum class Better { lower, higher, neither };

/// "error", "time", ... as in records.json.
std::string nameOf(Kind kind);
std::string nameOf(Better better);
/// Throw core::Error for another name.
Kind kindOf(const std::string& name);
Better betterOf(const std::string& name);

/// A figure over its repeats. Kind::count and most errors have one.
struct Value {
  double median = 0;  ///< the lower one of an even number
  double min = 0, max = 0;
  int repeats = 1;
  std::string unit;  ///< "ms", "s", "1/s", "bytes"; empty for pure numbers
  Kind kind = Kind::error;
  Better better = Better::lower;

  static Value error(double value);
  static Value count(double value, Better better = Better::neither);
  /// At least one repeat each.
  static Value milliseconds(const std::vector<double>& repeats);
  static Value seconds(const std::vector<double>& repeats);
  static Value rate(const std::vector<double>& repeats);
  static Value perFrame(const std::vector<double>& repeats);
  static Value ratio(const std::vector<double>& repeats, Better better);
  static Value bytes(double value);
  /// The same figure in another unit, or by another measure of size.
  Value times(double factor) const;
  /// Errors of repeats that are not deterministic: pictures that had a time to be made in.
  static Value errors(const std::vector<double>& repeats);
};

/// One figure of every repeat.
template <class Repeats, class Get>
std::vector<double> each(const Repeats& repeats, Get get) {
  std::vector<double> values;
  values.reserve(repeats.size());
  for (const auto& repeat : repeats) values.push_back(get(repeat));
  return values;
}

struct Record {
  std::string key;         ///< unique and stable: "still/cornell/corrective-attention@125ms"
  std::string experiment;  ///< the key's first part
  std::size_t run = 0;     ///< index of the run it was measured in
  std::map<std::string, std::string> labels;
  std::map<std::string, double> at;          ///< where on the axes of a plot: "budget_ms", "triangles", ...
  std::map<std::string, Value> values;       ///< by metric
  std::map<std::string, std::string> files;  ///< pictures by role, relative to the folder of records.json
  bool loaded = false;  ///< other processes took more than kLoadedShare of the machine meanwhile
};

/// One call of `saccade bench`.
struct RunInfo {
  std::string commit;  ///< short hash, or "unknown"
  bool dirty = false;  ///< the working tree differed from it
  std::string command;
  std::uint32_t seed = 1;
  std::string started;  ///< UTC, ISO 8601
  std::string cpu, os, kernel;
  int cores = 0;
  std::uint64_t memoryBytes = 0;
  std::map<std::string, std::string> software;  ///< versions by name
  double otherLoad = 0;                         ///< share of the machine other processes took, [0, 1]
  std::vector<std::string> finished;            ///< experiments that came to their end
};

/// Everything in one records.json.
struct RecordBook {
  std::vector<RunInfo> runs;
  std::vector<Record> records;

  /// Null where there is none.
  const Record* find(const std::string& key) const;
};

/// Schema 1. Doubles survive the round trip exactly; values that are not finite are written as null and read
/// as NaN. parse throws core::Error that names `source` and the place.
std::string toJson(const RecordBook& book);
RecordBook parseRecordBook(const std::string& json, const std::string& source);

/// One line a value: key, experiment, run's commit, labels and at as name=value, metric, median, min, max,
/// repeats, unit, kind, loaded.
std::string toCsv(const RecordBook& book);

}  // namespace saccade::bench
