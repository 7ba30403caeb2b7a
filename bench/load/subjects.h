// The scenes whose way from file to picture is measured.
#pragma once

#include <string>
#include <vector>

#include "app/cli/options.h"
#include "bench/harness/experiment.h"

namespace saccade::bench {

inline constexpr const char* kSubjectQuality = "preview";  ///< of their maps

struct Subject {
  std::string file;
  std::string unitScale = "1";  ///< metres per unit
};

/// Those that --scene names; else the bundled ones and, unless the suite is quick, those of the shared
/// folder. `experiment` says which of the latter are not here.
std::vector<Subject> subjectsOf(Session& session, const std::string& experiment,
                                const std::vector<std::string>& bundled);
/// To open it with.
app::SceneOptions optionsOf(const Subject& s);

}  // namespace saccade::bench
