#include "render/context/gl.h"

#include <cstring>
#include <vector>

#include "core/error.h"

namespace saccade::render {

namespace {

const char* errorName(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
      return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
      return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
      return "GL_OUT_OF_MEMORY (draw smaller images or fewer textures)";
    default:
      return "an unknown OpenGL error";
  }
}

std::string site(const char* file, int line) {
  const char* slash = std::strrchr(file, '/');
  return std::string(slash ? slash + 1 : file) + ":" + std::to_string(line);
}

GLuint compileStage(const Gl& gl, const std::string& name, GLenum stage, const std::string& source) {
  const GLuint shader = gl.CreateShader(stage);
  const char* text = source.c_str();
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  GLint ok = GL_FALSE, length = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok == GL_TRUE) return shader;
  gl.GetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::vector<char> log(static_cast<std::size_t>(length) + 1, '\0');
  gl.GetShaderInfoLog(shader, length, nullptr, log.data());
  gl.DeleteShader(shader);
  throw core::Error("OpenGL " + std::string(stage == GL_VERTEX_SHADER ? "vertex" : "fragment") + " shader '" +
                    name + "' does not compile: " + log.data());
}

}  // namespace

void checkGl(const Gl& gl, const char* stage, const char* file, int line) {
  const GLenum error = gl.GetError();
  // The context reports each error until it is fetched: empty it, so that the next stage is judged alone.
  for (int i = 0; error != GL_NO_ERROR && i < 16 && gl.GetError() != GL_NO_ERROR; ++i) continue;
  if (error != GL_NO_ERROR) {
    const std::string detail = gl.lastMessage.empty() ? "" : ": " + gl.lastMessage;
    gl.lastMessage.clear();
    throw core::Error(std::string("OpenGL failed in ") + stage + " (" + site(file, line) +
                      "): " + errorName(error) + detail);
  }
  if (gl.GetGraphicsResetStatus && gl.GetGraphicsResetStatus() != GL_NO_ERROR) {
    throw core::Error(std::string("the OpenGL context was lost in ") + stage + " (" + site(file, line) +
                      "): the graphics driver was reset; start the program again");
  }
}

GLuint buildProgram(const Gl& gl, const std::string& name, const std::string& vertexSource,
                    const std::string& fragmentSource) {
  const GLuint vertex = compileStage(gl, name, GL_VERTEX_SHADER, vertexSource);
  GLuint fragment = 0;
  try {
    fragment = compileStage(gl, name, GL_FRAGMENT_SHADER, fragmentSource);
  } catch (...) {
    gl.DeleteShader(vertex);
    throw;
  }
  const GLuint program = gl.CreateProgram();
  gl.AttachShader(program, vertex);
  gl.AttachShader(program, fragment);
  gl.LinkProgram(program);
  gl.DeleteShader(vertex);
  gl.DeleteShader(fragment);
  GLint ok = GL_FALSE, length = 0;
  gl.GetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok == GL_TRUE) return program;
  gl.GetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
  std::vector<char> log(static_cast<std::size_t>(length) + 1, '\0');
  gl.GetProgramInfoLog(program, length, nullptr, log.data());
  gl.DeleteProgram(program);
  throw core::Error("OpenGL program '" + name + "' does not link: " + log.data());
}

}  // namespace saccade::render
