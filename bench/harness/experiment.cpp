#include "bench/harness/experiment.h"

#include <algorithm>
#include <cstdlib>

#include "core/composite.h"
#include "core/error.h"
#include "core/image_io.h"
#include "core/metrics/colormap.h"

namespace saccade::bench {
namespace {

std::string namesOf(const std::vector<Experiment>& experiments) {
  std::string names;
  for (const Experiment& e : experiments) names += (names.empty() ? "" : ", ") + e.name;
  return names;
}

}  // namespace

bool BenchOptions::wantsMethod(const std::string& name) const {
  return methods.empty() || std::find(methods.begin(), methods.end(), name) != methods.end();
}

Session::Session(const BenchOptions& options, std::stop_token stop, RecordBook& book,
                 std::function<void(const std::string&)> say)
    : options_(options), stop_(std::move(stop)), book_(book), say_(std::move(say)) {}

void Session::checkStop() const {
  if (stop_.stop_requested()) throw core::Error("stopped on request");
}

void Session::add(Record record, const LoadWatch* watch) {
  record.experiment = experiment_;
  record.run = book_.runs.size() - 1;
  record.loaded = watch && watch->othersShare().value_or(0) > kLoadedShare;
  const auto same = [&](const Record& r) { return r.key == record.key; };
  std::erase_if(book_.records, same);
  book_.records.push_back(std::move(record));
}

std::string Session::picture(const std::string& name, const core::ImageRgba8& image) {
  const std::string relative = "pictures/" + name + ".png";
  std::filesystem::create_directories(options_.folder / "pictures");
  core::writePng(options_.folder / relative, image);
  return relative;
}

std::string Session::picture(const std::string& name, const core::ImageRgb& linear) {
  return picture(name, core::toDisplay(linear, 0));
}

std::string Session::errorMap(const std::string& name, const core::ImageGray& map) {
  return picture(name, core::rampPicture(map));
}

std::vector<Experiment> chosenExperiments(const BenchOptions& options) {
  std::vector<Experiment> chosen;
  for (const std::string& name : options.only) {
    const auto known = [&](const Experiment& e) { return e.name == name; };
    if (std::none_of(allExperiments().begin(), allExperiments().end(), known))
      throw core::UsageError("--experiment " + name + ": there is none; there are " +
                             namesOf(allExperiments()));
  }
  for (const Experiment& e : allExperiments()) {
    const bool named = std::find(options.only.begin(), options.only.end(), e.name) != options.only.end();
    const bool ofSuite = options.suite == Suite::full || e.suites.count(options.suite) > 0;
    if (options.only.empty() ? ofSuite : named) chosen.push_back(e);
  }
  return chosen;
}

std::string bundledScene(const std::string& name) {
  return SACCADE_SOURCE_DIR "/data/scenes/" + name + ".glb";
}
std::string bundledPath(const std::string& name) {
  return SACCADE_SOURCE_DIR "/data/paths/" + name + ".json";
}
std::string sceneName(const std::string& file) { return std::filesystem::path(file).stem().string(); }

std::optional<std::string> sharedFile(const std::string& relative) {
  const char* folder = std::getenv("SACCADE_SHARED");
  const auto file = std::filesystem::path(folder ? folder : SACCADE_SOURCE_DIR "/../shared") / relative;
  if (!std::filesystem::exists(file)) return std::nullopt;
  return file.string();
}

}  // namespace saccade::bench
