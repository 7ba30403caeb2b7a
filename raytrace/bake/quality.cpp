#include "raytrace/bake/quality.h"

#include <limits>

#include "core/error.h"

namespace saccade::raytrace {
namespace {

// Blocks are finer where light steps: the atlas itself need not be. High is what keeps the errors of known
// scenes (bake_truth_test.cpp) below half a percent.
constexpr Quality kQualities[] = {{.name = "preview",
                                   .errorTarget = 0.1,
                                   .texelError = 0.08,
                                   .texels = 1 << 18,
                                   .coarsest = 1,
                                   .detailTexels = 0,
                                   .detailError = 0.05,
                                   .photons = 1 << 18,
                                   .causticShare = 0,
                                   .directSamples = 4,
                                   .wholePoints = 4,
                                   .gatherRays = 0,
                                   .gatherConfidence = 0},
                                  {.name = "medium",
                                   .errorTarget = 0.05,
                                   .texelError = 0.08,
                                   .texels = 1 << 18,
                                   .coarsest = 0.5,
                                   .detailTexels = 5 << 18,
                                   .detailError = 0.02,
                                   .photons = 1 << 22,
                                   .causticShare = 240,
                                   .directSamples = 16,
                                   .wholePoints = 16,
                                   .gatherRays = 32,
                                   .gatherConfidence = 1.5f},
                                  {.name = "high",
                                   .errorTarget = 0.02,
                                   .texelError = 0.02,
                                   .texels = 1 << 21,
                                   .coarsest = 0.25,
                                   .detailTexels = 6 << 20,
                                   .detailError = 0.008,
                                   .photons = 1 << 23,
                                   .causticShare = 240,
                                   .directSamples = 64,
                                   .wholePoints = std::numeric_limits<int>::max(),
                                   .gatherRays = 128,
                                   .gatherConfidence = 0.7f}};

}  // namespace

std::span<const Quality> qualities() { return kQualities; }

const Quality& qualityOf(const std::string& name) {
  std::string names;
  for (const Quality& q : kQualities) {
    if (name == q.name) return q;
    names += std::string(names.empty() ? "" : ", ") + q.name;
  }
  throw core::UsageError("unknown quality '" + name + "': use one of " + names);
}

}  // namespace saccade::raytrace
