#include "render/context/gl_context.h"

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <string>

#include "core/error.h"
#include "render/context/gl.h"

namespace saccade::render {

namespace {

/// The context that is current on this thread.
thread_local GlContext* currentHere = nullptr;

std::string glString(const Gl& gl, GLenum which) {
  const GLubyte* text = gl.GetString(which);
  return text ? reinterpret_cast<const char*>(text) : "unknown";
}

void APIENTRY keepMessage(GLenum, GLenum type, GLuint, GLenum, GLsizei, const GLchar* text, const void* gl) {
  if (type == GL_DEBUG_TYPE_ERROR) static_cast<const Gl*>(gl)->lastMessage = text;
}

/// Synchronous: the message comes on the GL thread, before checkGl asks for it.
void keepErrorMessages(const Gl& gl) {
  if (!gl.DebugMessageCallback || !gl.DebugMessageControl) return;
  gl.Enable(GL_DEBUG_OUTPUT);
  gl.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  gl.DebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_FALSE);
  gl.DebugMessageControl(GL_DONT_CARE, GL_DEBUG_TYPE_ERROR, GL_DONT_CARE, 0, nullptr, GL_TRUE);
  gl.DebugMessageCallback(keepMessage, &gl);
}

}  // namespace

void GlContext::makeCurrent() {
  if (currentHere == this) return;
  std::thread::id nobody{};
  if (!owner_.compare_exchange_strong(nobody, std::this_thread::get_id())) {
    throw core::Error("the " + name_ +
                      " OpenGL context is current on another thread; release it there first");
  }
  if (currentHere) currentHere->release();
  if (!bind()) {
    owner_ = std::thread::id{};
    throw core::Error("the " + name_ +
                      " OpenGL context cannot be made current: it was lost or is out of memory");
  }
  currentHere = this;
}

void GlContext::release() { releaseIfCurrent(); }

void GlContext::releaseIfCurrent() noexcept {
  if (currentHere != this) return;
  unbind();
  currentHere = nullptr;
  owner_ = std::thread::id{};
}

void GlContext::initialize() {
  makeCurrent();
  gl_ = std::make_shared<Gl>();
  const char* missing = nullptr;
#define SACCADE_GL_LOAD(type, function) \
  gl_->function = reinterpret_cast<PFNGL##type##PROC>(procAddress("gl" #function));
#define SACCADE_GL_NEED(type, function) \
  SACCADE_GL_LOAD(type, function)       \
  if (!gl_->function) missing = "gl" #function;
  SACCADE_GL_FUNCTIONS(SACCADE_GL_NEED)
#undef SACCADE_GL_NEED
  if (missing)
    throw core::Error("the " + name_ + " OpenGL context has no " + missing + "; OpenGL 4.5 is needed");

  GLint major = 0, minor = 0, texture = 0, viewport[2] = {0, 0};
  gl_->GetIntegerv(GL_MAJOR_VERSION, &major);
  gl_->GetIntegerv(GL_MINOR_VERSION, &minor);
  gl_->GetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
  gl_->GetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
  renderer_ = glString(*gl_, GL_RENDERER);
  version_ = glString(*gl_, GL_VERSION);
  const int version = 10 * major + minor;
  if (version < 45) {  // glClipControl
    throw core::Error("the " + name_ + " context offers OpenGL " + version_ + " (" + renderer_ +
                      "); 4.5 core is needed");
  }
  // Asked by version, because a function that the context does not have may still have an address.
#define SACCADE_GL_OFFER(since, type, function) \
  if (version >= (since)) SACCADE_GL_LOAD(type, function)
  SACCADE_GL_OPTIONAL_FUNCTIONS(SACCADE_GL_OFFER)
#undef SACCADE_GL_OFFER
#undef SACCADE_GL_LOAD
  keepErrorMessages(*gl_);
  maxSize_ = std::min({texture, viewport[0], viewport[1], kMaxImageSide});
  checkGl(*gl_, "making the context");
}

void setSoftwareRasterThreads(int threads) {
  constexpr int kKeepUsersValue = 0;
  setenv("LP_NUM_THREADS", std::to_string(std::max(threads, 0)).c_str(), kKeepUsersValue);
}

}  // namespace saccade::render
