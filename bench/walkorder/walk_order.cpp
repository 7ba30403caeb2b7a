#include "bench/walkorder/walk_order.h"

#include <cstdio>
#include <map>
#include <vector>

#include "bench/walkorder/scenes.h"
#include "bench/walkorder/walk.h"

namespace saccade::bench {
namespace {

using attention::Order;

constexpr app::ImageSize kSize{512, 512};
constexpr std::uint64_t kSamples[] = {1000, 5000, 20000};
constexpr double kPlaces[] = {0.25, 0.5, 0.75};  ///< middles of the stretches, of the path
constexpr const char* kUsual = "attention";

struct Variant {
  const char* name;
  Order order;
  float attention = 0.5f;
  float inhibition = core::RegionQueue::kInhibition;
  bool everywhere = true;  ///< else in the bundled scenes only
};

// The usual one first.
constexpr Variant kVariants[] = {{kUsual, Order::attention},
                                 {"importance", Order::importance},
                                 {"gain", Order::gain},
                                 {"random", Order::random},
                                 {"scanline", Order::scanline},
                                 {"largest", Order::largest},
                                 {"saliency", Order::attention, 0, core::RegionQueue::kInhibition, false},
                                 {"task", Order::task, 0.5f, core::RegionQueue::kInhibition, false},
                                 {"importance-10-percent", Order::importance, 0.5f, 0.1f, false},
                                 {"winner-takes-all", Order::importance, 0.5f, 0, false}};

app::CorrectiveOptions optionsOf(const Variant& variant) {
  app::CorrectiveOptions options;
  options.attention.order = variant.order;
  options.attention.attention = variant.attention;
  options.inhibition = variant.inhibition;
  return options;
}

using Errors = std::vector<WalkError>;                      ///< by stretch
using Ratios = std::map<std::string, std::vector<double>>;  ///< by figure
using RatiosBySamples = std::map<std::uint64_t, Ratios>;    ///< of many walks

Record recordOf(const std::string& scene, const std::string& variant, std::uint64_t samples) {
  Record record;
  record.key = "walk-order/" + scene + "/" + variant + "@" + std::to_string(samples);
  record.labels = {{"scene", scene}, {"method", "corrective"}, {"order", variant}};
  record.at = {{"samples", static_cast<double>(samples)}};
  return record;
}

Record errorsOf(const std::string& scene, const std::string& variant, std::uint64_t samples,
                const Errors& errors) {
  Record record = recordOf(scene, variant, samples);
  const auto over = [&](double WalkError::*figure) {
    return Value::errors(each(errors, [figure](const WalkError& e) { return e.*figure; }));
  };
  record.values = {{"rmse", over(&WalkError::rmse)},
                   {"rmse_salient", over(&WalkError::rmseSalient)},
                   {"flip", over(&WalkError::flip)},
                   {"flip_salient", over(&WalkError::flipSalient)}};
  return record;
}

/// The usual order's errors over those of every other.
Ratios ratiosOf(const std::map<std::string, Errors>& all) {
  Ratios ratios;
  const Errors& ours = all.at(kUsual);
  for (const auto& [name, theirs] : all) {
    if (name == kUsual) continue;
    for (std::size_t i = 0; i < theirs.size(); ++i) {
      ratios["flip_salient_over_" + name].push_back(ours[i].flipSalient / theirs[i].flipSalient);
      ratios["rmse_over_" + name].push_back(ours[i].rmse / theirs[i].rmse);
    }
  }
  return ratios;
}

Record againstOf(const std::string& scenes, std::uint64_t samples, const Ratios& ratios) {
  Record record = recordOf(scenes, "against", samples);
  for (const auto& [figure, values] : ratios) record.values[figure] = Value::ratio(values, Better::lower);
  return record;
}

/// All orders in one scene.
class SceneWalks {
 public:
  SceneWalks(Session& session, const WalkedScene& scene)
      : session_(session),
        keptApart_(scene.keptApart),
        stage_(openStage(scene.file, "preview", session.options().seed, session.stop())) {
    for (const double place : kPlaces)
      walks_.emplace_back(*stage_, scene.path, place, kSize,
                          session.options().seed + static_cast<std::uint32_t>(walks_.size()));
  }

  Ratios compare(std::uint64_t samples) {
    std::map<std::string, Errors> all;
    for (const Variant& variant : kVariants) {
      if (keptApart_ && !variant.everywhere) continue;
      for (const OrderWalk& walk : walks_) {
        session_.checkStop();
        all[variant.name].push_back(walk.walk(optionsOf(variant), samples));
      }
      Record record = errorsOf(stage_->name, variant.name, samples, all[variant.name]);
      char line[160];
      std::snprintf(line, sizeof line, "%s: rmse %.4f, FLIP weighted %.4f", record.key.c_str(),
                    record.values["rmse"].median, record.values["flip_salient"].median);
      session_.say(line);
      session_.add(std::move(record), nullptr);
    }
    Ratios ratios = ratiosOf(all);
    session_.add(againstOf(stage_->name, samples, ratios), nullptr);
    return ratios;
  }

 private:
  Session& session_;
  const bool keptApart_;
  const std::unique_ptr<Stage> stage_;
  std::vector<OrderWalk> walks_;
};

}  // namespace

void measureWalkOrder(Session& session) {
  RatiosBySamples bundled, keptApart;
  for (const WalkedScene& scene : walkedScenes(session)) {
    SceneWalks walks(session, scene);
    for (const std::uint64_t samples : kSamples) {
      Ratios& pooled = (scene.keptApart ? keptApart : bundled)[samples];
      for (const auto& [figure, values] : walks.compare(samples))
        pooled[figure].insert(pooled[figure].end(), values.begin(), values.end());
    }
  }
  for (const auto& [samples, ratios] : bundled) session.add(againstOf("bundled", samples, ratios), nullptr);
  for (const auto& [samples, ratios] : keptApart)
    session.add(againstOf("kept-apart", samples, ratios), nullptr);
}

}  // namespace saccade::bench
