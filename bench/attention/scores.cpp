#include "bench/attention/scores.h"

#include <array>
#include <cmath>
#include <functional>
#include <memory>

#include "attention/plain_saliency.h"
#include "attention/saliency.h"
#include "attention/spectral_residual.h"
#include "core/image_io.h"
#include "core/metrics/fixation_scores.h"

namespace saccade::bench {
namespace {

using attention::Normalisation;
using attention::SaliencyModel;

struct Model {
  std::string name;
  std::function<core::ImageGray(const core::ImageRgba8&)> map;
};

/// Knows where the middle is and nothing else: a quarter of the sides as standard deviations.
core::ImageGray centredGaussian(const core::ImageRgba8& picture) {
  core::ImageGray map(picture.width(), picture.height());
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      const double dx = 4 * ((x + 0.5) / map.width() - 0.5), dy = 4 * ((y + 0.5) / map.height() - 0.5);
      map.at(x, y) = static_cast<float>(std::exp(-0.5 * (dx * dx + dy * dy)));
    }
  }
  return map;
}

std::vector<Model> models() {
  std::vector<Model> all{{"centred Gaussian", centredGaussian},
                         {"spectral residual", attention::spectralResidual},
                         {"plain OpenCV", attention::plainSaliency}};
  for (const bool orientation : {false, true}) {
    for (const Normalisation normalise : {Normalisation::max, Normalisation::dog}) {
      const std::string name = normalise == Normalisation::max ? "max" : "dog";
      const auto model = std::make_shared<SaliencyModel>(attention::SaliencyOptions{normalise, orientation});
      all.push_back({name + (orientation ? ", orientation" : ""),
                     [model](const core::ImageRgba8& picture) { return model->compute(picture); }});
    }
  }
  return all;
}

struct Sums {
  double auc = 0, shuffled = 0, nss = 0;
  int photographs = 0;

  void add(const core::FixationScores& scores) {
    auc += scores.auc;
    shuffled += scores.shuffledAuc.value_or(0.5);
    nss += scores.nss;
    ++photographs;
  }
  void write(std::map<std::string, Value>& values, const std::string& suffix) const {
    const double n = photographs;
    values["auc" + suffix] = Value::count(auc / n, Better::higher);
    values["sauc" + suffix] = Value::count(shuffled / n, Better::higher);
    values["nss" + suffix] = Value::count(nss / n, Better::higher);
  }
};

}  // namespace

std::string keyOf(const std::string& model) {
  std::string key;
  for (const char c : model) {
    if (c != ',') key += c == ' ' ? '-' : c;
  }
  return key;
}

void scoreModels(Session& session) {
  const auto tableFile = sharedFile("saliency/fixations.csv");
  if (!tableFile) {
    session.say("attention: the shared folder's photographs are not here; no scores");
    return;
  }
  session.say("attention: where people look");
  const core::FixationTable table = core::readFixations(*tableFile);
  const std::filesystem::path images = std::filesystem::path(*tableFile).parent_path() / "images";
  const std::vector<Model> all = models();
  std::vector<std::array<Sums, 3>> sums(all.size());  // all, even, odd
  std::size_t number = 0;
  for (const auto& [name, fixations] : table) {
    session.checkStop();
    const core::ImageRgba8 photograph = core::readImage8(images / name);
    const auto others = core::fixationsOnOthers(table, name, core::kOtherFixations, session.options().seed);
    const std::size_t half = 1 + number++ % 2;
    for (std::size_t m = 0; m < all.size(); ++m) {
      const auto scores = core::scoreFixations(all[m].map(photograph), fixations, others);
      if (!scores) continue;
      sums[m][0].add(*scores);
      sums[m][half].add(*scores);
    }
  }
  for (std::size_t m = 0; m < all.size(); ++m) {
    Record record;
    record.key = "attention/scores-" + keyOf(all[m].name);
    record.labels = {{"what", "scores"}, {"model", all[m].name}};
    sums[m][0].write(record.values, "");
    sums[m][1].write(record.values, "_even");
    sums[m][2].write(record.values, "_odd");
    record.values["photographs"] = Value::count(sums[m][0].photographs);
    session.add(record, nullptr);
  }
}

}  // namespace saccade::bench
