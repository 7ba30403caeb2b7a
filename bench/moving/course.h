// A scene, a stretch of its camera path, and the truth at its key views: what all walks of a scene share.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/harness/experiment.h"
#include "bench/harness/method.h"
#include "bench/moving/walk_trial.h"

namespace saccade::bench {

struct CourseOptions {
  std::string scene;    ///< file
  std::string path;     ///< file; empty = orbit around what the first camera looks at
  std::string quality;  ///< of the maps
  app::ImageSize size;
  double segment = 0.5;  ///< seconds between key views
  int segments = 3;
  double referenceRelmse = 1e-3, referenceSeconds = 40;  ///< each key view's reference, as Confidence
};

/// Main thread only.
class Course {
 public:
  /// Opens the scene, computes or reads the references, and adds their own error as the record
  /// "moving/SCENE/reference". Throws core::Error.
  Course(Session& session, const CourseOptions& options);

  /// One walk from nothing, its main thread pinned; the method must be able to walk. `warmUp`: as far as the
  /// first key view only.
  WalkResult walk(const Method& method, double budgetSeconds, bool warmUp);
  /// What raytrace shows at the key views of this budget and at the frames before them: motion without
  /// flicker.
  WalkResult raytraceShots(double budgetSeconds);

  const std::string& name() const { return stage_->name; }
  const std::vector<Grader>& truths() const { return truths_; }
  const Stretch& stretch() const { return stretch_; }
  /// The picture of the last key view's reference, relative to the session's folder.
  const std::string& referenceFile() const { return referenceFile_; }

 private:
  void addReferences(Session& session, const CourseOptions& options);

  std::unique_ptr<Stage> stage_;
  app::ImageSize size_;
  app::CameraPath path_;
  Stretch stretch_;
  std::vector<Grader> truths_;  ///< by key view
  std::string referenceFile_;
};

}  // namespace saccade::bench
