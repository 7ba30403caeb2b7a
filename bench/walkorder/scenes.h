// The scenes in which orders of correction are compared, and where the camera goes in them.
#pragma once

#include <string>
#include <vector>

#include "app/session/camera_path.h"
#include "bench/harness/experiment.h"

namespace saccade::bench {

struct WalkedScene {
  std::string file;
  app::CameraPath path;
  /// No rule of the queue was chosen by looking at walks of it, but for one: that the usual order has the
  /// gain.
  bool keptApart = false;
};

/// The bundled ones and those of the shared folder that are here; says which are not.
std::vector<WalkedScene> walkedScenes(Session& session);

}  // namespace saccade::bench
