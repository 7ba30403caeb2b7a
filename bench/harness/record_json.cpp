// Records as JSON and CSV.
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bench/harness/record.h"
#include "core/error.h"

namespace saccade::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSchema = 1;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
double numberOf(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

Json toJson(const Value& v) {
  return {{"median", number(v.median)}, {"min", number(v.min)}, {"max", number(v.max)},
          {"repeats", v.repeats},       {"unit", v.unit},       {"kind", nameOf(v.kind)},
          {"better", nameOf(v.better)}};
}

Value valueOf(const Json& json) {
  Value v;
  v.median = numberOf(json.at("median"));
  v.min = numberOf(json.at("min"));
  v.max = numberOf(json.at("max"));
  v.repeats = json.at("repeats").get<int>();
  v.unit = json.at("unit").get<std::string>();
  v.kind = kindOf(json.at("kind").get<std::string>());
  v.better = betterOf(json.at("better").get<std::string>());
  return v;
}

Json toJson(const RunInfo& r) {
  return {{"commit", r.commit},
          {"dirty", r.dirty},
          {"command", r.command},
          {"seed", r.seed},
          {"started", r.started},
          {"machine",
           {{"cpu", r.cpu},
            {"cores", r.cores},
            {"memory_bytes", r.memoryBytes},
            {"os", r.os},
            {"kernel", r.kernel}}},
          {"software", r.software},
          {"other_load", r.otherLoad},
          {"finished", r.finished}};
}

RunInfo runOf(const Json& json) {
  RunInfo r;
  r.commit = json.at("commit").get<std::string>();
  r.dirty = json.at("dirty").get<bool>();
  r.command = json.at("command").get<std::string>();
  r.seed = json.at("seed").get<std::uint32_t>();
  r.started = json.at("started").get<std::string>();
  const Json& machine = json.at("machine");
  r.cpu = machine.at("cpu").get<std::string>();
  r.cores = machine.at("cores").get<int>();
  r.memoryBytes = machine.at("memory_bytes").get<std::uint64_t>();
  r.os = machine.at("os").get<std::string>();
  r.kernel = machine.at("kernel").get<std::string>();
  r.software = json.at("software").get<std::map<std::string, std::string>>();
  r.otherLoad = json.at("other_load").get<double>();
  r.finished = json.at("finished").get<std::vector<std::string>>();
  return r;
}

Json toJson(const Record& r) {
  Json values = Json::object();
  for (const auto& [metric, value] : r.values) values[metric] = toJson(value);
  return {{"key", r.key}, {"experiment", r.experiment}, {"run", r.run},     {"labels", r.labels},
          {"at", r.at},   {"values", values},           {"files", r.files}, {"loaded", r.loaded}};
}

Record recordOf(const Json& json) {
  Record r;
  r.key = json.at("key").get<std::string>();
  r.experiment = json.at("experiment").get<std::string>();
  r.run = json.at("run").get<std::size_t>();
  r.labels = json.at("labels").get<std::map<std::string, std::string>>();
  r.at = json.at("at").get<std::map<std::string, double>>();
  for (const auto& [metric, value] : json.at("values").items()) r.values[metric] = valueOf(value);
  r.files = json.at("files").get<std::map<std::string, std::string>>();
  r.loaded = json.at("loaded").get<bool>();
  return r;
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

template <class Map>
std::string pairs(const Map& map) {
  std::ostringstream text;
  for (const auto& [name, value] : map) text << (text.tellp() > 0 ? " " : "") << name << '=' << value;
  return text.str();
}

}  // namespace

std::string toJson(const RecordBook& book) {
  Json json = {{"schema", kSchema}, {"runs", Json::array()}, {"records", Json::array()}};
  for (const RunInfo& run : book.runs) json["runs"].push_back(toJson(run));
  for (const Record& record : book.records) json["records"].push_back(toJson(record));
  return json.dump(1) + "\n";
}

RecordBook parseRecordBook(const std::string& text, const std::string& source) {
  RecordBook book;
  try {
    const Json json = Json::parse(text);
    if (json.at("schema").get<int>() != kSchema)
      throw core::Error("its schema is not " + std::to_string(kSchema));
    for (const Json& run : json.at("runs")) book.runs.push_back(runOf(run));
    for (const Json& record : json.at("records")) book.records.push_back(recordOf(record));
  } catch (const std::exception& e) {
    throw core::Error(source + ": not a file of records (" + e.what() +
                      "); give a records.json that `saccade bench` wrote");
  }
  for (const Record& record : book.records) {
    if (record.run >= book.runs.size())
      throw core::Error(source + ": " + record.key + " names run " + std::to_string(record.run) +
                        ", which the file does not hold");
  }
  return book;
}

std::string toCsv(const RecordBook& book) {
  std::ostringstream csv;
  csv.precision(9);
  csv << "key,experiment,commit,labels,at,metric,median,min,max,repeats,unit,kind,loaded\n";
  for (const Record& r : book.records) {
    for (const auto& [metric, v] : r.values) {
      csv << quoted(r.key) << ',' << r.experiment << ',' << book.runs[r.run].commit << ','
          << quoted(pairs(r.labels)) << ',' << quoted(pairs(r.at)) << ',' << metric << ',' << v.median << ','
          << v.min << ',' << v.max << ',' << v.repeats << ',' << v.unit << ',' << nameOf(v.kind) << ','
          << (r.loaded ? "yes" : "no") << '\n';
    }
  }
  return csv.str();
}

}  // namespace saccade::bench
