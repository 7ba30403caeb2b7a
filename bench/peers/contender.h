// A renderer in the comparison, and what it took to come how near.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/harness/record.h"
#include "bench/peers/curve.h"
#include "core/image.h"
#include "core/metrics/comparison.h"

namespace saccade::bench {

/// The picture that a renderer is to come near.
struct Truth {
  core::ImageRgb picture;
  double noise = 0;  ///< its own relative MSE, taken out of every error; > 0
};

struct Shot {
  double seconds = 0;
  core::ImageRgb linear;
};

struct Contender {
  std::string name;   ///< in keys
  std::string label;  ///< of its curve
  const Truth* truth = nullptr;
  std::vector<int> samplesPerPixel;
  std::function<Shot(int samplesPerPixel, std::uint32_t seed)> render;
  std::vector<double> bakeSeconds;  ///< empty: it needs no maps
};

/// All repeats of one number of samples a pixel.
struct Trial {
  int samplesPerPixel = 1;
  std::vector<double> seconds, errors;  ///< by repeat
  core::ImageRgb last;
  double spent = 0;  ///< seconds in all

  void add(const Shot& shot, const Truth& truth);
};

/// Relative MSE with the reference's own taken out. What is left is at least a tenth of what was taken out:
/// below that it is an estimate of nothing.
double errorWithoutNoise(const core::Comparison& measured, double noise);

/// The seconds to an error along the medians, the fastest and the slowest repeats; `further` seconds are
/// added to each (baking). Nothing where the error is not reached.
struct SecondsTo {
  Value seconds;
  bool atMost = false;
};
std::optional<SecondsTo> secondsTo(const std::vector<Trial>& trials, double error,
                                   const std::vector<double>& further);

/// a / b of two figures that each have a range: the range of the quotient is the widest.
Value quotient(const Value& a, const Value& b);

}  // namespace saccade::bench
