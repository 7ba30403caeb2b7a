#include "tests/x_drop.h"

#include <X11/Xatom.h>

#include <cctype>
#include <cstdio>
#include <string_view>

namespace saccade::tests {

namespace {
constexpr long kVersion = 5;
constexpr long kAccepts = 1;  // bit 0 of XdndStatus
}  // namespace

std::string uriList(const std::vector<std::filesystem::path>& files) {
  std::string list;
  for (const std::filesystem::path& file : files) {
    list += "file://";
    for (const char c : file.string()) {
      const auto byte = static_cast<unsigned char>(c);
      char text[4] = {c, 0};
      if (!std::isalnum(byte) && std::string_view("/-._~").find(c) == std::string_view::npos)
        std::snprintf(text, sizeof text, "%%%02X", byte);
      list += text;
    }
    list += "\r\n";
  }
  return list;
}

XDrop::XDrop(Display* display)
    : display_(display),
      source_(XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0)) {}

XDrop::~XDrop() { XDestroyWindow(display_, source_); }

void XDrop::tell(const char* message, long second, long third, long fourth, long fifth) {
  XEvent event{};
  event.xclient = {.type = ClientMessage, .window = target_, .message_type = atom(message), .format = 32};
  event.xclient.data.l[0] = static_cast<long>(source_);
  event.xclient.data.l[1] = second;
  event.xclient.data.l[2] = third;
  event.xclient.data.l[3] = fourth;
  event.xclient.data.l[4] = fifth;
  XSendEvent(display_, target_, False, NoEventMask, &event);
  XFlush(display_);
}

void XDrop::begin(::Window target, const std::vector<std::filesystem::path>& files, int rootX, int rootY) {
  target_ = target;
  list_ = uriList(files);
  state_ = Drop::offered;
  XSetSelectionOwner(display_, atom("XdndSelection"), source_, CurrentTime);
  tell("XdndEnter", kVersion << 24, static_cast<long>(atom("text/uri-list")), 0, 0);
  tell("XdndPosition", 0, (static_cast<long>(rootX) << 16) | rootY, CurrentTime,
       static_cast<long>(atom("XdndActionCopy")));
}

void XDrop::handle(const XEvent& event) {
  if (event.type == SelectionRequest) return answer(event.xselectionrequest);
  if (event.type != ClientMessage || static_cast<::Window>(event.xclient.data.l[0]) != target_) return;
  const long flags = event.xclient.data.l[1];
  if (event.xclient.message_type == atom("XdndStatus") && state_ == Drop::offered) {
    const bool accepts = (flags & kAccepts) != 0;
    state_ = accepts ? Drop::dropped : Drop::refused;
    tell(accepts ? "XdndDrop" : "XdndLeave", 0, CurrentTime, 0, 0);
  } else if (event.xclient.message_type == atom("XdndFinished")) {
    // Bit 0 by the protocol; GLFW 3.3 says the length of the list instead.
    state_ = flags != 0 ? Drop::accepted : Drop::refused;
  }
}

/// The files, to whom asks for them in the one form that was offered; nothing otherwise (ICCCM 2.2).
void XDrop::answer(const XSelectionRequestEvent& request) {
  const bool known = request.target == atom("text/uri-list");
  if (known) {
    XChangeProperty(display_, request.requestor, request.property, request.target, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(list_.data()), static_cast<int>(list_.size()));
  }
  XEvent event{};
  event.xselection = {.type = SelectionNotify,
                      .requestor = request.requestor,
                      .selection = request.selection,
                      .target = request.target,
                      .property = known ? request.property : Atom{None},
                      .time = request.time};
  XSendEvent(display_, request.requestor, False, NoEventMask, &event);
  XFlush(display_);
}

}  // namespace saccade::tests
