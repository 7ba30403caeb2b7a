// A question that the harness can answer, and what answers it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include "bench/harness/machine.h"
#include "bench/harness/record.h"
#include "bench/harness/trials.h"
#include "core/image.h"

namespace saccade::bench {

enum class Suite {
  quick,  ///< about a minute: does everything work, roughly how fast
  paper,  ///< tables and figures of the papers
  hard,   ///< achieved error of the numerical hard cases
  full    ///< everything
};

/// What the user asked for.
struct BenchOptions {
  Suite suite = Suite::quick;
  std::filesystem::path folder;      ///< -o
  std::vector<std::string> scenes;   ///< --scene: files instead of an experiment's own
  std::vector<std::string> methods;  ///< --method: names of methods; empty = all
  std::vector<std::string> only;     ///< --experiment: names; empty = the suite's
  std::string path;                  ///< --path: camera path for --scene
  std::string baseline;              ///< --baseline: records to compare with
  std::uint32_t seed = 1;

  bool wantsMethod(const std::string& name) const;
};

/// What a running experiment may use. Main thread only.
class Session {
 public:
  Session(const BenchOptions& options, std::stop_token stop, RecordBook& book,
          std::function<void(const std::string&)> say);

  const BenchOptions& options() const { return options_; }
  bool quick() const { return options_.suite == Suite::quick; }
  bool full() const { return options_.suite == Suite::full; }
  const std::stop_token& stop() const { return stop_; }
  /// Throws core::Error once the user asked to stop. To be called between pieces of work.
  void checkStop() const;

  /// A line for the person who waits: what is measured now, or why something is left out.
  void say(const std::string& line) const { say_(line); }

  /// Adds a record; its run and experiment are filled in, as is `loaded` by `watch`, which began before the
  /// figures were taken (null: nothing here depends on time). A record of the same key is replaced.
  void add(Record record, const LoadWatch* watch);

  /// Writes a picture to <folder>/pictures/<name>.png; the path for Record::files.
  std::string picture(const std::string& name, const core::ImageRgba8& image);
  /// The same after the display transform (exposure 0).
  std::string picture(const std::string& name, const core::ImageRgb& linear);
  /// An error map in [0, 1] as colours (core/metrics/colormap.h).
  std::string errorMap(const std::string& name, const core::ImageGray& map);

  /// The harness sets it before each experiment.
  void beginExperiment(const std::string& name) { experiment_ = name; }

 private:
  const BenchOptions& options_;
  std::stop_token stop_;
  RecordBook& book_;
  std::function<void(const std::string&)> say_;
  std::string experiment_;
};

struct Experiment {
  std::string name;      ///< the first part of its records' keys
  std::string question;  ///< one line, for --help and the page
  std::set<Suite> suites;
  std::function<void(Session&)> run;
};

/// All of them, in the order in which they run. bench/experiments.cpp.
const std::vector<Experiment>& allExperiments();

/// Those of the suite (full: every one), or those named by --experiment. Throws core::UsageError for an
/// unknown name.
std::vector<Experiment> chosenExperiments(const BenchOptions& options);

/// A scene of data/scenes by its name, a path of data/paths. For messages and keys: sceneName("a/b/x.glb") is
/// "x".
std::string bundledScene(const std::string& name);
std::string bundledPath(const std::string& name);
std::string sceneName(const std::string& file);
/// A file of the shared folder ($SACCADE_SHARED, default ../shared beside the sources); nothing where it is
/// absent: say so and go on.
std::optional<std::string> sharedFile(const std::string& relative);

}  // namespace saccade::bench
