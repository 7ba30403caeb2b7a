#include "render/base/background.h"

#include <algorithm>

namespace saccade::render {

namespace {

constexpr const char* kVertex = R"(#version 330 core
uniform vec4 corner[3];  // directions: through the image's top left, and from there right and down
out vec3 direction;
void main() {  // one triangle over the whole image, at the far plane
  vec2 at = vec2((gl_VertexID & 1) * 2, (gl_VertexID & 2));
  gl_Position = vec4(at * 2.0 - 1.0, 0.0, 1.0);
  direction = corner[0].xyz + at.x * corner[1].xyz + at.y * corner[2].xyz;
}
)";

// atan is written out: GLSL allows its own an error of 4096 ulp, visible as a shift of texels against the
// tracer. The polynomial is that of Cephes' atanf (S. Moshier), after its reduction to |x| <= tan(pi / 8).
constexpr const char* kFragment = R"(#version 330 core
in vec3 direction;
out vec4 radianceAndId;
uniform sampler2D environment;
uniform vec4 turns;  // x: by how much the picture is turned, in whole turns
const float pi = 3.14159265358979;
float angle(float y, float x) {  // of (x, y), in (-pi, pi]
  float a = abs(y), b = abs(x);
  float t = min(a, b) / max(max(a, b), 1e-30);
  float base = 0.0;
  if (t > 0.41421356) {
    base = pi / 4.0;
    t = (t - 1.0) / (t + 1.0);
  }
  float z = t * t;
  float r = base + t + t * z * (((8.05374449538e-2 * z - 1.38776856032e-1) * z + 1.99777106478e-1) * z -
                                3.33329491539e-1);
  if (a > b) r = pi / 2.0 - r;
  if (x < 0.0) r = pi - r;
  return y < 0.0 ? -r : r;
}
void main() {
  float u = 0.5 + angle(direction.x, -direction.z) / (2.0 * pi) + turns.x;
  float v = angle(length(direction.xz), direction.y) / pi;
  // One sample without mipmaps: no derivative, so no seam behind.
  radianceAndId = vec4(textureLod(environment, vec2(u - floor(u), v), 0.0).rgb, 0.0);
}
)";

/// Averages blocks of texels until both sides fit; empty where they do.
core::ImageRgb fitted(const core::ImageRgb& image, int maxSide) {
  const int factor = (std::max(image.width(), image.height()) + maxSide - 1) / maxSide;
  if (factor <= 1) return {};
  core::ImageRgb out(std::max(1, image.width() / factor), std::max(1, image.height() / factor));
  const auto begin = [](int i, int from, int to) {
    return static_cast<int>(static_cast<std::int64_t>(i) * from / to);
  };
  for (int y = 0; y < out.height(); ++y) {
    const int y0 = begin(y, image.height(), out.height()), y1 = begin(y + 1, image.height(), out.height());
    for (int x = 0; x < out.width(); ++x) {
      const int x0 = begin(x, image.width(), out.width()), x1 = begin(x + 1, image.width(), out.width());
      glm::dvec3 sum(0);
      for (int j = y0; j < y1; ++j) {
        for (int i = x0; i < x1; ++i) sum += image.at(i, j);
      }
      out.at(x, y) = core::Vec3(sum / (static_cast<double>(x1 - x0) * (y1 - y0)));
    }
  }
  return out;
}

}  // namespace

Background::Background(const Gl& gl, const core::Environment& environment, int maxSide, Portions& portions)
    : gl_(gl), smaller_(fitted(environment.radiance, maxSide)) {
  const core::ImageRgb& image = smaller_.empty() ? environment.radiance : smaller_;
  portions.add([this, &image] { makeTexture(image.width(), image.height()); });
  rowsInPortions(image.width(), image.height(), [&](int row, int rows) {
    portions.add([this, &image, row, rows] {
      static_assert(sizeof(core::Vec3) == 3 * sizeof(float));
      gl_.BindTexture(GL_TEXTURE_2D, texture_.name());
      gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
      gl_.TexSubImage2D(GL_TEXTURE_2D, 0, 0, row, image.width(), rows, GL_RGB, GL_FLOAT, &image.at(0, row));
    });
  });
  portions.add([this, &environment] {
    smaller_ = core::ImageRgb();
    makeProgram(environment.rotation);
    checkGl(gl_, "uploading the environment");
  });
}

void Background::makeTexture(int width, int height) {
  texture_ = GlTexture(gl_);
  gl_.BindTexture(GL_TEXTURE_2D, texture_.name());
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, width, height, 0, GL_RGB, GL_FLOAT, nullptr);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
}

void Background::makeProgram(float rotation) {
  program_ = GlProgram(gl_, buildProgram(gl_, "environment", kVertex, kFragment));
  noAttributes_ = GlVertexArray(gl_);
  corner_ = gl_.GetUniformLocation(program_.name(), "corner");
  turns_ = gl_.GetUniformLocation(program_.name(), "turns");
  const float turns[4] = {rotation / (2 * core::kPi), 0, 0, 0};
  gl_.UseProgram(program_.name());
  gl_.Uniform4fv(turns_, 1, turns);
  gl_.Uniform1i(gl_.GetUniformLocation(program_.name(), "environment"), 0);
}

void Background::draw(const core::View& view) const {
  const auto width = static_cast<float>(view.width()), height = static_cast<float>(view.height());
  const core::Vec3 topLeft = view.direction({0, 0});
  const core::Vec4 corners[3] = {core::Vec4(topLeft, 0), core::Vec4(view.direction({width, 0}) - topLeft, 0),
                                 core::Vec4(view.direction({0, height}) - topLeft, 0)};
  gl_.Disable(GL_CULL_FACE);
  gl_.DepthFunc(GL_GEQUAL);
  gl_.DepthMask(GL_FALSE);
  gl_.UseProgram(program_.name());
  gl_.Uniform4fv(corner_, 3, &corners[0].x);
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_2D, texture_.name());
  gl_.BindVertexArray(noAttributes_.name());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  gl_.DepthMask(GL_TRUE);
}

}  // namespace saccade::render
