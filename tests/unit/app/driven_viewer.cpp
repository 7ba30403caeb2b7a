#include "tests/unit/app/driven_viewer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "tests/unit/app/fixtures.h"

namespace saccade::tests {

namespace {

using namespace std::chrono_literals;

constexpr std::chrono::seconds kPatience{60};
/// A viewer that nobody ends any more closes by itself.
constexpr double kLongestSeconds = 600;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

void setVariable(const char* name, const std::string& value) {
  if (value.empty()) {
    ::unsetenv(name);
  } else {
    ::setenv(name, value.c_str(), 1);
  }
}

}  // namespace

OwnFolders::OwnFolders()
    : folderBefore_(std::filesystem::current_path()),
      cacheBefore_(variable("XDG_CACHE_HOME")),
      configBefore_(variable("XDG_CONFIG_HOME")) {
  const std::filesystem::path own = temporaryFolder() / "window";
  for (const char* name : {"config", "work"}) {
    std::filesystem::remove_all(own / name);
    std::filesystem::create_directories(own / name);
  }
  setVariable("XDG_CACHE_HOME", (own / "cache").string());  // kept: its maps are baked once
  setVariable("XDG_CONFIG_HOME", (own / "config").string());
  std::filesystem::current_path(own / "work");
}

OwnFolders::~OwnFolders() {
  std::filesystem::current_path(folderBefore_);
  setVariable("XDG_CACHE_HOME", cacheBefore_);
  setVariable("XDG_CONFIG_HOME", configBefore_);
}

app::WalkOptions drivenOptions() {
  app::WalkOptions options;
  options.scene.path = bundled("cornell.glb").string();
  options.scene.quality = "preview";
  options.scene.photons = 50000;
  options.size = {640 - app::kPanelWidth, 800};
  options.fps = 20;
  options.exitAfterSeconds = kLongestSeconds;
  return options;
}

int DrivenViewer::run(const app::WalkOptions& options, const Script& script) {
  DrivenViewer viewer(script);
  viewer.thread_ = std::thread([&viewer] { viewer.follow(); });
  int status = -1;
  try {
    status = app::runViewer(options, [&viewer](const app::ViewerState& state) { viewer.afterFrame(state); });
  } catch (const core::Error& error) {
    ADD_FAILURE() << "the viewer ended with: " << error.what();
  }
  viewer.end();
  return status;
}

/// Main thread.
void DrivenViewer::afterFrame(const app::ViewerState& state) {
  if (scriptEnded_) return;
  state_ = &state;
  scriptsTurn_.release();
  viewersTurn_.acquire();
  state_ = nullptr;
}

/// Main thread, once the window is gone.
void DrivenViewer::end() {
  closed_ = true;
  scriptsTurn_.release();
  thread_.join();
}

/// The script's thread.
void DrivenViewer::follow() {
  scriptsTurn_.acquire();
  try {
    if (!closed_) {
      x_ = std::make_unique<XDriver>("Saccade");
      script_(*this);
    }
    if (!closed_) x_->close();
  } catch (const Stopped&) {
    if (!closed_ && x_) x_->close();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "the script ended with: " << error.what();
    if (!closed_ && x_) x_->close();
  }
  scriptEnded_ = true;
  viewersTurn_.release();
}

void DrivenViewer::frames(int count) {
  for (int i = 0; i < count; ++i) {
    if (closed_) fail("another frame");
    viewersTurn_.release();
    scriptsTurn_.acquire();
  }
  if (closed_) fail("another frame");
}

void DrivenViewer::until(const std::string& what, const std::function<bool()>& done) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) fail(what);
    frames();
  }
}

void DrivenViewer::untilClosed() {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!closed_) {
    if (std::chrono::steady_clock::now() > end) fail("the window closes");
    viewersTurn_.release();
    scriptsTurn_.acquire();
  }
}

void DrivenViewer::untilOpen() {
  until("a scene's first picture", [this] { return state().loop && !state().loop->stats().frameMs.empty(); });
}

void DrivenViewer::untilConverged() {
  until("a converged picture on the screen", [this] {
    return state().loop && state().loop->converged() &&
           picture().pixels() == state().loop->display().pixels();
  });
}

void DrivenViewer::hold(const std::string& key, const std::string& what, const std::function<bool()>& done) {
  x().keyDown(key);
  frames();
  until(what, done);
  x().keyUp(key);
  frames();
}

render::PixelRect DrivenViewer::place(const std::string& item) const {
  const render::PixelRect at = state().items.at(item);
  if (at.width < 1) throw std::runtime_error("the panel has no control \"" + item + "\"");
  return at;
}

void DrivenViewer::clickOn(const std::string& item, double part) {
  const render::PixelRect at = place(item);
  x().moveTo(at.x + static_cast<int>(part * at.width), at.y + at.height / 2);
  frames(2);
  x().buttonDown(1);
  frames(2);
  x().buttonUp(1);
  frames(2);
}

void DrivenViewer::drag(int fromX, int fromY, int toX, int toY) {
  x().moveTo(fromX, fromY);
  frames(2);
  x().buttonDown(1);
  frames(2);
  constexpr int kSteps = 4;
  for (int i = 1; i <= kSteps; ++i) {
    x().moveTo(fromX + (toX - fromX) * i / kSteps, fromY + (toY - fromY) * i / kSteps);
    frames();
  }
  x().buttonUp(1);
  frames(2);
}

void DrivenViewer::dragOn(const std::string& item, double fromPart, double toPart) {
  const render::PixelRect at = place(item);
  const auto across = [&at](double part) { return at.x + static_cast<int>(part * at.width); };
  drag(across(fromPart), at.y + at.height / 2, across(toPart), at.y + at.height / 2);
}

render::PixelRect DrivenViewer::pictureArea() const {
  return {0, 0, state().width - state().panelWidth, state().height};
}

core::ImageRgba8 DrivenViewer::picture() const { return crop(screen(), pictureArea()); }
core::ImageRgba8 DrivenViewer::control(const std::string& item) const { return crop(screen(), place(item)); }

void DrivenViewer::fail(const std::string& what) {
  ADD_FAILURE() << "waited in vain for: " << what << "; " << describe();
  throw Stopped{};
}

std::string DrivenViewer::describe() const {
  if (!state_ || closed_) return "the window is closed";
  const app::ViewerState& s = *state_;
  std::ostringstream text;
  text << "window " << s.width << "x" << s.height << (s.fullscreen ? ", full screen" : "") << ", scene \""
       << s.scene << "\", attention " << s.panel.attention << ", panel " << (s.panel.visible ? "on" : "off")
       << ", message \"" << s.panel.message << "\"";
  if (s.panel.overlay) text << ", overlay " << static_cast<int>(*s.panel.overlay);
  if (s.camera) {
    const core::Camera& c = *s.camera;
    text << ", eye " << c.eye.x << " " << c.eye.y << " " << c.eye.z << ", at " << c.at.x << " " << c.at.y
         << " " << c.at.z << ", field of view " << c.fovYDegrees;
  }
  if (s.loop) {
    text << ", " << s.loop->stats().frameMs.size() << " frames, "
         << (s.loop->converged() ? "converged" : "not converged");
  }
  return text.str();
}

core::ImageRgba8 crop(const core::ImageRgba8& image, const render::PixelRect& area) {
  const int left = std::max(0, area.x), top = std::max(0, area.y);
  const int right = std::min(image.width(), area.x + area.width);
  const int bottom = std::min(image.height(), area.y + area.height);
  core::ImageRgba8 part(std::max(0, right - left), std::max(0, bottom - top));
  for (int y = 0; y < part.height(); ++y) {
    for (int x = 0; x < part.width(); ++x) part.at(x, y) = image.at(left + x, top + y);
  }
  return part;
}

std::uint32_t largestOf(const core::FrameSnapshot& frame) {
  std::uint32_t largest = 1;
  for (std::uint32_t id = 1; id < frame.extents.size(); ++id)
    if (frame.extents[id].pixels > frame.extents[largest].pixels) largest = id;
  return largest;
}

std::pair<int, int> pixelOf(const core::FrameSnapshot& frame, std::uint32_t id) {
  const core::ObjectExtent& extent = frame.extents.at(id);
  int x = 0, y = 0;
  double nearest = 1e9;
  for (int py = extent.box.y0; py < extent.box.y1; ++py) {
    for (int px = extent.box.x0; px < extent.box.x1; ++px) {
      const double off =
          std::hypot(px - 0.5 * (extent.box.x0 + extent.box.x1), py - 0.5 * (extent.box.y0 + extent.box.y1));
      if (frame.idAt(px, py) == id && off < nearest) nearest = off, x = px, y = py;
    }
  }
  return {x, y};
}

std::size_t pixelsThatDiffer(const core::ImageRgba8& a, const core::ImageRgba8& b) {
  if (a.width() != b.width() || a.height() != b.height())
    return std::max(a.pixels().size(), b.pixels().size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.pixels().size(); ++i) count += a.pixels()[i] == b.pixels()[i] ? 0 : 1;
  return count;
}

std::size_t pixelsOf(const core::ImageRgba8& image, const core::Rgba8& color) {
  return static_cast<std::size_t>(std::count(image.pixels().begin(), image.pixels().end(), color));
}

}  // namespace saccade::tests
