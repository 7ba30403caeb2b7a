#include "app/recording/session_comparison.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "core/error.h"
#include "core/metrics/comparison.h"

namespace saccade::app {

void SessionComparison::add(std::int64_t number, double seconds, const core::ImageRgba8& reference,
                            const core::ImageRgba8& test) {
  try {
    const core::Comparison c = core::compareDisplay(reference, test);
    frames_.push_back({number, seconds, c.rmse, c.flip});
  } catch (const core::Error& e) {
    throw core::Error("frame " + std::to_string(number) + ": " + e.what());
  }
}

void SessionComparison::print(bool json) const {
  if (frames_.empty()) throw core::Error("there is no frame that both have; nothing is compared");
  double rmse = 0, flip = 0;
  for (const Frame& f : frames_) rmse += f.rmse, flip += f.flip;
  rmse /= static_cast<double>(frames_.size());
  flip /= static_cast<double>(frames_.size());
  const Frame& worst = *std::max_element(frames_.begin(), frames_.end(),
                                         [](const Frame& a, const Frame& b) { return a.flip < b.flip; });
  if (json) {
    nlohmann::ordered_json out;
    for (const Frame& f : frames_)
      out["frames"].push_back(
          {{"frame", f.number}, {"seconds", f.seconds}, {"rmse", f.rmse}, {"flip", f.flip}});
    out["mean"] = {{"rmse", rmse}, {"flip", flip}};
    out["worst"] = worst.number;
    std::printf("%s\n", out.dump(2).c_str());
    return;
  }
  std::printf("%7s %9s %9s %9s\n", "frame", "seconds", "RMSE", "FLIP");
  for (const Frame& f : frames_)
    std::printf("%7lld %9.3f %9.5f %9.5f\n", static_cast<long long>(f.number), f.seconds, f.rmse, f.flip);
  std::printf("%7s %9s %9.5f %9.5f; worst by FLIP: frame %lld\n", "mean", "", rmse, flip,
              static_cast<long long>(worst.number));
}

}  // namespace saccade::app
