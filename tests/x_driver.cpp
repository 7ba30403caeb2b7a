#include "tests/x_driver.h"

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/XTest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tests/x_drop.h"

namespace saccade::tests {

namespace {

using namespace std::chrono_literals;

struct DisplayCloser {
  void operator()(Display* display) const { XCloseDisplay(display); }
};
using DisplayPtr = std::unique_ptr<Display, DisplayCloser>;

/// A property's value: 8-bit items as they are, 32-bit ones as the longs in which Xlib hands them out.
std::string property(Display* display, ::Window window, const char* name) {
  Atom type = None;
  int format = 0;
  unsigned long count = 0, left = 0;
  unsigned char* data = nullptr;
  XGetWindowProperty(display, window, XInternAtom(display, name, False), 0, 4096, False, AnyPropertyType,
                     &type, &format, &count, &left, &data);
  std::string value;
  if (data) {
    value.assign(reinterpret_cast<const char*>(data), count * (format == 32 ? sizeof(long) : 1));
    XFree(data);
  }
  return value;
}

std::optional<long> number(const std::string& value) {
  if (value.size() != sizeof(long)) return std::nullopt;
  long n = 0;
  std::copy(value.begin(), value.end(), reinterpret_cast<char*>(&n));
  return n;
}

bool isViewable(Display* display, ::Window window) {
  XWindowAttributes attributes{};
  return XGetWindowAttributes(display, window, &attributes) && attributes.map_state == IsViewable;
}

/// Without a window manager every window is a child of the root.
::Window findWindow(Display* display, const std::string& titleStart, pid_t process) {
  ::Window root = 0, parent = 0, found = 0;
  ::Window* children = nullptr;
  unsigned int count = 0;
  if (!XQueryTree(display, DefaultRootWindow(display), &root, &parent, &children, &count)) return 0;
  for (unsigned int i = 0; i < count && !found; ++i) {
    if (number(property(display, children[i], "_NET_WM_PID")) == process &&
        property(display, children[i], "_NET_WM_NAME").starts_with(titleStart) &&
        isViewable(display, children[i]))
      found = children[i];
  }
  if (children) XFree(children);
  return found;
}

Display* driversDisplay = nullptr;
XErrorHandler othersHandler = nullptr;
std::string lastError;

int noteError(Display* display, XErrorEvent* error) {
  if (display != driversDisplay) return othersHandler ? othersHandler(display, error) : 0;
  char text[256] = {};
  XGetErrorText(display, error->error_code, text, sizeof text);
  lastError = "the X server answered request " + std::to_string(error->request_code) + " with: " + text;
  return 0;
}

}  // namespace

std::string cannotDrive() {
  const DisplayPtr display(XOpenDisplay(nullptr));
  if (!display) return "no display (DISPLAY is unset or its server does not answer): run under xvfb-run";
  if (number(property(display.get(), DefaultRootWindow(display.get()), "_NET_SUPPORTING_WM_CHECK")))
    return "a window manager runs on this display; tests press no keys there: run under xvfb-run";
  return "";
}

struct XDriver::State {
  explicit State(Display* d) : display(d), drop(d) {}
  DisplayPtr display;
  XDrop drop;
  ::Window window = 0;

  Display* get() const { return display.get(); }
  ::Window root() const { return DefaultRootWindow(display.get()); }
  void sync() const {
    XSync(get(), False);
    if (!lastError.empty()) throw std::runtime_error(std::exchange(lastError, {}));
  }
  /// Where a point of the window is on the screen.
  std::pair<int, int> onScreen(int x, int y) const {
    ::Window child = 0;
    int rootX = 0, rootY = 0;
    XTranslateCoordinates(get(), window, root(), x, y, &rootX, &rootY, &child);
    return {rootX, rootY};
  }
  void key(const std::string& name, bool down) const {
    const KeySym symbol = XStringToKeysym(name.c_str());
    const KeyCode code = symbol == NoSymbol ? 0 : XKeysymToKeycode(get(), symbol);
    if (code == 0) throw std::runtime_error("no key " + name + " on this keyboard");
    XTestFakeKeyEvent(get(), code, down ? True : False, CurrentTime);
    sync();
  }
  void button(int n, bool down) const {
    XTestFakeButtonEvent(get(), static_cast<unsigned>(n), down ? True : False, CurrentTime);
    sync();
  }
};

XDriver::XDriver(const std::string& titleStart, pid_t process) {
  Display* display = XOpenDisplay(nullptr);
  if (!display) throw std::runtime_error("no display");
  state_ = std::make_unique<State>(display);
  driversDisplay = display;
  othersHandler = XSetErrorHandler(noteError);
  for (const auto end = std::chrono::steady_clock::now() + 60s; !state_->window;) {
    state_->window = findWindow(display, titleStart, process);
    lastError.clear();  // other programs' windows come and go between two requests
    if (state_->window) break;
    if (std::chrono::steady_clock::now() > end) throw std::runtime_error("no window titled " + titleStart);
    std::this_thread::sleep_for(20ms);
  }
  focus();
}

XDriver::~XDriver() {
  XSync(state_->get(), False);
  lastError.clear();
  XSetErrorHandler(othersHandler);
}

void XDriver::focus() {
  XRaiseWindow(state_->get(), state_->window);
  XSetInputFocus(state_->get(), state_->window, RevertToParent, CurrentTime);
  state_->sync();
}

std::string XDriver::title() const { return property(state_->get(), state_->window, "_NET_WM_NAME"); }

void XDriver::keyDown(const std::string& key) { state_->key(key, true); }
void XDriver::keyUp(const std::string& key) { state_->key(key, false); }
void XDriver::press(const std::string& key) {
  keyDown(key);
  keyUp(key);
}

void XDriver::moveTo(int x, int y) {
  const auto [rootX, rootY] = state_->onScreen(x, y);
  XTestFakeMotionEvent(state_->get(), DefaultScreen(state_->get()), rootX, rootY, CurrentTime);
  state_->sync();
}

void XDriver::moveBy(int dx, int dy) {
  XTestFakeRelativeMotionEvent(state_->get(), dx, dy, CurrentTime);
  state_->sync();
}

void XDriver::buttonDown(int button) { state_->button(button, true); }
void XDriver::buttonUp(int button) { state_->button(button, false); }

void XDriver::click(int x, int y, int button) {
  moveTo(x, y);
  buttonDown(button);
  buttonUp(button);
}

void XDriver::wheel(int steps) {
  const int button = steps > 0 ? 4 : 5;  // X has the wheel as two buttons
  for (int i = 0; i < std::abs(steps); ++i) {
    buttonDown(button);
    buttonUp(button);
  }
}

void XDriver::resize(int width, int height) {
  XResizeWindow(state_->get(), state_->window, static_cast<unsigned>(width), static_cast<unsigned>(height));
  state_->sync();
}

void XDriver::placeAt(int x, int y) {
  XMoveWindow(state_->get(), state_->window, x, y);
  state_->sync();
}

std::array<int, 4> XDriver::place() const {
  XWindowAttributes attributes{};
  XGetWindowAttributes(state_->get(), state_->window, &attributes);
  const auto [x, y] = state_->onScreen(0, 0);
  return {x, y, attributes.width, attributes.height};
}

void XDriver::close() {
  XEvent event{};
  event.xclient = {.type = ClientMessage,
                   .window = state_->window,
                   .message_type = XInternAtom(state_->get(), "WM_PROTOCOLS", False),
                   .format = 32};
  event.xclient.data.l[0] = static_cast<long>(XInternAtom(state_->get(), "WM_DELETE_WINDOW", False));
  XSendEvent(state_->get(), state_->window, False, NoEventMask, &event);
  state_->sync();
}

void XDriver::beginDrop(const std::vector<std::filesystem::path>& files, int x, int y) {
  moveTo(x, y);
  const auto [rootX, rootY] = state_->onScreen(x, y);
  state_->drop.begin(state_->window, files, rootX, rootY);
  state_->sync();
}

Drop XDriver::drop() {
  while (XPending(state_->get()) > 0) {
    XEvent event;
    XNextEvent(state_->get(), &event);
    state_->drop.handle(event);
  }
  state_->sync();
  return state_->drop.state();
}

core::ImageRgba8 XDriver::screen() const {
  XWindowAttributes at{}, whole{};
  XGetWindowAttributes(state_->get(), state_->window, &at);
  XGetWindowAttributes(state_->get(), state_->root(), &whole);
  const auto [left, top] = state_->onScreen(0, 0);
  const int width = std::min(at.width, whole.width - left), height = std::min(at.height, whole.height - top);
  core::ImageRgba8 picture(width, height);
  XImage* image = XGetImage(state_->get(), state_->root(), left, top, static_cast<unsigned>(width),
                            static_cast<unsigned>(height), AllPlanes, ZPixmap);
  if (!image) throw std::runtime_error("the screen cannot be read");
  const auto channel = [](unsigned long pixel, unsigned long mask) {
    return static_cast<std::uint8_t>(255 * ((pixel & mask) / (mask & (~mask + 1))) /
                                     (mask / (mask & (~mask + 1))));
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const unsigned long pixel = XGetPixel(image, x, y);
      picture.at(x, y) = {channel(pixel, image->red_mask), channel(pixel, image->green_mask),
                          channel(pixel, image->blue_mask), 255};
    }
  }
  XDestroyImage(image);
  return picture;
}

struct XResources::State {
  DisplayPtr display;  ///< open until the end: a server may reset once its last client has gone
  std::string before;

  void set(const std::string& text) const {
    XChangeProperty(display.get(), DefaultRootWindow(display.get()), XA_RESOURCE_MANAGER, XA_STRING, 8,
                    PropModeReplace, reinterpret_cast<const unsigned char*>(text.data()),
                    static_cast<int>(text.size()));
    XSync(display.get(), False);
  }
};

XResources::XResources(const std::string& text) {
  DisplayPtr display(XOpenDisplay(nullptr));
  if (!display) throw std::runtime_error("no display");
  std::string before = property(display.get(), DefaultRootWindow(display.get()), "RESOURCE_MANAGER");
  state_ = std::make_unique<State>(State{std::move(display), std::move(before)});
  state_->set(text);
}

XResources::~XResources() { state_->set(state_->before); }

}  // namespace saccade::tests
