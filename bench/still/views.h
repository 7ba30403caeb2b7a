// The still views that are measured, and the confidence of their references.
#pragma once

#include <string>
#include <vector>

#include "app/cli/options.h"
#include "bench/harness/experiment.h"
#include "bench/reference/reference.h"

namespace saccade::bench {

struct StillView {
  std::string file;     ///< the scene's; its first camera
  std::string quality;  ///< of the illumination maps
  app::ImageSize size;
  Confidence confidence;
  double longestSeconds = 0;  ///< StillTask::longestSeconds

  std::string name() const { return sceneName(file); }
  std::string sizeName() const { return std::to_string(size.width) + "x" + std::to_string(size.height); }
};

/// quick: cornell; paper: cornell, table, gallery; full: the shared glossy room as well, where it is there
/// (`session` says so where not); the user's --scene instead of all.
std::vector<StillView> stillViews(const Session& session);

/// The reference of a view of an opened scene.
Reference referenceOf(const app::Workspace& workspace, const StillView& view, const std::stop_token& stop);

}  // namespace saccade::bench
