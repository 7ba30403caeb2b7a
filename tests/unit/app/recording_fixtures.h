// Sessions recorded and replayed without the command line.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <functional>
#include <string>
#include <vector>

#include "app/recording/session_format.h"
#include "app/recording/session_recorder.h"
#include "app/recording/session_replay.h"
#include "app/session/camera_path.h"
#include "tests/unit/app/fixtures.h"

namespace saccade::tests {

inline constexpr app::ImageSize kSmall{96, 64};

inline const app::Workspace& cornell() { return workspaceOf(bundled("cornell.glb")); }

inline app::SessionInfo infoOfCornell(const app::Headless& gl) {
  app::SceneOptions scene;
  scene.path = bundled("cornell.glb").string();
  return app::describeSession(scene, temporaryFolder() / "cornell.glb.maps", cornell(), {}, {},
                              {gl.context->name(), gl.context->renderer(), app::cpuName()});
}

inline core::Camera cameraAt(double seconds) {
  return app::CameraPath::orbit(cornell().scene.cameras.at(0), 12).at(seconds);
}

/// What a walk showed.
using Pictures = std::vector<core::ImageRgba8>;

/// Records `frames` steps; `step` makes the one of that number and may change settings before. The pictures.
inline Pictures recordWalk(const std::filesystem::path& file, const app::FrameLoopOptions& options,
                           int frames, const std::function<void(app::FrameLoop&, int)>& step) {
  const app::Headless gl(runOn("osmesa"), cornell());
  app::SessionRecorder recorder(file, infoOfCornell(gl));
  Pictures shown;
  {
    app::FrameLoop loop(cornell(), *gl.renderer, options);
    loop.recordTo(recorder);
    for (int i = 0; i < frames; ++i) {
      recorder.setSeconds(i / 25.0);
      step(loop, i);
      shown.push_back(loop.display());
    }
  }
  const app::SessionRecorder::Outcome outcome = recorder.finish();
  EXPECT_TRUE(outcome.complete);
  EXPECT_EQ(outcome.frames, frames);
  return shown;
}

struct Replayed {
  Pictures shown;
  core::Warnings warnings;
};

inline Replayed replayed(const std::filesystem::path& file) {
  app::SessionReader session(file);
  const auto workspace = app::openRecorded(session, "", "");
  const app::Headless gl(runOn("osmesa"), *workspace);
  app::SessionReplay replay(session, workspace->scene, *gl.renderer);
  Replayed out;
  while (replay.next()) {
    EXPECT_EQ(app::frameHash(replay.display()), replay.frame().hash) << "frame " << replay.number();
    out.shown.push_back(replay.display());
  }
  out.warnings = replay.warnings();
  return out;
}

/// The number of the first picture that differs; -1 for none.
inline int firstDifference(const Pictures& a, const Pictures& b) {
  if (a.size() != b.size()) return static_cast<int>(std::min(a.size(), b.size()));
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].pixels() != b[i].pixels()) return static_cast<int>(i);
  }
  return -1;
}

inline void alter(const std::filesystem::path& file, const std::string& sql) {
  SQLite::Database db(file.string(), SQLite::OPEN_READWRITE);
  db.exec(sql);
}

inline std::int64_t askedOf(const std::filesystem::path& file, const std::string& sql) {
  SQLite::Database db(file.string(), SQLite::OPEN_READWRITE);
  return db.execAndGet(sql).getInt64();
}

}  // namespace saccade::tests
