#include <cstdlib>
#include <thread>

#include "core/error.h"
#include "render/context/gl_context.h"
#include "render/context/gl_object.h"
#include "render/window/offscreen_surface.h"
#include "render/window/presenter.h"
#include "scene_fixture.h"

namespace saccade::tests {
namespace {

class Context : public EachContext {};
SACCADE_EACH_CONTEXT(Context);

std::string errorText(const auto& action) {
  try {
    action();
  } catch (const core::Error& error) {
    return error.what();
  }
  return "";
}

TEST_P(Context, NamesItselfAndItsLimits) {
  EXPECT_EQ(context_->name(), GetParam() == render::ContextKind::osmesa ? "osmesa" : "egl");
  EXPECT_FALSE(context_->renderer().empty());
  EXPECT_NE(context_->version().find("Core Profile"), std::string::npos) << context_->version();
  EXPECT_GE(context_->maxSize(), 1024);
  EXPECT_LE(context_->maxSize(), render::kMaxImageSide);
}

TEST_P(Context, IsRefusedWhileCurrentElsewhere) {
  std::string refused;
  std::thread([&] { refused = errorText([&] { context_->makeCurrent(); }); }).join();
  EXPECT_NE(refused.find("current on another thread"), std::string::npos) << refused;

  context_->release();
  std::string taken = "not run";
  std::thread([&] {
    taken = errorText([&] {
      context_->makeCurrent();
      render::checkGl(context_->gl(), "a thread of its own");
      context_->release();
    });
  }).join();
  EXPECT_EQ(taken, "");
  context_->makeCurrent();
  render::checkGl(context_->gl(), "back again");
}

TEST_P(Context, ErrorNamesStageAndKindAndLeavesNothingBehind) {
  const render::Gl& gl = context_->gl();
  constexpr GLenum kNoSuchThing = 0xdead;
  gl.Enable(kNoSuchThing);
  gl.Enable(kNoSuchThing);
  const std::string text = errorText([&] { render::checkGl(gl, "a broken stage"); });
  EXPECT_NE(text.find("a broken stage"), std::string::npos) << text;
  EXPECT_NE(text.find("context_test.cpp"), std::string::npos) << text;
  EXPECT_NE(text.find("GL_INVALID_ENUM"), std::string::npos) << text;
  EXPECT_NO_THROW(render::checkGl(gl, "the next stage"));
}

TEST_P(Context, ShaderFailureCarriesTheLog) {
  const std::string good = "#version 330 core\nvoid main() { gl_Position = vec4(0); }\n";
  const std::string bad = "#version 330 core\nvoid main() { undeclaredName = 1; }\n";
  const std::string text = errorText([&] { render::buildProgram(context_->gl(), "broken", good, bad); });
  EXPECT_NE(text.find("fragment shader 'broken'"), std::string::npos) << text;
  EXPECT_NE(text.find("undeclaredName"), std::string::npos) << text;
  EXPECT_NO_THROW(render::checkGl(context_->gl(), "after the failure"));
}

/// Two contexts on one thread may share a dispatch table underneath: each draw must reach its own.
TEST(Contexts, TakeTurnsOnOneThread) {
  const core::ImageRgba8 red(4, 4, {255, 0, 0, 255}), blue(4, 4, {0, 0, 255, 255});
  const auto osmesa = render::makeHeadlessContext(render::ContextKind::osmesa);
  const auto egl = render::makeHeadlessContext(render::ContextKind::egl);
  render::OffscreenSurface first(*osmesa, 4, 4), second(*egl, 4, 4);
  render::Presenter firstPresenter(*osmesa), secondPresenter(*egl);
  for (int turn = 0; turn < 2; ++turn) {
    first.bind();
    firstPresenter.present(turn ? blue : red, {0, 0, 4, 4}, 4, 4);
    second.bind();
    secondPresenter.present(turn ? red : blue, {0, 0, 4, 4}, 4, 4);
    EXPECT_EQ(first.read().pixels(), (turn ? blue : red).pixels());
    EXPECT_EQ(second.read().pixels(), (turn ? red : blue).pixels());
  }
}

TEST(Contexts, EglWorksOnBothPlatforms) {
  for (const render::EglPlatform platform : {render::EglPlatform::surfaceless, render::EglPlatform::device}) {
    const auto context = render::makeEglContext(platform);
    render::OffscreenSurface surface(*context, 3, 5);
    const core::ImageRgba8 green(3, 5, {0, 255, 0, 255});
    render::Presenter(*context).present(green, {0, 0, 3, 5}, 3, 5);
    EXPECT_EQ(surface.read().pixels(), green.pixels());
  }
}

TEST(Contexts, UsersThreadCountWins) {
  const char* before = std::getenv("LP_NUM_THREADS");
  const std::string kept = before ? before : "";
  setenv("LP_NUM_THREADS", "7", 1);
  render::setSoftwareRasterThreads(1);
  EXPECT_STREQ(std::getenv("LP_NUM_THREADS"), "7");
  unsetenv("LP_NUM_THREADS");
  render::setSoftwareRasterThreads(1);
  EXPECT_STREQ(std::getenv("LP_NUM_THREADS"), "1");
  if (before) {
    setenv("LP_NUM_THREADS", kept.c_str(), 1);
  } else {
    unsetenv("LP_NUM_THREADS");
  }
}

}  // namespace
}  // namespace saccade::tests
