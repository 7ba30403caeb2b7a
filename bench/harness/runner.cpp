#include "bench/harness/runner.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "bench/harness/baseline.h"
#include "core/atomic_file.h"
#include "core/error.h"

namespace saccade::bench {
namespace {

std::string readText(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = core::readWholeFile(file);
  return {bytes.begin(), bytes.end()};
}

void writeText(const std::filesystem::path& file, const std::string& text) {
  core::writeFileAtomically(file, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

void save(const BenchOptions& o, const RecordBook& book) {
  writeText(o.folder / "records.json", toJson(book));
  writeText(o.folder / "records.csv", toCsv(book));
}

RecordBook readRecords(const std::filesystem::path& file) {
  return parseRecordBook(readText(file), file.string());
}

RecordBook keptIn(const BenchOptions& o, const RunInfo& run) {
  const std::filesystem::path file = o.folder / "records.json";
  return std::filesystem::exists(file) ? keptRecords(readRecords(file), run) : RecordBook{};
}

/// Says what moved. False where something got worse.
bool holdsUpTo(const RecordBook& baseline, const RecordBook& book) {
  const BaselineReport report = compareToBaseline(baseline, book);
  for (const RunInfo& run : baseline.runs)
    std::printf("baseline: %s, %s, on %s\n", run.commit.c_str(), run.command.c_str(), run.cpu.c_str());
  std::fputs(toText(report).c_str(), stdout);
  return report.howMany(Verdict::worse) == 0;
}

bool finished(const RecordBook& book, const std::string& experiment) {
  return std::any_of(book.runs.begin(), book.runs.end(), [&](const RunInfo& run) {
    return std::find(run.finished.begin(), run.finished.end(), experiment) != run.finished.end();
  });
}

/// False where it failed.
bool runOne(const Experiment& experiment, Session& session, RecordBook& book) {
  std::fprintf(stderr, "== %s: %s\n", experiment.name.c_str(), experiment.question.c_str());
  session.beginExperiment(experiment.name);
  try {
    experiment.run(session);
  } catch (const std::exception& e) {
    session.checkStop();
    spdlog::error("{}: {}", experiment.name, e.what());
    return false;
  }
  session.checkStop();
  book.runs.back().finished.push_back(experiment.name);
  return true;
}

/// Plots and page, by Debian's own Python: its packages are not those of another one on the PATH. Without
/// them the records stand alone.
void writePage(const BenchOptions& o) {
  const std::string script = SACCADE_SOURCE_DIR "/bench/report/report.py";
  if (!std::filesystem::exists(script)) return;
  const std::string command = "/usr/bin/python3 '" + script + "' '" + o.folder.string() + "'";
  if (std::system(command.c_str()) != 0)
    spdlog::warn("no plots and no page: install python3-matplotlib and python3-jinja2, then run {}", command);
}

}  // namespace

RecordBook keptRecords(const RecordBook& before, const RunInfo& now) {
  RecordBook kept;
  if (now.dirty || now.commit == "unknown") return kept;
  for (std::size_t i = 0; i < before.runs.size(); ++i) {
    const RunInfo& run = before.runs[i];
    if (run.dirty || run.commit != now.commit || run.seed != now.seed || run.command != now.command) continue;
    kept.runs.push_back(run);
    for (Record record : before.records) {
      const bool done =
          std::find(run.finished.begin(), run.finished.end(), record.experiment) != run.finished.end();
      if (record.run != i || !done) continue;
      record.run = kept.runs.size() - 1;
      kept.records.push_back(std::move(record));
    }
  }
  return kept;
}

int runBench(const BenchOptions& o, const std::string& command, const std::stop_token& stop) {
  const std::vector<Experiment> experiments = chosenExperiments(o);
  std::optional<RecordBook> baseline;  // read first: it may be the file that this run writes anew
  if (!o.baseline.empty()) baseline = readRecords(o.baseline);
  std::filesystem::create_directories(o.folder);
  const RunInfo run = describeRun(command, o.seed);
  RecordBook book = keptIn(o, run);
  book.runs.push_back(run);
  Session session(o, stop, book, [](const std::string& line) { spdlog::info("{}", line); });
  const LoadWatch watch;
  bool good = true;
  for (const Experiment& experiment : experiments) {
    if (finished(book, experiment.name)) {
      spdlog::info("{}: kept from the earlier run in {}", experiment.name, o.folder.string());
      continue;
    }
    good = runOne(experiment, session, book) && good;
    book.runs.back().otherLoad = watch.othersShare().value_or(0);
    save(o, book);
  }
  save(o, book);
  writePage(o);
  std::printf("%zu records: %s\n", book.records.size(), (o.folder / "index.html").c_str());
  if (baseline) good = holdsUpTo(*baseline, book) && good;
  return good ? 0 : 1;
}

}  // namespace saccade::bench
