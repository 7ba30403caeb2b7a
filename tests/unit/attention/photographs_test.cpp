// Against people: where they looked at photographs (the shared folder's saliency/, its README says whose).
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "attention/saliency.h"
#include "attention/spectral_residual.h"
#include "core/image_io.h"
#include "core/metrics/fixation_scores.h"
#include "tests/shared_folder.h"

namespace saccade::attention {
namespace {

using Model = std::function<core::ImageGray(const core::ImageRgba8&)>;

/// Means over all photographs.
core::FixationScores meanScores(const std::filesystem::path& tableFile, const Model& model) {
  const core::FixationTable table = core::readFixations(tableFile);
  core::FixationScores mean{.auc = 0, .shuffledAuc = 0};
  const auto count = static_cast<double>(table.size());
  for (const auto& [name, fixations] : table) {
    const core::ImageGray map = model(core::readImage8(tableFile.parent_path() / "images" / name));
    const auto scores =
        core::scoreFixations(map, fixations, core::fixationsOnOthers(table, name, core::kOtherFixations, 1));
    mean.auc += scores->auc / count;
    *mean.shuffledAuc += *scores->shuffledAuc / count;
    mean.nss += scores->nss / count;
    mean.fixations += scores->fixations;
  }
  return mean;
}

// The same figures as the folder's README gives for the same map, of another program: the scores are the same
// scores.
TEST(Photographs, ACentredGaussianScoresAsElsewhere) {
  SACCADE_SHARED_FILE(table, "saliency/fixations.csv");
  const core::FixationScores scores = meanScores(table, [](const core::ImageRgba8& photograph) {
    core::ImageGray map(photograph.width(), photograph.height());
    for (int y = 0; y < map.height(); ++y) {
      for (int x = 0; x < map.width(); ++x) {
        const double dx = (x + 0.5 - map.width() / 2.0) / 200, dy = (y + 0.5 - map.height() / 2.0) / 150;
        map.at(x, y) = static_cast<float>(std::exp(-0.5 * (dx * dx + dy * dy)));
      }
    }
    return map;
  });
  EXPECT_NEAR(scores.auc, 0.735, 0.001);
  EXPECT_NEAR(*scores.shuffledAuc, 0.501, 0.005) << "another draw of the others";
  EXPECT_NEAR(scores.nss, 0.836, 0.002);
}

// The open Itti-Koch of the folder's README.
TEST(Photographs, PeopleLookWhereTheMapIsBright) {
  SACCADE_SHARED_FILE(table, "saliency/fixations.csv");
  SaliencyModel model;
  const core::FixationScores scores =
      meanScores(table, [&](const core::ImageRgba8& photograph) { return model.compute(photograph); });
  EXPECT_GE(scores.auc, 0.729);
  EXPECT_GE(*scores.shuffledAuc, 0.685);
  EXPECT_GE(scores.nss, 0.961);
}

// The folder's README gives 0.750, 0.717 and 1.069 for another program's spectral residual. Ours has 0.766,
// 0.713 and 1.137: beyond the borders its Gaussian sees 0, which favours the middle, as photographers do.
TEST(Photographs, TheSpectralResidualScoresAsOthersDo) {
  SACCADE_SHARED_FILE(table, "saliency/fixations.csv");
  const core::FixationScores scores = meanScores(table, spectralResidual);
  EXPECT_NEAR(scores.auc, 0.750, 0.02);
  EXPECT_NEAR(*scores.shuffledAuc, 0.717, 0.01);
  EXPECT_NEAR(scores.nss, 1.069, 0.1);
}

}  // namespace
}  // namespace saccade::attention
