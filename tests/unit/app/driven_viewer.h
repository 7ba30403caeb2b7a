// A person at the real viewer: runViewer in this process, and a script beside it that sends events to its
// window, looks at each frame's state and at the screen.
#pragma once

#include <functional>
#include <memory>
#include <semaphore>
#include <string>
#include <thread>
#include <utility>

#include "app/cli/walk_options.h"
#include "app/viewer/viewer.h"
#include "tests/x_driver.h"

namespace saccade::tests {

/// XDG_CACHE_HOME, XDG_CONFIG_HOME and the current folder are the test's own, under temporaryFolder(), until
/// the end: a test leaves nothing in its user's and finds nothing there. One at a time.
class OwnFolders {
 public:
  OwnFolders();
  ~OwnFolders();
  OwnFolders(const OwnFolders&) = delete;
  OwnFolders& operator=(const OwnFolders&) = delete;

 private:
  std::filesystem::path folderBefore_;
  std::string cacheBefore_, configBefore_;
};

/// The bundled Cornell box in a window of 640 x 800 with the panel, maps of preview quality.
app::WalkOptions drivenOptions();

/// The script runs in a thread of its own, but only while the viewer waits between two frames: the two never
/// run at the same time.
class DrivenViewer {
 public:
  using Script = std::function<void(DrivenViewer&)>;

  /// Runs the viewer until its window is closed, by the script or at its end. A step that fails ends the
  /// script and is a test failure that says what the state was. Returns runViewer's status; -1 where that
  /// threw.
  static int run(const app::WalkOptions& options, const Script& script);

  XDriver& x() { return *x_; }
  /// Of the last frame, until the next. Not after the window closed.
  const app::ViewerState& state() const { return *state_; }

  /// Lets the viewer show more frames.
  void frames(int count = 1);
  /// Frame after frame until `done`, which `what` names, for at most a minute.
  void until(const std::string& what, const std::function<bool()>& done);
  /// The same for the end of runViewer.
  void untilClosed();
  /// The scene's first picture is shown.
  void untilOpen();
  /// The picture is converged, and is what the screen shows left of the panel.
  void untilConverged();

  /// Press, wait until `done`, release.
  void hold(const std::string& key, const std::string& what, const std::function<bool()>& done);
  /// With a frame between the steps, as ImGui wants: in a control of the panel, at a part of its width.
  void clickOn(const std::string& item, double part = 0.5);
  void drag(int fromX, int fromY, int toX, int toY);
  void dragOn(const std::string& item, double fromPart, double toPart);

  /// Pixels of the window as the screen shows them; the picture's part; a control's.
  core::ImageRgba8 screen() const { return x_->screen(); }
  core::ImageRgba8 picture() const;
  core::ImageRgba8 control(const std::string& item) const;
  /// Left of the panel.
  render::PixelRect pictureArea() const;

 private:
  struct Stopped {};  ///< thrown in the script: it has failed

  explicit DrivenViewer(Script script) : script_(std::move(script)) {}
  void afterFrame(const app::ViewerState& state);
  void follow();
  void end();
  render::PixelRect place(const std::string& item) const;
  [[noreturn]] void fail(const std::string& what);
  std::string describe() const;

  Script script_;
  std::unique_ptr<XDriver> x_;
  const app::ViewerState* state_ = nullptr;
  std::binary_semaphore scriptsTurn_{0}, viewersTurn_{0};
  bool scriptEnded_ = false;
  bool closed_ = false;  ///< runViewer has returned
  std::thread thread_;
};

/// The object with corrections that has most pixels.
std::uint32_t largestOf(const core::FrameSnapshot& frame);
/// {x, y} of the object's pixel that is nearest to the middle of its box.
std::pair<int, int> pixelOf(const core::FrameSnapshot& frame, std::uint32_t id);

core::ImageRgba8 crop(const core::ImageRgba8& image, const render::PixelRect& area);
/// How many pixels differ; images of different size differ everywhere.
std::size_t pixelsThatDiffer(const core::ImageRgba8& a, const core::ImageRgba8& b);
/// How many pixels have this colour.
std::size_t pixelsOf(const core::ImageRgba8& image, const core::Rgba8& color);

}  // namespace saccade::tests
