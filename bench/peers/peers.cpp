#include "bench/peers/peers.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "bench/harness/method.h"
#include "bench/peers/contender.h"
#include "bench/peers/cycles.h"
#include "bench/peers/rest.h"
#include "bench/reference/kept_sums.h"
#include "bench/reference/reference.h"
#include "core/image_io.h"

namespace saccade::bench {
namespace {

constexpr app::ImageSize kSize{512, 512};
constexpr double kCyclesPictureNoise = 0.0008;  ///< relative MSE, as the README beside the picture says
constexpr double kSecondsPerSetting = 60;       ///< after them a setting is not repeated
constexpr int kModelSamples = 64;               ///< a pixel, to compare the means of two pictures

/// How much is done.
struct Effort {
  std::vector<int> pathTracers, corrective;  ///< samples a pixel
  std::vector<double> errors;                ///< relative MSE to be reached
  std::vector<std::string> qualities;
  Confidence confidence;
};

Effort effortOf(const Session& session) {
  if (session.quick()) return {{2, 8, 20}, {1, 4}, {0.215}, {"preview"}, {0.02, 60}};
  return {
      {8, 32, 64, 320}, {1, 2, 4, 8, 16, 32, 64}, {0.215, 0.052, 0.013}, {"preview", "medium"}, {0.003, 600}};
}

std::string shortNumber(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", x);
  return text;
}

/// One run of the comparison. Main thread only.
class Peers {
 public:
  Peers(Session& session, std::string scene, const std::string& theirPicture)
      : session_(session),
        scene_(std::move(scene)),
        effort_(effortOf(session)),
        cycles_{core::readExr(theirPicture), kCyclesPictureNoise} {}

  void run() {
    for (const std::string& quality : effort_.qualities)
      stages_.push_back(openStage(scene_, quality, session_.options().seed, session_.stop()));
    const ReferenceView view{stages_[0]->workspace->scene.cameras[0], kSize};
    reference_ = referenceOf(*stages_[0]->workspace, view, effort_.confidence, session_.stop());
    ours_ = {reference_.radiance, reference_.own.relmse};
    addContenders();
    bake();
    measure();
    for (std::size_t i = 0; i < contenders_.size(); ++i) report(i);
    reportReady();
    reportModel();
    reportRest();
  }

 private:
  std::string keyOf(const std::string& name) const { return "peers/" + sceneName(scene_) + "/" + name; }
  const core::Camera& camera() const { return stages_[0]->workspace->scene.cameras[0]; }

  void addContenders() {
    const std::optional<std::string> blender = cyclesVersion();
    Record status;
    status.key = "peers/cycles";
    status.labels = {{"renderer", "Cycles"}, {"status", blender.value_or(kCyclesMissing)}};
    session_.add(status, nullptr);
    session_.say("peers: Cycles: " + blender.value_or(kCyclesMissing));
    if (blender) contenders_.push_back(cyclesContender(*blender));
    if (session_.options().wantsMethod("corrective")) {
      for (std::size_t i = 0; i < stages_.size(); ++i) contenders_.push_back(correctiveContender(i));
    }
    if (session_.options().wantsMethod("path")) contenders_.push_back(pathContender());
  }

  Contender cyclesContender(const std::string& version) {
    Contender c{"cycles", "Cycles (" + version + ")", &cycles_, effort_.pathTracers, {}, {}};
    c.render = [this](int spp, std::uint32_t seed) {
      const CyclesPicture picture = renderWithCycles(scene_, spp, stages_[0]->cores, static_cast<int>(seed),
                                                     session_.options().folder / "peers", session_.stop());
      importSeconds_.push_back(picture.importSeconds);
      return Shot{picture.renderSeconds, core::readExr(picture.file)};
    };
    return c;
  }

  Contender correctiveContender(std::size_t stage) {
    const std::string& quality = effort_.qualities[stage];
    Contender c{
        "corrective-" + quality, "corrective, " + quality + " maps", &ours_, effort_.corrective, {}, {}};
    c.render = [this, stage](int spp, std::uint32_t seed) { return correct(*stages_[stage], spp, seed); };
    return c;
  }

  /// As `render --method corrective --converge --spp N` on all cores; all but loading and maps is counted.
  Shot correct(const Stage& stage, int spp, std::uint32_t seed) {
    app::FrameLoopOptions options;
    options.corrective.samplesPerPixel = spp;
    options.threads = stage.cores;
    options.seed = seed;
    Shot shot;
    shot.seconds = timed([&] {
      const auto loop = pinnedLoop(stage, options);
      loop->step(camera(), kSize, app::FrameBudget::untilConverged(), session_.stop());
      shot.linear = loop->linear();
    });
    session_.checkStop();
    return shot;
  }

  Contender pathContender() {
    Contender c{"path", "path", &ours_, effort_.pathTracers, {}, {}};
    c.render = [this](int spp, std::uint32_t seed) {
      return pathTrace(spp, seed, raytrace::DiffuseModel::lambert);
    };
    return c;
  }

  Shot pathTrace(int spp, std::uint32_t seed, raytrace::DiffuseModel diffuse) {
    const Stage& stage = *stages_[0];
    raytrace::PathOptions options;
    options.samplesPerPixel = spp;
    options.seed = seed;
    options.threads = stage.cores;
    options.diffuse = diffuse;
    Shot shot;
    shot.seconds = timed([&] {
      shot.linear = raytrace::tracePaths(*stage.workspace->world, stage.view(camera(), kSize), options,
                                         {nullptr, session_.stop()})
                        .radiance;
    });
    return shot;
  }

  /// From the file to maps on disk and in the world: loading, charts and trees are in it.
  void bake() {
    for (Contender& c : contenders_) {
      for (std::size_t i = 0; i < effort_.qualities.size(); ++i) {
        if (c.name != "corrective-" + effort_.qualities[i]) continue;
        session_.say("peers: baking, " + effort_.qualities[i]);
        app::SceneOptions scene;
        scene.path = scene_;
        scene.quality = effort_.qualities[i];
        const app::BakeRequest request{.file = session_.options().folder / "peers" / (c.name + ".maps"),
                                       .always = true,
                                       .threads = stages_[i]->cores};
        for (int round = 0; round < kRepeats; ++round)
          c.bakeSeconds.push_back(timed([&] { app::openWorkspace(scene, request, session_.stop()); }));
      }
    }
  }

  void measure() {
    std::vector<std::pair<std::size_t, std::size_t>> settings;  // contender, trial
    for (std::size_t i = 0; i < contenders_.size(); ++i) {
      trials_.emplace_back();
      for (const int spp : contenders_[i].samplesPerPixel) {
        settings.emplace_back(i, trials_[i].size());
        trials_[i].push_back({.samplesPerPixel = spp});
      }
    }
    const Pinned main(mainCores());
    alternate(static_cast<int>(settings.size()), kRepeats, session_.stop(), [&](int variant, int round) {
      const auto [i, k] = settings[static_cast<std::size_t>(variant)];
      Trial& trial = trials_[i][k];
      const Contender& c = contenders_[i];
      if (round < 0) {
        if (k == 0) c.render(trial.samplesPerPixel, 1);  // the cheapest picture warms up as well as all
        return;
      }
      if (trial.spent > kSecondsPerSetting) return;
      session_.say("peers: " + c.label + ", " + std::to_string(trial.samplesPerPixel) + " spp, repeat " +
                   std::to_string(round + 1));
      trial.add(c.render(trial.samplesPerPixel, session_.options().seed + static_cast<std::uint32_t>(round)),
                *c.truth);
    });
  }

  /// The points of a contender's curve and its seconds to each error, maps ready and, where it has maps, bake
  /// included.
  void report(std::size_t index) {
    const Contender& c = contenders_[index];
    for (const Trial& trial : trials_[index]) reportPoint(c, trial, "");
    for (const double error : effort_.errors) reportSeconds(index, error, {}, "");
    if (c.bakeSeconds.empty()) return;
    for (const Trial& trial : trials_[index]) reportPoint(c, trial, "-baked");
    for (const double error : effort_.errors) reportSeconds(index, error, c.bakeSeconds, "-baked");
  }

  std::map<std::string, std::string> labelsOf(const Contender& c, const std::string& suffix) const {
    std::map<std::string, std::string> labels = {
        {"scene", sceneName(scene_)}, {"renderer", c.label + (suffix.empty() ? "" : ", bake included")}};
    return labels;
  }

  void reportPoint(const Contender& c, const Trial& trial, const std::string& suffix) {
    Record record;
    record.key = keyOf(c.name + suffix + "@" + std::to_string(trial.samplesPerPixel) + "spp");
    record.labels = labelsOf(c, suffix);
    record.at = {{"spp", trial.samplesPerPixel}};
    std::vector<double> seconds = trial.seconds;
    if (!suffix.empty()) {
      for (double& s : seconds) s += spread(c.bakeSeconds).median;
    }
    record.values = {{"seconds", Value::seconds(seconds)}, {"relmse", Value::errors(trial.errors)}};
    if (suffix.empty()) {
      const std::string name = "peers-" + c.name + "-" + std::to_string(trial.samplesPerPixel) + "spp";
      record.files = {
          {"picture", session_.picture(name, trial.last)},
          {"error",
           session_.errorMap(name + "-flip", core::compareLinear(c.truth->picture, trial.last).flipMap)}};
    }
    session_.add(record, &watch_);
  }

  void reportSeconds(std::size_t index, double error, const std::vector<double>& further,
                     const std::string& suffix) {
    const Contender& c = contenders_[index];
    Record record;
    record.key = keyOf(c.name + suffix + "/to-" + shortNumber(error));
    record.labels = labelsOf(c, suffix);
    record.at = {{"relmse", error}};
    const std::optional<SecondsTo> own = secondsTo(trials_[index], error, further);
    if (!own) {
      record.labels["status"] = "not reached";
    } else {
      record.values["seconds_to"] = own->seconds;
      if (own->atMost) record.labels["status"] = "at most: its cheapest picture is better";
      const bool beside = index > 0 && contenders_[0].name == "cycles";
      const auto theirs = beside ? secondsTo(trials_[0], error, {}) : std::nullopt;
      if (theirs) record.values["sooner_than_cycles"] = quotient(theirs->seconds, own->seconds);
    }
    session_.add(record, &watch_);
  }

  /// What nobody's seconds count: the file read and everything but maps made of it. Cycles counts its trees
  /// and uploads in the rendering, we do not.
  void reportReady() {
    std::vector<double> ours;
    for (int round = 0; round < kRepeats; ++round)
      ours.push_back(timed(
          [&] { openStage(scene_, effort_.qualities.back(), session_.options().seed, session_.stop()); }));
    const auto add = [&](const std::string& name, const std::string& what,
                         const std::vector<double>& seconds) {
      Record record;
      record.key = keyOf("ready-" + name);
      record.labels = {{"scene", sceneName(scene_)}, {"renderer", what}};
      record.values = {{"seconds_ready", Value::seconds(seconds)}};
      session_.add(record, &watch_);
    };
    add("ours", "ours: file, maps from the cache, trees, OpenGL", ours);
    if (!importSeconds_.empty()) add("cycles", "Cycles: file", importSeconds_);
  }

  /// How far the two references are from one another, and that it is the diffuse lobe that makes it.
  void reportModel() {
    session_.say("peers: the difference between the references");
    const auto mean = [](const core::ImageRgb& image) {
      glm::dvec3 sum(0);
      for (const core::Vec3& p : image.pixels()) sum += glm::dvec3(p);
      return (sum.x + sum.y + sum.z) / (3.0 * static_cast<double>(image.pixels().size()));
    };
    const double theirs = mean(cycles_.picture);
    const Shot burley = pathTrace(kModelSamples, session_.options().seed, raytrace::DiffuseModel::burley);
    Record record;
    record.key = keyOf("model");
    record.labels = {{"scene", sceneName(scene_)}, {"renderer", "our reference against Cycles' picture"}};
    record.values = {
        {"mean_lambert", Value::error(mean(ours_.picture) / theirs - 1)},
        {"mean_burley", Value::error(mean(burley.linear) / theirs - 1)},
        {"model_relmse", Value::error(errorWithoutNoise(core::compareLinear(cycles_.picture, ours_.picture),
                                                        cycles_.noise + ours_.noise))},
        {"own_relmse", Value::error(ours_.noise)},
        {"own_spp", Value::count(static_cast<double>(reference_.samplesPerPixel))}};
    session_.add(record, nullptr);
  }

  /// Of the best corrective picture: which part of the picture its error is in.
  void reportRest() {
    constexpr std::array<const char*, 3> kNames = {"edges", "corrected", "maps"};
    const std::string best = "corrective-" + effort_.qualities.back();
    for (std::size_t i = 0; i < contenders_.size(); ++i) {
      if (contenders_[i].name != best) continue;
      const core::FramePtr frame = stages_.back()->gl->renderer->render(stages_.back()->view(camera(), kSize),
                                                                        1, app::CorrectiveOptions{}.nMin);
      const ReferenceSums sums =
          readSums(referenceFile(reference_.key), reference_.key, kSize.width, kSize.height);
      const auto shares = sharesOfError(trials_[i].back().last, sums, *frame);
      for (std::size_t part = 0; part < shares.size(); ++part) {
        Record record;
        record.key = keyOf(std::string("rest/") + kNames[part]);
        record.labels = labelsOf(contenders_[i], "");
        record.labels["part"] = kNames[part];
        record.at = {{"spp", trials_[i].back().samplesPerPixel}};
        record.values = {{"relmse_share", Value::error(shares[part].relmse)},
                         {"area", Value::count(shares[part].area)}};
        session_.add(record, nullptr);
      }
    }
  }

  Session& session_;
  std::string scene_;
  Effort effort_;
  Truth cycles_, ours_;
  Reference reference_;
  std::vector<std::unique_ptr<Stage>> stages_;  ///< by quality
  std::vector<Contender> contenders_;           ///< Cycles first, where it is there
  std::vector<double> importSeconds_;           ///< Cycles'
  std::vector<std::vector<Trial>> trials_;      ///< by contender and number of samples
  LoadWatch watch_;
};

}  // namespace

void measurePeers(Session& session) {
  const auto scene = sharedFile("references/cycles/cornell_glossy.glb");
  const auto picture = sharedFile("references/cycles/cornell_glossy_cycles_4096spp.exr");
  if (!scene || !picture) {
    session.say("peers: references/cycles of the shared folder is not here (set SACCADE_SHARED); left out");
    return;
  }
  Peers(session, *scene, *picture).run();
}

}  // namespace saccade::bench
