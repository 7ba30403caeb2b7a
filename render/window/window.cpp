#include "render/window/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "core/error.h"
#include "render/context/gl.h"
#include "render/window/read_pixels.h"

namespace saccade::render {

namespace {

/// GLFW's last complaint, for the error line.
std::string glfwReason() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? std::string(" (") + text + ")" : "";
}

/// GLFW itself, for the life of the one window.
struct Library {
  Library() {
    if (glfwInit() == GLFW_TRUE) return;
    throw core::Error(
        "no window can be opened: no display was found" + glfwReason() +
        "; set DISPLAY or WAYLAND_DISPLAY, run under xvfb-run, or work off screen with --headless");
  }
  ~Library() { glfwTerminate(); }
};

Key rangeKey(int code, int first, int last, Key key) {
  if (code < first || code > last) return Key::unknown;
  return static_cast<Key>(static_cast<int>(key) + code - first);
}

Key keyOf(int code) {
  for (const Key key :
       {rangeKey(code, GLFW_KEY_A, GLFW_KEY_Z, Key::a), rangeKey(code, GLFW_KEY_0, GLFW_KEY_9, Key::digit0),
        rangeKey(code, GLFW_KEY_F1, GLFW_KEY_F12, Key::f1)}) {
    if (key != Key::unknown) return key;
  }
  static const std::map<int, Key> others{{GLFW_KEY_LEFT, Key::left},
                                         {GLFW_KEY_RIGHT, Key::right},
                                         {GLFW_KEY_UP, Key::up},
                                         {GLFW_KEY_DOWN, Key::down},
                                         {GLFW_KEY_PAGE_UP, Key::pageUp},
                                         {GLFW_KEY_PAGE_DOWN, Key::pageDown},
                                         {GLFW_KEY_HOME, Key::home},
                                         {GLFW_KEY_END, Key::end},
                                         {GLFW_KEY_SPACE, Key::space},
                                         {GLFW_KEY_LEFT_SHIFT, Key::shift},
                                         {GLFW_KEY_RIGHT_SHIFT, Key::shift},
                                         {GLFW_KEY_LEFT_CONTROL, Key::control},
                                         {GLFW_KEY_LEFT_ALT, Key::alt},
                                         {GLFW_KEY_RIGHT_CONTROL, Key::control},
                                         {GLFW_KEY_RIGHT_ALT, Key::alt},
                                         {GLFW_KEY_ESCAPE, Key::escape},
                                         {GLFW_KEY_ENTER, Key::enter},
                                         {GLFW_KEY_KP_ENTER, Key::enter},
                                         {GLFW_KEY_TAB, Key::tab},
                                         {GLFW_KEY_BACKSPACE, Key::backspace},
                                         {GLFW_KEY_DELETE, Key::remove},
                                         {GLFW_KEY_EQUAL, Key::plus},
                                         {GLFW_KEY_KP_ADD, Key::plus},
                                         {GLFW_KEY_MINUS, Key::minus},
                                         {GLFW_KEY_KP_SUBTRACT, Key::minus}};
  const auto found = others.find(code);
  return found == others.end() ? Key::unknown : found->second;
}

GLFWwindow* openWindow(int width, int height, const std::string& title) {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  GLFWwindow* window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (window) return window;
  throw core::Error(
      "no window with OpenGL 4.5 core can be opened" + glfwReason() +
      "; install a graphics driver (libgl1-mesa-dri has a software one) or work off screen with "
      "--headless");
}

class WindowContext final : public GlContext {
 public:
  explicit WindowContext(GLFWwindow* window) : GlContext("window"), window_(window) { initialize(); }
  ~WindowContext() override { releaseIfCurrent(); }

 private:
  bool bind() noexcept override {
    glfwMakeContextCurrent(window_);
    return glfwGetCurrentContext() == window_;
  }
  void unbind() noexcept override { glfwMakeContextCurrent(nullptr); }
  void* procAddress(const char* function) noexcept override {
    return reinterpret_cast<void*>(glfwGetProcAddress(function));
  }
  GLFWwindow* window_;
};

struct WindowDeleter {
  void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};

}  // namespace

struct Window::State {
  State(int width, int height, const std::string& title)
      : window(openWindow(width, height, title)), context(window.get()) {}

  // In the order of construction; the context lets go before the window dies, GLFW last.
  Library library;
  std::unique_ptr<GLFWwindow, WindowDeleter> window;
  WindowContext context;
  std::vector<Event> events;
  std::array<bool, static_cast<std::size_t>(Key::count)> down{};
  core::Vec2 lastMouse{0};
  bool mouseKnown = false;
  std::array<int, 4> windowedRect{};  ///< x, y, width, height before fullscreen, screen coordinates

  static State& of(GLFWwindow* window) { return *static_cast<State*>(glfwGetWindowUserPointer(window)); }
  core::Vec2 toPixels(double x, double y) const;
  void installCallbacks();
  void key(int code, int action);
  void mouseButton(int code, int action);
  void mouseMove(double x, double y);
};

/// GLFW reports the mouse in screen coordinates, which are not pixels on every display.
core::Vec2 Window::State::toPixels(double x, double y) const {
  int width = 0, height = 0, widthPx = 0, heightPx = 0;
  glfwGetWindowSize(window.get(), &width, &height);
  glfwGetFramebufferSize(window.get(), &widthPx, &heightPx);
  if (width == 0 || height == 0) return {static_cast<float>(x), static_cast<float>(y)};
  return {static_cast<float>(x * widthPx / width), static_cast<float>(y * heightPx / height)};
}

void Window::State::key(int code, int action) {
  const Key key = keyOf(code);
  down[static_cast<std::size_t>(key)] = action != GLFW_RELEASE;
  events.push_back(KeyEvent{key, action != GLFW_RELEASE, action == GLFW_REPEAT});
}

void Window::State::mouseButton(int code, int action) {
  if (code > GLFW_MOUSE_BUTTON_MIDDLE) return;
  double x = 0, y = 0;
  glfwGetCursorPos(window.get(), &x, &y);
  events.push_back(MouseButtonEvent{static_cast<MouseButton>(code), action == GLFW_PRESS, toPixels(x, y)});
}

void Window::State::mouseMove(double x, double y) {
  const core::Vec2 position = toPixels(x, y);
  const core::Vec2 delta = mouseKnown ? position - lastMouse : core::Vec2(0);
  lastMouse = position;
  mouseKnown = true;
  events.push_back(MouseMoveEvent{position, delta});
}

void Window::State::installCallbacks() {
  GLFWwindow* w = window.get();
  glfwSetWindowUserPointer(w, this);
  glfwSetKeyCallback(w, [](GLFWwindow* at, int code, int, int action, int) { of(at).key(code, action); });
  glfwSetMouseButtonCallback(
      w, [](GLFWwindow* at, int code, int action, int) { of(at).mouseButton(code, action); });
  glfwSetCursorPosCallback(w, [](GLFWwindow* at, double x, double y) { of(at).mouseMove(x, y); });
  glfwSetScrollCallback(w, [](GLFWwindow* at, double x, double y) {
    of(at).events.push_back(ScrollEvent{{static_cast<float>(x), static_cast<float>(y)}});
  });
  glfwSetFramebufferSizeCallback(w, [](GLFWwindow* at, int width, int height) {
    of(at).events.push_back(ResizeEvent{width, height});
  });
  glfwSetWindowCloseCallback(w, [](GLFWwindow* at) { of(at).events.push_back(CloseEvent{}); });
  glfwSetDropCallback(w, [](GLFWwindow* at, int count, const char** files) {
    of(at).events.push_back(DropEvent{std::vector<std::filesystem::path>(files, files + count)});
  });
}

float displayScale() {
  const Library library;
  float x = 1, y = 1;
  if (GLFWmonitor* monitor = glfwGetPrimaryMonitor()) glfwGetMonitorContentScale(monitor, &x, &y);
  return std::clamp(std::max(x, y), 0.5f, 4.0f);
}

Window::Window(int width, int height, const std::string& title)
    : state_(std::make_unique<State>(width, height, title)) {
  state_->installCallbacks();
  setVsync(false);
}
Window::~Window() = default;

GlContext& Window::context() { return state_->context; }
GLFWwindow* Window::handle() { return state_->window.get(); }

std::vector<Event> Window::pollEvents() {
  glfwPollEvents();
  return std::exchange(state_->events, {});
}

bool Window::isDown(Key key) const { return state_->down[static_cast<std::size_t>(key)]; }
bool Window::isDown(MouseButton button) const {
  return glfwGetMouseButton(state_->window.get(), static_cast<int>(button)) == GLFW_PRESS;
}

int Window::width() const {
  int width = 0;
  glfwGetFramebufferSize(state_->window.get(), &width, nullptr);
  return width;
}
int Window::height() const {
  int height = 0;
  glfwGetFramebufferSize(state_->window.get(), nullptr, &height);
  return height;
}

void Window::setTitle(const std::string& title) { glfwSetWindowTitle(state_->window.get(), title.c_str()); }

void Window::setVsync(bool on) {
  state_->context.makeCurrent();
  glfwSwapInterval(on ? 1 : 0);
}

void Window::setMouseCaptured(bool captured) {
  GLFWwindow* w = state_->window.get();
  glfwSetInputMode(w, GLFW_CURSOR, captured ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
  if (glfwRawMouseMotionSupported()) glfwSetInputMode(w, GLFW_RAW_MOUSE_MOTION, captured ? 1 : 0);
  // The pointer jumps: the next move starts anew.
  state_->mouseKnown = false;
}
bool Window::mouseCaptured() const {
  return glfwGetInputMode(state_->window.get(), GLFW_CURSOR) == GLFW_CURSOR_DISABLED;
}

void Window::setFullscreen(bool on) {
  if (on == fullscreen()) return;
  GLFWwindow* w = state_->window.get();
  auto& rect = state_->windowedRect;
  if (!on) {
    glfwSetWindowMonitor(w, nullptr, rect[0], rect[1], rect[2], rect[3], GLFW_DONT_CARE);
    return;
  }
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
  if (!mode) return;
  glfwGetWindowPos(w, &rect[0], &rect[1]);
  glfwGetWindowSize(w, &rect[2], &rect[3]);
  glfwSetWindowMonitor(w, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}
std::array<int, 2> Window::windowedSize() const {
  if (fullscreen()) return {state_->windowedRect[2], state_->windowedRect[3]};
  std::array<int, 2> size{};
  glfwGetWindowSize(state_->window.get(), &size[0], &size[1]);
  return size;
}
bool Window::fullscreen() const { return glfwGetWindowMonitor(state_->window.get()) != nullptr; }

void Window::swap() { glfwSwapBuffers(state_->window.get()); }

void Window::bind() {
  state_->context.makeCurrent();
  state_->context.gl().BindFramebuffer(GL_FRAMEBUFFER, 0);
}

core::ImageRgba8 Window::screenshot() {
  bind();
  const Gl& gl = state_->context.gl();
  core::ImageRgba8 image = readRgba8(gl, width(), height());
  checkGl(gl, "taking a screenshot");
  return image;
}

}  // namespace saccade::render
