#include "core/corrective/change_rate.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace saccade::core {
namespace {

/// Samples ahead in lattice order among which neighbours are looked for.
constexpr std::size_t kWindow = 32;
/// Reflected rays nearer to each other than this (radians) say more about noise than about the scene.
constexpr float kSmallestTurn = 0.05f;

/// A correction as displays show it, nearly: differences of it are what one sees. Signed.
Vec3 asDisplayed(const Vec3& correction) {
  const auto curve = [](float c) { return std::copysign(std::sqrt(std::abs(c)), c); };
  return {curve(correction.x), curve(correction.y), curve(correction.z)};
}

float largestOf(const Vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// The pairs that a sample is part of.
struct Neighbourhood {
  float changes = 0;  ///< displayed, sum
  float turns = 0;    ///< of the reflected ray, radians, sum
};

struct Reflected {
  Vec3 direction, shown;
};

bool near(const Sample& a, const Sample& b) {
  const std::int64_t dx = a.x - b.x, dy = a.y - b.y;
  return dx * dx + dy * dy <= 4 * std::int64_t{Lattice::step(a.level)};  // two steps of the lattice
}

}  // namespace

void estimateChangeRates(std::span<Sample> samples) {
  // A ring of those that later samples may still be neighbours of.
  std::array<Reflected, kWindow> reflected;
  std::array<Neighbourhood, kWindow> around;
  const auto finish = [&](std::size_t i) {
    const Neighbourhood& n = around[i % kWindow];
    // One pair as usual is added to those that were found, so that few of them do not decide alone.
    const float found = (n.changes + kUsualChangeRate * kSmallestTurn) / (n.turns + kSmallestTurn);
    samples[i].changeRate = kUsualChangeRate + found;
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i >= kWindow) finish(i - kWindow);
    const Sample& s = samples[i];
    Reflected& here = reflected[i % kWindow];
    here = {2 * glm::dot(s.normal, s.toEye) * s.normal - s.toEye, asDisplayed(s.correction)};
    Neighbourhood& own = around[i % kWindow] = {};
    for (std::size_t j = i - std::min(i, kWindow - 1); j < i; ++j) {
      if (!near(s, samples[j])) continue;
      const Reflected& there = reflected[j % kWindow];
      const float change = largestOf(here.shown - there.shown);
      const float turn = std::max(glm::length(here.direction - there.direction), kSmallestTurn);
      for (Neighbourhood* n : {&own, &around[j % kWindow]}) n->changes += change, n->turns += turn;
    }
  }
  for (std::size_t i = samples.size() - std::min(samples.size(), kWindow); i < samples.size(); ++i) finish(i);
}

}  // namespace saccade::core
