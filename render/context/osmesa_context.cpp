#include "render/context/osmesa_context.h"

#include <GL/osmesa.h>

#include <cstdint>
#include <vector>

#include "core/error.h"

namespace saccade::render {

namespace {

class OsmesaContext final : public GlContext {
 public:
  OsmesaContext() : GlContext("osmesa") {
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              4,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              5,
                              0};
    context_ = OSMesaCreateContextAttribs(attributes, nullptr);
    if (!context_) {
      throw core::Error("OSMesa makes no OpenGL 4.5 core context (libosmesa6 too old?); try --context egl");
    }
    try {
      initialize();
    } catch (...) {
      destroy();
      throw;
    }
  }
  ~OsmesaContext() override { destroy(); }

 private:
  bool bind() noexcept override {
    return OSMesaMakeCurrent(context_, defaultFramebuffer_.data(), GL_UNSIGNED_BYTE, kSide, kSide) == GL_TRUE;
  }
  void unbind() noexcept override { OSMesaMakeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }
  void* procAddress(const char* function) noexcept override {
    return reinterpret_cast<void*>(OSMesaGetProcAddress(function));
  }
  void destroy() noexcept {
    releaseIfCurrent();
    OSMesaDestroyContext(context_);
  }

  // OSMesa cannot be current without a buffer. Everything is drawn into framebuffer objects, so a small one
  // of fixed size serves, and its unchecked limit of 16384 is never near.
  static constexpr int kSide = 16;
  std::vector<std::uint8_t> defaultFramebuffer_ = std::vector<std::uint8_t>(std::size_t{4} * kSide * kSide);
  OSMesaContext context_ = nullptr;
};

}  // namespace

std::unique_ptr<GlContext> makeOsmesaContext() { return std::make_unique<OsmesaContext>(); }

std::unique_ptr<GlContext> makeHeadlessContext(ContextKind kind) {
  return kind == ContextKind::osmesa ? makeOsmesaContext() : makeEglContext(EglPlatform::any);
}

}  // namespace saccade::render
