// `walk --keep-cache`: the samples of one visit are where the next one of the same scene begins.
//
// One file a scene file in the cache folder. Samples of another state of the scene, other maps, another
// --spp or --seed, or another build of the program are not used: each of these changes corrections. --delta,
// --nmin,
// --max-age, --cache-mb, --order and the image's size do not: they decide which samples are shown, kept or
// traced first, and the first frame decides anew.
#pragma once

#include <cstdint>
#include <filesystem>

#include "app/cli/options.h"
#include "app/session/frame_loop.h"
#include "app/session/kept_file.h"
#include "app/session/workspace.h"

namespace saccade::app {

/// Main thread only; the workspace must outlive it. Once the GL context is there: its libraries count for
/// whether samples are exact.
class KeptCache {
 public:
  KeptCache(const Workspace& workspace, const SceneOptions& scene, const CorrectiveOptions& corrective,
            std::uint32_t seed);

  /// Before the loop's first step, and after FrameLoop::recordTo: a recorded walk begins without. Where
  /// nothing can be taken over, one line says why (none on a first visit).
  void restore(FrameLoop& loop) const;
  /// After the loop's last step. What cannot be written is a warning. `maxBytes`: of the file.
  void keep(const FrameLoop& loop) const;

  const std::filesystem::path& file() const { return file_; }

 private:
  const Workspace& workspace_;
  core::LoadLimits limits_;
  std::size_t maxBytes_;
  std::filesystem::path file_;
  SampleOrigin origin_;
};

}  // namespace saccade::app
