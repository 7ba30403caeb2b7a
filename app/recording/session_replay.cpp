#include "app/recording/session_replay.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/maps.h"

namespace saccade::app {

namespace {

bool validCamera(const RecordedFrame& frame, const core::Bounds& bounds) {
  try {
    const core::View view(frame.camera, frame.size.width, frame.size.height, bounds);
    static_cast<void>(view);
    return true;
  } catch (const core::Error&) {
    return false;
  }
}

}  // namespace

std::unique_ptr<Workspace> openRecorded(const SessionReader& session, const std::string& sceneFile,
                                        const std::string& mapsFile) {
  const SessionInfo& info = session.info();
  SceneOptions options = info.scene;
  if (!sceneFile.empty()) options.path = sceneFile;
  if (!std::filesystem::exists(options.path))
    throw core::Error(options.path + ": the scene of " + session.file().string() +
                      " is not there any more; say where it is with --scene-file");
  auto workspace = std::make_unique<Workspace>();
  workspace->scene = loadSceneReported(options);
  if (core::sceneKey(workspace->scene) != info.sceneHash)
    throw core::Error(options.path + ": is not the scene that " + session.file().string() +
                      " was recorded in, or was changed since; name that one with --scene-file");
  const std::filesystem::path maps = mapsFile.empty() ? info.maps : std::filesystem::path(mapsFile);
  if (!std::filesystem::exists(maps))
    throw core::Error(maps.string() + ": the illumination maps of " + session.file().string() +
                      " are not there any more; bake them as they were, or name them with --maps");
  workspace->maps = core::readMaps(maps, info.sceneHash);
  workspace->mapsWereThere = true;
  if (core::contentHash(workspace->maps) != info.mapsHash)
    throw core::Error(maps.string() + ": are not the illumination maps that " + session.file().string() +
                      " was recorded with; name those with --maps, or record again");
  core::applyCharts(workspace->scene, workspace->maps.charts);
  return workspace;
}

SessionReplay::SessionReplay(SessionReader& session, const core::Scene& scene, render::BaseRenderer& renderer)
    : session_(session), scene_(scene), renderer_(renderer) {}

bool SessionReplay::next() {
  if (!damage_.empty()) return false;
  const std::optional<RecordedFrame> frame = session_.nextFrame();
  if (!frame || !show(*frame)) return false;
  frame_ = frame;
  ++frames_;
  return true;
}

bool SessionReplay::show(const RecordedFrame& frame) {
  if (!validCamera(frame, scene_.bounds)) return damage_ = "a camera is impossible", false;
  if (!picture_) picture_.emplace(scene_, renderer_, frame.settings.picture, stats_);
  picture_->settings() = frame.settings.picture;
  if (frame.newView) {
    picture_->begin(frame.camera, frame.size);
  } else if (!picture_->shows(frame.camera, frame.size)) {
    return damage_ = "a camera that rests has moved", false;
  }
  if (picture_->frame()->epoch != frame.epoch) return damage_ = "views are missing", false;
  while (std::optional<core::SampleBatch> batch = session_.nextBatch()) {
    if (batch->epoch > frame.epoch) return damage_ = "samples come from later frames", false;
    dropImpossible(*batch, frame);
    picture_->take(*batch);
  }
  if (!session_.frameIsWhole()) return false;
  picture_->drawProbes();
  picture_->composite();
  return true;
}

void SessionReplay::dropImpossible(core::SampleBatch& batch, const RecordedFrame& frame) {
  const std::uint32_t ids = scene_.idCount();
  const bool current = batch.epoch == frame.epoch;
  const auto impossible = [&](const core::Sample& s) {
    const bool known = s.id >= 1 && s.id <= ids && s.level >= 1 && s.level <= core::Lattice::kMaxLevel;
    const bool inside = !current || (s.x < frame.size.width && s.y < frame.size.height);
    return !core::isFinite(s) || !known || !inside;
  };
  droppedSamples_ += std::erase_if(batch.samples, impossible);
}

core::Warnings SessionReplay::warnings() const {
  core::Warnings out;
  const std::string name = session_.file().string();
  const std::string& damage = damage_.empty() ? session_.damage() : damage_;
  if (!damage.empty())
    out.push_back(name + ": cannot be read beyond frame " + std::to_string(frames_) + " (" + damage +
                  "); what comes before is replayed");
  if (droppedSamples_ > 0)
    out.push_back(name + ": " + std::to_string(droppedSamples_) +
                  " samples are impossible (not finite, or of no pixel or object) and left out");
  if (session_.backwardTimes() > 0)
    out.push_back(name + ": " + std::to_string(session_.backwardTimes()) +
                  " frames are earlier than the one before; they follow at once");
  return out;
}

}  // namespace saccade::app
