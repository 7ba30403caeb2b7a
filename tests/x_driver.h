// A person at the display, for tests: keys, mouse, window sizes and files dropped, sent to a window as X
// events by a client of its own (XTest, XDND), and what the screen then shows.
#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/image.h"

namespace saccade::tests {

/// Why no test may drive a display here, empty where one may: there is none, or a window manager runs on it,
/// which means that it is somebody's desktop, whose keys and mouse are not a test's to press.
std::string cannotDrive();

#define SACCADE_NEEDS_A_DISPLAY_TO_DRIVE() \
  if (const std::string reason = ::saccade::tests::cannotDrive(); !reason.empty()) GTEST_SKIP() << reason

/// How far the drop that was begun last has come.
enum class Drop { none, offered, dropped, accepted, refused };

/// Has its own connection. One at a time, used by one thread at a time. Events are on their way to the window
/// when a function returns. Throws std::runtime_error with the X server's error.
class XDriver {
 public:
  /// The window of this process whose title starts so. Waits for it to appear, for at most a minute.
  explicit XDriver(const std::string& titleStart, pid_t process = ::getpid());
  ~XDriver();
  XDriver(const XDriver&) = delete;
  XDriver& operator=(const XDriver&) = delete;

  /// Gives the window the keyboard, as a window manager would on a click.
  void focus();
  std::string title() const;

  /// By keysym name ("w", "Left", "F12", "Shift_L").
  void keyDown(const std::string& key);
  void keyUp(const std::string& key);
  void press(const std::string& key);

  void moveTo(int x, int y);    ///< pixels of the window, y down
  void moveBy(int dx, int dy);  ///< as a mouse does, wherever the pointer is
  void buttonDown(int button);  ///< 1 left, 2 middle, 3 right
  void buttonUp(int button);
  void click(int x, int y, int button = 1);
  void wheel(int steps);  ///< > 0: away from the user

  void resize(int width, int height);
  void placeAt(int x, int y);  ///< pixels of the screen
  /// {x, y, width, height} in pixels of the screen, as the X server has them now.
  std::array<int, 4> place() const;
  void close();  ///< the window manager's button: WM_DELETE_WINDOW

  /// Drags the files from another program (XDND version 5) to a place of the window. The rest happens as the
  /// window answers: call `drop` again and again, in turn with what handles the window's events.
  void beginDrop(const std::vector<std::filesystem::path>& files, int x, int y);
  Drop drop();

  /// The part of the screen where the window is, as it is now.
  core::ImageRgba8 screen() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The display's resources, as `xrdb` sets them, until the end; what was there before comes back. Programs
/// read them when they start: "Xft.dpi:\t192\n" is a display of twice the usual density.
class XResources {
 public:
  explicit XResources(const std::string& text);
  ~XResources();
  XResources(const XResources&) = delete;
  XResources& operator=(const XResources&) = delete;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace saccade::tests
