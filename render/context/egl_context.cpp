// EGL without a surface. EGL_DEFAULT_DISPLAY is not asked: without a display server it fails.
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "core/error.h"
#include "render/context/gl_context.h"

namespace saccade::render {

namespace {

bool hasWord(const char* list, const std::string& word) {
  std::istringstream words(list ? list : "");
  return std::find(std::istream_iterator<std::string>(words), {}, word) !=
         std::istream_iterator<std::string>();
}

template <class Function>
Function eglFunction(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

[[noreturn]] void failEgl(const std::string& what) {
  throw core::Error("EGL: " + what + "; try --context osmesa");
}

EGLDisplay surfacelessDisplay() {
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const auto getDisplay = eglFunction<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (!hasWord(client, "EGL_MESA_platform_surfaceless") || !getDisplay) {
    failEgl("no surfaceless platform (EGL_MESA_platform_surfaceless)");
  }
  return getDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
}

std::vector<EGLDisplay> deviceDisplays() {
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const auto getDisplay = eglFunction<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  const auto queryDevices = eglFunction<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  const bool offered = hasWord(client, "EGL_EXT_platform_device") && getDisplay && queryDevices;
  EGLint count = 0;
  if (!offered || !queryDevices(0, nullptr, &count) || count < 1) {
    failEgl("no devices (EGL_EXT_platform_device)");
  }
  std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
  queryDevices(count, devices.data(), &count);
  devices.resize(static_cast<std::size_t>(count));
  std::vector<EGLDisplay> displays;
  displays.reserve(devices.size());
  for (EGLDeviceEXT device : devices) {
    displays.push_back(getDisplay(EGL_PLATFORM_DEVICE_EXT, device, nullptr));
  }
  return displays;
}

class EglContext final : public GlContext {
 public:
  explicit EglContext(EGLDisplay display) : GlContext("egl"), display_(display) {
    EGLint major = 0, minor = 0;
    if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, &major, &minor)) {
      failEgl("the display does not initialise");
    }
    const char* offered = eglQueryString(display_, EGL_EXTENSIONS);
    if (!hasWord(offered, "EGL_KHR_surfaceless_context")) {
      failEgl("no EGL_KHR_surfaceless_context");
    }
    createContext();
    try {
      initialize();
    } catch (...) {
      destroy();
      throw;
    }
  }
  ~EglContext() override { destroy(); }

 private:
  void createContext() {
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglBindAPI(EGL_OPENGL_API) || !eglChooseConfig(display_, wanted, &config, 1, &count) || count < 1) {
      failEgl("no configuration for desktop OpenGL");
    }
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 4,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 5,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
    context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, attributes);
    if (context_ == EGL_NO_CONTEXT) failEgl("no OpenGL 4.5 core context");
  }
  bool bind() noexcept override {
    // The API binding is per thread, and this may be another thread than the one that made the context.
    eglBindAPI(EGL_OPENGL_API);
    return eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE;
  }
  void unbind() noexcept override {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  void* procAddress(const char* function) noexcept override {
    return reinterpret_cast<void*>(eglGetProcAddress(function));
  }
  // The display is not terminated: EGL hands the same one to every caller, and another context may use it.
  void destroy() noexcept {
    releaseIfCurrent();
    eglDestroyContext(display_, context_);
  }

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

/// The first device that offers a context; reports the last one's reason when none does.
std::unique_ptr<GlContext> firstDeviceContext() {
  std::string reason = "no device";
  for (EGLDisplay display : deviceDisplays()) {
    try {
      return std::make_unique<EglContext>(display);
    } catch (const core::Error& error) {
      reason = error.what();
    }
  }
  throw core::Error(reason);
}

}  // namespace

std::unique_ptr<GlContext> makeEglContext(EglPlatform platform) {
  if (platform == EglPlatform::device) return firstDeviceContext();
  try {
    return std::make_unique<EglContext>(surfacelessDisplay());
  } catch (const core::Error&) {
    if (platform == EglPlatform::surfaceless) throw;
  }
  return firstDeviceContext();
}

}  // namespace saccade::render
