// The OpenGL functions of the program, as a table filled through the current context's own GetProcAddress.
// No gl* symbol is linked: libGL loaded before libOSMesa would make every call a silent no-op. Only render/
// includes this header.
#pragma once

#include <GL/glcorearb.h>

#include <string>

namespace saccade::render {

// X(type name between PFNGL and PROC, function name without gl). OpenGL 4.5 core.
#define SACCADE_GL_FUNCTIONS(X)                       \
  X(ACTIVETEXTURE, ActiveTexture)                     \
  X(ATTACHSHADER, AttachShader)                       \
  X(BINDBUFFER, BindBuffer)                           \
  X(BINDFRAMEBUFFER, BindFramebuffer)                 \
  X(BINDTEXTURE, BindTexture)                         \
  X(BINDVERTEXARRAY, BindVertexArray)                 \
  X(BLENDEQUATION, BlendEquation)                     \
  X(BLENDFUNCSEPARATE, BlendFuncSeparate)             \
  X(BUFFERDATA, BufferData)                           \
  X(BUFFERSUBDATA, BufferSubData)                     \
  X(CHECKFRAMEBUFFERSTATUS, CheckFramebufferStatus)   \
  X(CLEARBUFFERFV, ClearBufferfv)                     \
  X(CLIPCONTROL, ClipControl)                         \
  X(COMPILESHADER, CompileShader)                     \
  X(CREATEPROGRAM, CreateProgram)                     \
  X(CREATESHADER, CreateShader)                       \
  X(CULLFACE, CullFace)                               \
  X(DELETEBUFFERS, DeleteBuffers)                     \
  X(DELETEFRAMEBUFFERS, DeleteFramebuffers)           \
  X(DELETEPROGRAM, DeleteProgram)                     \
  X(DELETESHADER, DeleteShader)                       \
  X(DELETETEXTURES, DeleteTextures)                   \
  X(DELETEVERTEXARRAYS, DeleteVertexArrays)           \
  X(DEPTHFUNC, DepthFunc)                             \
  X(DEPTHMASK, DepthMask)                             \
  X(DISABLE, Disable)                                 \
  X(DRAWARRAYS, DrawArrays)                           \
  X(DRAWELEMENTS, DrawElements)                       \
  X(DRAWELEMENTSBASEVERTEX, DrawElementsBaseVertex)   \
  X(ENABLE, Enable)                                   \
  X(ENABLEVERTEXATTRIBARRAY, EnableVertexAttribArray) \
  X(FINISH, Finish)                                   \
  X(FRAMEBUFFERTEXTURE2D, FramebufferTexture2D)       \
  X(FRONTFACE, FrontFace)                             \
  X(GENBUFFERS, GenBuffers)                           \
  X(GENERATEMIPMAP, GenerateMipmap)                   \
  X(GENFRAMEBUFFERS, GenFramebuffers)                 \
  X(GENTEXTURES, GenTextures)                         \
  X(GENVERTEXARRAYS, GenVertexArrays)                 \
  X(GETERROR, GetError)                               \
  X(GETINTEGERV, GetIntegerv)                         \
  X(GETPROGRAMINFOLOG, GetProgramInfoLog)             \
  X(GETPROGRAMIV, GetProgramiv)                       \
  X(GETSHADERINFOLOG, GetShaderInfoLog)               \
  X(GETSHADERIV, GetShaderiv)                         \
  X(GETSTRING, GetString)                             \
  X(GETUNIFORMLOCATION, GetUniformLocation)           \
  X(LINKPROGRAM, LinkProgram)                         \
  X(PIXELSTOREI, PixelStorei)                         \
  X(READPIXELS, ReadPixels)                           \
  X(SCISSOR, Scissor)                                 \
  X(SHADERSOURCE, ShaderSource)                       \
  X(TEXIMAGE2D, TexImage2D)                           \
  X(TEXIMAGE3D, TexImage3D)                           \
  X(TEXSUBIMAGE3D, TexSubImage3D)                     \
  X(TEXPARAMETERI, TexParameteri)                     \
  X(TEXSUBIMAGE2D, TexSubImage2D)                     \
  X(UNIFORM1I, Uniform1i)                             \
  X(UNIFORM4FV, Uniform4fv)                           \
  X(UNIFORMMATRIX3X2FV, UniformMatrix3x2fv)           \
  X(UNIFORMMATRIX4FV, UniformMatrix4fv)               \
  X(USEPROGRAM, UseProgram)                           \
  X(VERTEXATTRIBPOINTER, VertexAttribPointer)         \
  X(VIEWPORT, Viewport)

// Null where the context does not offer them (core in 4.3 and 4.5).
#define SACCADE_GL_OPTIONAL_FUNCTIONS(X)            \
  X(43, DEBUGMESSAGECALLBACK, DebugMessageCallback) \
  X(43, DEBUGMESSAGECONTROL, DebugMessageControl)   \
  X(45, GETGRAPHICSRESETSTATUS, GetGraphicsResetStatus)

/// Members carry GL's own names without the prefix: gl.BindTexture is glBindTexture. Valid while the context
/// that filled it is current on the calling thread.
struct Gl {
#define SACCADE_GL_MEMBER(type, name) PFNGL##type##PROC name = nullptr;
  SACCADE_GL_FUNCTIONS(SACCADE_GL_MEMBER)
#define SACCADE_GL_OPTIONAL_MEMBER(version, type, name) SACCADE_GL_MEMBER(type, name)
  SACCADE_GL_OPTIONAL_FUNCTIONS(SACCADE_GL_OPTIONAL_MEMBER)
#undef SACCADE_GL_OPTIONAL_MEMBER
#undef SACCADE_GL_MEMBER
  /// The driver's own words on the last error, where it reports them (4.3).
  mutable std::string lastMessage;
};

/// Called at the end of each stage. Throws core::Error naming stage, error and call site when GL holds an
/// error, or when the context was lost. GL thread.
/// (The call site by the compilers' builtins: clang-tidy 14 cannot read GCC 12's <source_location>.)
void checkGl(const Gl& gl, const char* stage, const char* file = __builtin_FILE(),
             int line = __builtin_LINE());

/// Compiles and links; throws core::Error with the driver's log and the name. GL thread.
GLuint buildProgram(const Gl& gl, const std::string& name, const std::string& vertexSource,
                    const std::string& fragmentSource);

}  // namespace saccade::render
