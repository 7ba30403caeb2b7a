// An OpenGL 4.5 core context, on screen or off, behind one face: off screen is the same program with another
// context. One thread owns a context while it is current there.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>

namespace saccade::render {

struct Gl;

enum class ContextKind {
  osmesa,  ///< Mesa in this process, no window system at all
  egl      ///< EGL without a surface: Mesa's surfaceless platform, else the first usable device
};

class GlContext {
 public:
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;
  virtual ~GlContext() = default;

  /// Makes the context current on the calling thread; another context of this program that is current here
  /// is released first (they may share a dispatch table). Cheap when it is current already. Throws
  /// core::Error when it is current on another thread: OSMesa itself would accept that and race.
  void makeCurrent();
  /// Makes nothing current on this thread, so that another may take the context. Owning thread only.
  void release();

  /// Functions of this context. Only render/ looks inside (render/context/gl.h).
  const Gl& gl() const { return *gl_; }
  /// "osmesa", "egl" or "window".
  const std::string& name() const { return name_; }
  /// GL_RENDERER and GL_VERSION, for statistics. Any thread.
  const std::string& renderer() const { return renderer_; }
  const std::string& version() const { return version_; }
  /// Largest width and height of an image that can be drawn, pixels. Any thread.
  int maxSize() const { return maxSize_; }

 protected:
  explicit GlContext(std::string name) : name_(std::move(name)) {}
  /// Called once by the constructor of a derived class: makes current, loads the table, checks for 4.5.
  void initialize();
  /// Called first by every derived destructor. A context that is current on another thread stays there.
  void releaseIfCurrent() noexcept;

  virtual bool bind() noexcept = 0;
  virtual void unbind() noexcept = 0;
  virtual void* procAddress(const char* function) noexcept = 0;

 private:
  std::string name_, renderer_, version_;
  int maxSize_ = 0;
  std::shared_ptr<Gl> gl_;
  std::atomic<std::thread::id> owner_{};
};

/// Largest image side in any context: OSMesa accepts more and then fails.
inline constexpr int kMaxImageSide = 16384;

/// A context without a window, current on the calling thread. Throws core::Error saying what is missing and
/// which context to try instead.
std::unique_ptr<GlContext> makeHeadlessContext(ContextKind kind);

/// Which way EGL is asked; `any` tries them in this order. EGL_DEFAULT_DISPLAY is not used: it fails without
/// a display.
enum class EglPlatform { any, surfaceless, device };
std::unique_ptr<GlContext> makeEglContext(EglPlatform platform);

/// Threads of Mesa's software rasteriser besides the calling one (0 = rasterise in the calling thread), for
/// contexts made later in this process: call before the first one, from the only thread. A LP_NUM_THREADS set
/// by the user wins. Does nothing to hardware drivers.
void setSoftwareRasterThreads(int threads);

}  // namespace saccade::render
