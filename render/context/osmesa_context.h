// Mesa in this process, drawing to memory: no window system, no device.
#pragma once

#include <memory>

#include "render/context/gl_context.h"

namespace saccade::render {

/// Current on the calling thread. Throws core::Error.
std::unique_ptr<GlContext> makeOsmesaContext();

}  // namespace saccade::render
