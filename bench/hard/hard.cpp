#include "bench/hard/hard.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "bench/hard/cases.h"
#include "bench/hard/test_report.h"
#include "bench/harness/process.h"
#include "core/atomic_file.h"
#include "core/error.h"

namespace saccade::bench {
namespace {

constexpr std::array kRooms = {"core", "render", "attention", "raytrace", "app"};

std::string programName(const std::string& room) { return "test_" + room; }

/// Every name with a number behind "Hard", not all that begin with hard-.
std::string filter() {
  std::string all;
  for (char digit = '1'; digit <= '9'; ++digit)
    all += std::string(all.empty() ? "" : ":") + "*Hard" + digit + "*";
  return all;
}

std::filesystem::path folderOfThisProgram() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

void requirePrograms(const std::filesystem::path& folder) {
  std::string missing;
  for (const char* room : kRooms)
    if (!std::filesystem::exists(folder / programName(room))) missing += " " + programName(room);
  if (!missing.empty())
    throw core::Error("the hard cases are measured by the test programs; beside " +
                      (folder / "saccade").string() + " there is no" + missing + ": build them (ninja" +
                      missing + ")");
}

std::vector<ClauseResult> runTests(Session& session, const std::string& room) {
  const std::filesystem::path program = folderOfThisProgram() / programName(room);
  const std::filesystem::path folder = session.options().folder / "tests";
  const std::filesystem::path report = std::filesystem::absolute(folder / (programName(room) + ".json"));
  std::filesystem::create_directories(folder);
  std::filesystem::remove(report);
  session.say("hard: " + programName(room));
  // A failing test is in the report: what else may have gone wrong left none.
  const Outcome outcome =
      runToEnd(programName(room),
               {program.string(), "--gtest_filter=" + filter(), "--gtest_output=json:" + report.string()},
               session.stop());
  if (!std::filesystem::exists(report))
    throw core::Error(programName(room) + " ended with status " + std::to_string(outcome.status) +
                      " before it wrote a report; run " + program.string() + " --gtest_filter='" + filter() +
                      "' to see why");
  const std::vector<std::uint8_t> bytes = core::readWholeFile(report);
  return parseTestReport({bytes.begin(), bytes.end()}, report.string());
}

std::string titleOf(int number) {
  for (const HardCaseTitle& t : hardCaseTitles())
    if (t.number == number) return std::string(t.title);
  throw core::Error("there is no hard case " + std::to_string(number) + ": tests are named Hard1 to Hard28");
}

Record recordOf(const ClauseResult& c) {
  Record record;
  record.key = "hard/" + std::to_string(c.number) + "/" + c.slug();
  record.labels = {{"number", std::to_string(c.number)},
                   {"title", titleOf(c.number)},
                   {"case", c.clause},
                   {"test", c.test}};
  if (c.failed) record.labels["result"] = "failed";
  Value achieved = Value::error(c.achieved), allowed = Value::error(c.allowed);
  achieved.unit = allowed.unit = c.unit;
  if (c.count) achieved.kind = allowed.kind = Kind::count;
  allowed.better = Better::neither;
  record.values = {{"achieved", achieved}, {"allowed", allowed}, {"checks", Value::count(c.checks)}};
  if (c.achieved > 0 && c.allowed > 0)
    record.values["headroom"] = Value::ratio({c.allowed / c.achieved}, Better::higher);
  return record;
}

Record notBuiltRecord(const HardCaseTitle& t) {
  Record record;
  record.key = "hard/" + std::to_string(t.number) + "/not-built-yet";
  record.labels = {{"number", std::to_string(t.number)},
                   {"title", std::string(t.title)},
                   {"case", "not built yet: " + std::string(t.notBuilt)},
                   {"result", "not built"}};
  return record;
}

/// What went wrong, one line a thing.
std::vector<std::string> complaints(const std::vector<ClauseResult>& clauses) {
  std::vector<std::string> lines;
  for (const ClauseResult& c : clauses)
    if (c.failed)
      lines.push_back("case " + std::to_string(c.number) + " failed in " + c.test + ": " + c.clause);
  for (const HardCaseTitle& t : hardCaseTitles()) {
    const bool measured = std::any_of(clauses.begin(), clauses.end(),
                                      [&](const ClauseResult& c) { return c.number == t.number; });
    if (!measured && t.notBuilt.empty()) lines.push_back("no test reports case " + std::to_string(t.number));
  }
  return lines;
}

}  // namespace

void measureHardCases(Session& session) {
  requirePrograms(folderOfThisProgram());
  std::vector<ClauseResult> clauses;
  for (const char* room : kRooms) {
    const std::vector<ClauseResult> more = runTests(session, room);
    clauses.insert(clauses.end(), more.begin(), more.end());
  }
  clauses = mergeClauses(clauses);
  for (const ClauseResult& c : clauses) session.add(recordOf(c), nullptr);
  for (const HardCaseTitle& t : hardCaseTitles())
    if (!t.notBuilt.empty()) session.add(notBuiltRecord(t), nullptr);
  const std::vector<std::string> wrong = complaints(clauses);
  for (const std::string& line : wrong) session.say("hard: " + line);
  if (!wrong.empty())
    throw core::Error(std::to_string(wrong.size()) + " of " + std::to_string(clauses.size()) +
                      " clauses of the hard cases failed or are missing; the first: " + wrong.front());
}

}  // namespace saccade::bench
