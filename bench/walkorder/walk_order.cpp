#include "bench/walkorder/walk_order.h"

#include <cstdio>
#include <map>
#include <vector>

#include "bench/walkorder/walk.h"

namespace saccade::bench {
namespace {

using attention::Order;

constexpr app::ImageSize kSize{512, 512};
constexpr std::uint64_t kSamples[] = {1000, 5000, 20000};
constexpr std::uint32_t kSeeds[] = {1, 2, 3};  ///< of random order
constexpr float kTenPercent = 0.1f;
constexpr const char* kScenes[] = {"gallery", "table", "ward", "cornell"};
constexpr const char* kUsual = "attention";

struct Variant {
  const char* name;
  Order order;
  float attention = 0.5f;
  float inhibition = core::RegionQueue::kInhibition;
};

// The usual one first.
constexpr Variant kVariants[] = {{kUsual, Order::attention},
                                 {"importance", Order::importance},
                                 {"gain", Order::gain},
                                 {"saliency", Order::attention, 0},
                                 {"task", Order::task},
                                 {"random", Order::random},
                                 {"scanline", Order::scanline},
                                 {"largest", Order::largest},
                                 {"importance-10-percent", Order::importance, 0.5f, kTenPercent},
                                 {"random-10-percent", Order::random, 0.5f, kTenPercent},
                                 {"scanline-10-percent", Order::scanline, 0.5f, kTenPercent},
                                 {"largest-10-percent", Order::largest, 0.5f, kTenPercent},
                                 {"winner-takes-all", Order::importance, 0.5f, 0}};

app::CorrectiveOptions optionsOf(const Variant& variant) {
  app::CorrectiveOptions options;
  options.attention.order = variant.order;
  options.attention.attention = variant.attention;
  options.inhibition = variant.inhibition;
  return options;
}

using Errors = std::vector<WalkError>;  ///< by seed

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

/// The usual order's error over every other's, each seed over its own.
Record againstOf(const std::string& scene, std::uint64_t samples, const std::map<std::string, Errors>& all) {
  Record record = recordOf(scene, "against", samples);
  const Errors& ours = all.at(kUsual);
  for (const auto& [name, errors] : all) {
    if (name == kUsual) continue;
    const Errors& theirs = errors;
    const auto over = [&](double WalkError::*figure) {
      std::vector<double> ratios;
      for (std::size_t i = 0; i < theirs.size(); ++i) ratios.push_back(ours[i].*figure / (theirs[i].*figure));
      return Value::ratio(ratios, Better::lower);
    };
    record.values["flip_salient_over_" + name] = over(&WalkError::flipSalient);
    record.values["rmse_over_" + name] = over(&WalkError::rmse);
  }
  return record;
}

}  // namespace

void measureWalkOrder(Session& session) {
  for (const char* scene : kScenes) {
    const auto stage = openStage(bundledScene(scene), "preview", kSeeds[0], session.stop());
    const auto path = app::CameraPath::read(bundledPath(scene));
    std::vector<OrderWalk> walks;
    for (const std::uint32_t seed : kSeeds) walks.emplace_back(*stage, path, kSize, seed);
    for (const std::uint64_t samples : kSamples) {
      std::map<std::string, Errors> all;
      for (const Variant& variant : kVariants) {
        Errors& errors = all[variant.name];
        // What random order is put beside has its seeds, too.
        const bool everySeed = variant.order == Order::random || variant.name == std::string(kUsual);
        for (const OrderWalk& walk : walks) {
          session.checkStop();
          errors.push_back(walk.walk(optionsOf(variant), samples));
          if (!everySeed) break;
        }
        Record record = errorsOf(scene, variant.name, samples, errors);
        char line[128];
        std::snprintf(line, sizeof line, "%s: rmse %.4f, FLIP weighted %.4f", record.key.c_str(),
                      record.values["rmse"].median, record.values["flip_salient"].median);
        session.say(line);
        session.add(std::move(record), nullptr);
      }
      session.add(againstOf(scene, samples, all), nullptr);
    }
  }
}

}  // namespace saccade::bench
