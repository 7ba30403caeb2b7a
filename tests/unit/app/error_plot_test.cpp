// The plot's axes, its words, and what it hands to ImGui, without a window.
#include "app/viewer/error_plot.h"

#include <gtest/gtest.h>
#include <imgui/imgui.h>

#include <algorithm>
#include <cmath>

#include "app/viewer/log_axis.h"

namespace saccade {
namespace {

using app::axisAround;
using app::LiveError;
using app::LogAxis;

TEST(LogAxis, EndsAreRoundAndHoldAllPositiveValues) {
  for (double low = 1.1e-7; low < 1e5; low *= 3.7) {
    for (const double factor : {1.0, 1.5, 30.0, 4e6}) {
      const LogAxis axis = axisAround({low * factor, 0, low});
      EXPECT_LE(axis.low, low * (1 + 1e-6));
      EXPECT_GE(axis.high, low * factor * (1 - 1e-6));
      EXPECT_GE(axis.high, 9.99 * axis.low);
      EXPECT_LT(axis.high / axis.low, std::max(10.1, 2.6 * 2.6 * factor)) << "tight";
      for (const double end : {axis.low, axis.high}) {
        const double mantissa = end / std::pow(10.0, std::floor(std::log10(end) + 1e-9));
        EXPECT_LT(std::min({std::abs(mantissa - 1), std::abs(mantissa - 2), std::abs(mantissa - 5)}), 1e-9);
      }
    }
  }
  EXPECT_DOUBLE_EQ(axisAround({0, 0}).low, 0.1);
  EXPECT_DOUBLE_EQ(axisAround({1, 10}).low, 1);  // round already
  EXPECT_DOUBLE_EQ(axisAround({1, 10}).high, 10);
}

TEST(LogAxis, PlacesByRatioAndClamps) {
  const LogAxis axis{0.01, 100};
  EXPECT_DOUBLE_EQ(axis.at(0.01), 0);
  EXPECT_DOUBLE_EQ(axis.at(1), 0.5);
  EXPECT_DOUBLE_EQ(axis.at(100), 1);
  EXPECT_EQ(axis.at(0), 0);
  EXPECT_EQ(axis.at(1e9), 1);
}

TEST(LogAxis, TicksAreFewAndInside) {
  for (double high = 1; high < 1e12; high *= 10) {
    const LogAxis axis{0.1, high};
    const std::vector<double> ticks = axis.ticks(5);
    EXPECT_LE(ticks.size(), 5u);
    EXPECT_GE(ticks.size(), 2u);
    EXPECT_TRUE(std::is_sorted(ticks.begin(), ticks.end()));
    for (const double tick : ticks) {
      EXPECT_GE(tick, axis.low * (1 - 1e-9));
      EXPECT_LE(tick, axis.high * (1 + 1e-9));
    }
  }
  EXPECT_EQ((LogAxis{0.1, 1}.ticks(5)).size(), 4u);  // 0.1 0.2 0.5 1
}

TEST(ErrorPlot, SaysWhatGoesOn) {
  LiveError::State state;
  EXPECT_EQ(app::errorPlotStatus(state, true), "starts when the camera rests");
  EXPECT_EQ(app::errorPlotStatus(state, false), "corrections are off");
  state.resting = true;
  state.referenceDone = 0.43;
  EXPECT_EQ(app::errorPlotStatus(state, true), "reference: 43 %");
  state.referenceDone = 1;
  EXPECT_EQ(app::errorPlotStatus(state, true), "measuring the first picture");
  state.points = {{1.25, 0.1, 0.2}};
  EXPECT_EQ(app::errorPlotStatus(state, true), "after 1.25 s");
  state.waiting = 3;
  EXPECT_EQ(app::errorPlotStatus(state, true), "after 1.25 s; 3 pictures to measure");
  state.waiting = 0;
  state.complete = true;
  EXPECT_EQ(app::errorPlotStatus(state, true), "converged after 1.25 s");
  state.failure = "out of memory";
  EXPECT_EQ(app::errorPlotStatus(state, true), "no curve: out of memory");
}

/// One frame of ImGui without a backend.
class ErrorPlotDrawing : public testing::Test {
 protected:
  void SetUp() override {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {300, 400};
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
  }
  void TearDown() override { ImGui::DestroyContext(); }

  /// Where circles and lines of a colour lie, text not counted: text takes its white from the font's texture.
  static std::vector<ImVec2> verticesOf(ImU32 color, const LiveError::State& state) {
    ImGui::NewFrame();
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({300, 400});
    ImGui::Begin("panel");
    app::drawErrorPlot(state, true);
    ImGui::End();
    ImGui::Render();
    const ImVec2 white = ImGui::GetIO().Fonts->TexUvWhitePixel;
    std::vector<ImVec2> found;
    const ImDrawData& data = *ImGui::GetDrawData();
    for (int list = 0; list < data.CmdListsCount; ++list) {
      for (const ImDrawVert& v : data.CmdLists[list]->VtxBuffer) {
        if (v.col == color && v.uv.x == white.x && v.uv.y == white.y) found.push_back(v.pos);
      }
    }
    return found;
  }
};

TEST_F(ErrorPlotDrawing, CurvesSpanThePlotAndZeroHasTheLowestRow) {
  constexpr ImU32 kRelmse = IM_COL32(255, 170, 60, 255), kFlip = IM_COL32(90, 200, 255, 255);
  LiveError::State state{true, 1, {{0.1, 1, 0.1}, {1, 0.01, 0.01}, {10, 0, 0}}, 0, true, {}};
  for (const ImU32 color : {kRelmse, kFlip}) {
    std::vector<ImVec2> at = verticesOf(color, state);
    ASSERT_FALSE(at.empty());
    const auto [left, right] =
        std::minmax_element(at.begin(), at.end(), [](ImVec2 a, ImVec2 b) { return a.x < b.x; });
    EXPECT_LT(left->x, 60);
    EXPECT_GT(right->x, 270);
    EXPECT_LT(left->y + 50, right->y) << "the curve falls";
  }
  state.points.clear();
  EXPECT_TRUE(verticesOf(kRelmse, state).empty());
}

}  // namespace
}  // namespace saccade
