// saccade attention: where a person looks first, as the model sees it, for any pictures.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/cli/attention_outputs.h"
#include "app/cli/console.h"
#include "app/cli/options.h"
#include "app/commands.h"
#include "attention/saliency.h"
#include "core/displayed_image.h"
#include "core/image_io.h"
#include "core/metrics/fixation_scores.h"

namespace saccade::app {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

struct MapOptions {
  std::vector<std::string> images;
  std::string output, fixations;
  attention::SaliencyOptions saliency;
  bool json = false;
};

/// What is said about one image.
struct Result {
  std::string image, map;  ///< `map`: empty where none is written
  int width = 0, height = 0;
  std::optional<core::FixationScores> scores;
};

core::ImageRgba8 readPicture(const std::string& file) {
  core::ImageRgba8 picture = core::readDisplayed(file);
  if (std::max(picture.width(), picture.height()) > attention::SaliencyModel::kLargestSide) {
    throw core::Error(file + ": " + std::to_string(picture.width()) + " x " +
                      std::to_string(picture.height()) +
                      " pixels; make it smaller, the model takes sides of " + "up to " +
                      std::to_string(attention::SaliencyModel::kLargestSide));
  }
  return picture;
}

void writeMap(const fs::path& file, const core::ImageGray& map) {
  if (file.extension() == ".exr") return core::writeExrChannels(file, {{"Y", &map}});
  core::ImageRgba8 grey(map.width(), map.height());
  for (std::size_t i = 0; i < map.pixels().size(); ++i) {
    const auto code = static_cast<std::uint8_t>(std::lround(255 * map.pixels()[i]));
    grey.pixels()[i] = {code, code, code, 255};
  }
  core::writePng(file, grey);
}

/// The column `image` of a table of fixations holds file names.
std::string nameInTable(const std::string& image) { return fs::path(image).filename().string(); }

core::FixationTable readTable(const MapOptions& o) {
  if (o.fixations.empty()) return {};
  core::FixationTable table = core::readFixations(o.fixations);
  for (const std::string& image : o.images) {
    if (!table.contains(nameInTable(image)))
      throw core::Error(o.fixations + ": no fixations on " + nameInTable(image) +
                        "; its column 'image' must hold the images' file names");
  }
  return table;
}

core::FixationScores score(const std::string& image, const core::ImageGray& map,
                           const core::FixationTable& table) {
  const std::string name = nameInTable(image);
  const std::vector<core::Fixation>& own = table.at(name);
  // The same others for every model and in every run.
  constexpr std::uint32_t kSeed = 1;
  const auto scores =
      core::scoreFixations(map, own, core::fixationsOnOthers(table, name, core::kOtherFixations, kSeed));
  const std::string size = std::to_string(map.width()) + " x " + std::to_string(map.height());
  if (!scores)
    throw core::Error(image + ": no fixation lies inside its " + size +
                      " pixels; x_px and y_px count from its top left corner");
  const std::size_t outside = own.size() - static_cast<std::size_t>(scores->fixations);
  if (outside > 0)
    spdlog::warn("{}: {} of {} fixations lie outside its {} pixels and do not count", image, outside,
                 own.size(), size);
  return *scores;
}

std::vector<Result> makeMaps(const MapOptions& o) {
  const std::vector<fs::path> files = attentionOutputs(o.images, o.output);
  const core::FixationTable table = readTable(o);
  if (!files.empty() && files[0] != fs::path(o.output)) fs::create_directories(o.output);
  const std::stop_token stop = interruptToken();
  std::optional<ProgressBar> bar;
  if (o.images.size() > 1) bar.emplace("attention");
  attention::SaliencyModel model(o.saliency);
  std::vector<Result> results;
  for (std::size_t i = 0; i < o.images.size(); ++i) {
    if (stop.stop_requested())
      throw core::Error("interrupted; " + std::to_string(i) + " of " + std::to_string(o.images.size()) +
                        " images are done");
    const core::ImageRgba8 picture = readPicture(o.images[i]);
    const core::ImageGray& map = model.compute(picture);
    Result& result = results.emplace_back();
    result.image = o.images[i];
    result.width = map.width();
    result.height = map.height();
    if (!files.empty()) {
      result.map = files[i].string();
      writeMap(files[i], map);
    }
    if (!table.empty()) result.scores = score(o.images[i], map, table);
    if (bar) bar->show(static_cast<double>(i + 1) / static_cast<double>(o.images.size()));
  }
  return results;
}

/// Over the images; that of the shuffled AUC over those that have one.
core::FixationScores meanOf(const std::vector<Result>& results) {
  core::FixationScores mean{.auc = 0};
  double shuffled = 0;
  int withShuffled = 0;
  for (const Result& r : results) {
    mean.auc += r.scores->auc / static_cast<double>(results.size());
    mean.nss += r.scores->nss / static_cast<double>(results.size());
    mean.fixations += r.scores->fixations;
    if (!r.scores->shuffledAuc) continue;
    shuffled += *r.scores->shuffledAuc;
    ++withShuffled;
  }
  if (withShuffled > 0) mean.shuffledAuc = shuffled / withShuffled;
  return mean;
}

void addScores(Json& json, const core::FixationScores& scores) {
  json["auc"] = scores.auc;
  json["sauc"] = scores.shuffledAuc ? Json(*scores.shuffledAuc) : Json(nullptr);
  json["nss"] = scores.nss;
  json["fixations"] = scores.fixations;
}

void printJson(const MapOptions& o, const std::vector<Result>& results) {
  Json json;
  json["normalise"] = o.saliency.normalise == attention::Normalisation::max ? "max" : "dog";
  json["images"] = Json::array();
  for (const Result& r : results) {
    Json image{{"image", r.image}, {"width", r.width}, {"height", r.height}};
    if (!r.map.empty()) image["map"] = r.map;
    if (r.scores) addScores(image, *r.scores);
    json["images"].push_back(image);
  }
  if (!o.fixations.empty()) {
    json["mean"] = Json::object();
    addScores(json["mean"], meanOf(results));
  }
  std::printf("%s\n", json.dump(2).c_str());
}

void print(const std::string& name, const core::FixationScores& scores) {
  const std::string shuffled =
      scores.shuffledAuc ? fmt::format("{:.3f}", *scores.shuffledAuc) : "- (no fixations on other pictures)";
  std::printf("%s: AUC %.3f, sAUC %s, NSS %.3f, %d fixations\n", name.c_str(), scores.auc, shuffled.c_str(),
              scores.nss, scores.fixations);
}

int attentionMaps(const MapOptions& o) {
  if (o.output.empty() && o.fixations.empty())
    throw core::UsageError(
        "attention needs -o (where the map goes), --score (what it is held against) or both");
  const std::vector<Result> results = makeMaps(o);
  if (o.json) {
    printJson(o, results);
    return 0;
  }
  for (const Result& r : results) {
    if (r.scores) {
      print(r.image, *r.scores);
    } else {
      std::printf("%s\n", r.map.c_str());
    }
  }
  if (!o.fixations.empty() && results.size() > 1)
    print("mean of " + std::to_string(results.size()) + " images", meanOf(results));
  return 0;
}

}  // namespace

void addAttentionCommand(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand(
      "attention", "Where a person looks first: saliency maps of pictures, and their scores");
  auto o = std::make_shared<MapOptions>();
  command->add_option("IMAGE", o->images, "PNG, JPEG, OpenEXR or Radiance .hdr, as displayed")->required();
  command->add_option(
      "-o,--output", o->output,
      "Map of one image, as large, brighter where more salient: .png (8 bits) or .exr (floats); or "
      "a folder for those of several, IMAGE's name + .png");
  addSaliencyOptions(*command, o->saliency);
  command->add_option("--score", o->fixations,
                      "Recorded fixations, a CSV file with columns image, x_px, y_px: print Judd's AUC, the "
                      "shuffled AUC and NSS");
  command->add_flag("--json", o->json, "Machine-readable output");
  command->callback([o, &run] { run = [o] { return attentionMaps(*o); }; });
}

}  // namespace saccade::app
