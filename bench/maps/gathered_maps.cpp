#include "bench/maps/gathered_maps.h"

#include <algorithm>
#include <glm/gtc/packing.hpp>

#include "bench/harness/trials.h"
#include "raytrace/bake/gutters.h"
#include "raytrace/bake/path_gather.h"

namespace saccade::bench {
namespace {

constexpr float kLargestHalf = 65504;

}  // namespace

GatheredMaps::GatheredMaps(const app::Workspace& opened, std::uint32_t seed, int threads)
    : opened_(opened),
      texels_(opened.scene, opened.maps.width),
      seed_(seed),
      threads_(threads),
      sums_(static_cast<std::size_t>(opened.maps.layers),
            std::vector<core::Vec3>(texels_.texelCount(), core::Vec3(0))) {}

double GatheredMaps::growTo(std::uint64_t paths, const core::Progress& progress) {
  seconds_ += timed([&] {
    raytrace::PathGatherOptions options;
    options.firstPath = paths_;
    options.paths = paths - paths_;
    options.seed = seed_;
    options.threads = threads_;
    for (std::size_t layer = 0; layer < sums_.size(); ++layer) {
      const auto share = [&](double f) {
        if (progress.report)
          progress.report((static_cast<double>(layer) + f) / static_cast<double>(sums_.size()));
      };
      raytrace::gatherPaths(*opened_.world, texels_, static_cast<int>(layer), options, {share, progress.stop},
                            sums_[layer]);
    }
  });
  paths_ = paths;
  return seconds_;
}

core::IlluminationMaps GatheredMaps::maps(double& seconds) const {
  core::IlluminationMaps out;
  seconds += timed([&] {
    out.width = out.height = texels_.size();
    out.layers = static_cast<int>(sums_.size());
    out.texels.reserve(sums_.size() * texels_.texelCount() * 3);
    for (std::vector<core::Vec3> layer : sums_) {
      for (core::Vec3& e : layer) e /= static_cast<float>(paths_);
      raytrace::fillGutters(texels_, layer);
      for (const core::Vec3& e : layer) {
        for (int c = 0; c < 3; ++c)
          out.texels.push_back(glm::packHalf1x16(std::clamp(e[c], 0.0f, kLargestHalf)));
      }
    }
  });
  return out;
}

}  // namespace saccade::bench
