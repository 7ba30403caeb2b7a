// The source's side of XDND, version 5 (freedesktop.org, "Drag-and-Drop Protocol for the X Window System"):
// files as text/uri-list.
#pragma once

#include <X11/Xlib.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/x_driver.h"

namespace saccade::tests {

/// As file: URIs (RFC 3986: all but unreserved characters and '/' percent-encoded), each line ended by CRLF.
std::string uriList(const std::vector<std::filesystem::path>& files);

/// The connection must outlive it.
class XDrop {
 public:
  explicit XDrop(Display* display);
  ~XDrop();
  XDrop(const XDrop&) = delete;
  XDrop& operator=(const XDrop&) = delete;

  /// The pointer carries the files onto the target, at a place of the root window.
  void begin(::Window target, const std::vector<std::filesystem::path>& files, int rootX, int rootY);
  /// One event of the connection: status, request for the files, or finished.
  void handle(const XEvent& event);
  Drop state() const { return state_; }

 private:
  Atom atom(const char* name) const { return XInternAtom(display_, name, False); }
  void tell(const char* message, long second, long third, long fourth, long fifth);
  void answer(const XSelectionRequestEvent& request);

  Display* display_;
  ::Window source_;
  ::Window target_ = 0;
  std::string list_;
  Drop state_ = Drop::none;
};

}  // namespace saccade::tests
