#include "raytrace/bake/direct.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/math/random.h"
#include "raytrace/bake/few_lamps.h"
#include "raytrace/bake/many_lights.h"

namespace saccade::raytrace {
namespace {

/// Errors are compared with a texel's light, or with this share of what it would be without shadows.
constexpr double kShadowScale = 0.1;

/// Points that are tried for each that counts.
constexpr std::uint32_t kMostTries = 8;
/// Keeps the random numbers apart from those of particles.
constexpr std::uint32_t kDirectStream = 0x64697265u;

/// The point of the texel's covered area for u in [0, 1)^2, which it takes evenly: a (0, 2)-sequence stays
/// one, whatever triangles the texel holds. In a cell of a texel u is the place; none where no surface is.
std::optional<MeshPoint> pointOf(const TexelMap& texels, std::size_t texel, const TexelCell& cell,
                                 const Vec2& u) {
  if (!cell.whole()) return texels.pointIn(texel, cell, u);
  const std::span<const TexelFragment> parts = texels.fragments(texel);
  float below = 0, target = u.x * texels.area(texel);
  std::size_t i = 0;
  for (; i + 1 < parts.size() && target >= below + parts[i].area; ++i) below += parts[i].area;
  const float middle = (below + 0.5f * parts[i].area) / texels.area(texel);
  return texels.pointOn(texel, middle, std::clamp((target - below) / parts[i].area, 0.0f, 0x1.fffffep-1f),
                        u.y);
}

/// Estimates one texel from more and more samples.
class Integrator {
 public:
  Integrator(const World& world, const FewLamps* few, const TexelMap& texels, std::size_t texel,
             const TexelCell& cell, int layer, const DirectOptions& options, RayCounters& counters)
      : world_(world),
        few_(few),
        texels_(texels),
        texel_(texel),
        cell_(cell),
        front_(layer == 0),
        reach_(OpenArea::reach(texels, texel) / std::sqrt(static_cast<float>(cell.columns * cell.rows))),
        wholePoints_(options.wholePoints),
        stream_(kDirectStream + static_cast<std::uint32_t>(layer) + (options.alike ? 0 : cell.number())),
        seed_(options.seed),
        counters_(counters) {}

  void run(std::uint32_t until) {
    while (count_ < until && tried_ < kMostTries * until) sample();
  }

  /// Points that something covers are not to count.
  void leaveOutCovered(bool on) { leaveOut_ = on; }
  /// None was left out so far.
  bool allOpen() const { return tried_ == count_; }
  /// The points found so far.
  bool anySurface() const { return surface_; }
  bool anyOpen() const { return count_ > 0; }

  struct Result {
    DirectEstimate estimate;
    double scale = 0;  ///< luminance of what the estimate is to be compared with
  };
  Result result() const {
    if (count_ == 0) return {};
    const double n = count_;
    const LampTally::Result lamps = tally_.result();
    const double mean = core::luminance(Vec3(sum_)) / n;
    const glm::dvec3 irradiance = lamps.irradiance + sum_ / n;
    const double variance = lamps.variance + std::max(0.0, squares_ / n - mean * mean) / n;
    return {{Vec3(irradiance), static_cast<float>(variance)},
            std::max<double>(core::luminance(Vec3(irradiance)), kShadowScale * (lamps.unshadowed + mean))};
  }

 private:
  /// A point of the texel, shadow rays to the lights and, for what they find badly, a ray by the cosine.
  void sample() {
    core::PixelSampler random(static_cast<std::uint32_t>(texel_), stream_, tried_++, seed_);
    const std::optional<MeshPoint> point = pointOf(texels_, texel_, cell_, random.next2D());
    if (!point) return;
    surface_ = true;
    const Receiver at(world_, *point, front_);
    if (leaveOut_ && isCovered(world_, at.surface, reach_, counters_)) return;
    const float uLight = random.next1D();
    const Vec2 u = random.next2D();
    const EnvironmentLight* environment = world_.lights().environment();
    Vec3 sum(0);
    if (few_) few_->sample(at, uLight, u, wholePoints_, counters_, tally_);
    const LightChoice choice = few_ ? LightChoice() : world_.lights().choose(at.surface.position);
    if (!few_) sum += sampleLights(world_, at, choice, uLight, u, counters_);
    if (environment) sum += sampleEnvironment(world_, at, *environment, random.next2D(), counters_);
    if (count_++ % kCosineEvery == 0 && (environment || !few_)) {
      sum += sampleCosine(world_, at, few_ ? nullptr : &choice, random.next2D(), counters_) *
             static_cast<float>(kCosineEvery);
    }
    sum_ += sum;
    squares_ += static_cast<double>(core::luminance(sum)) * core::luminance(sum);
  }

  const World& world_;
  const FewLamps* few_;  ///< null: lamps are many
  const TexelMap& texels_;
  std::size_t texel_;
  TexelCell cell_;
  bool front_;
  float reach_;  ///< of what covers points, m
  int wholePoints_;
  bool leaveOut_ = false;
  bool surface_ = false;
  std::uint32_t stream_, seed_;
  RayCounters& counters_;
  std::uint32_t tried_ = 0, count_ = 0;
  LampTally tally_;
  glm::dvec3 sum_{0};  ///< of what the tally does not hold
  double squares_ = 0;
};

/// `cut`: the texel is known to be covered in part.
CellLight integrate(const Integrator& fresh, bool cut, const DirectOptions& options) {
  std::optional<Integrator> texel(fresh);
  texel->leaveOutCovered(cut);
  auto count = static_cast<std::uint32_t>(options.samples);
  const std::uint32_t most = count * static_cast<std::uint32_t>(options.refinement);
  while (true) {
    texel->run(count);
    if (!texel->anyOpen()) return {texel->anySurface(), false, {}};
    const Integrator::Result result = texel->result();
    const double tolerated = options.relativeError * result.scale;
    if (result.estimate.variance <= tolerated * tolerated) return {true, true, result.estimate};
    if (!cut) {  // its open area was probed at few points: look again
      cut = true;
      texel.emplace(fresh);
      texel->leaveOutCovered(true);
      continue;
    }
    if (count >= most) return {true, true, result.estimate};
    texel->leaveOutCovered(!texel->allOpen());
    count = std::min(2 * count, most);
  }
}

}  // namespace

DirectLight::DirectLight(const World& world, const TexelMap& texels, const OpenArea& open,
                         const DirectOptions& options)
    : world_(world), texels_(texels), open_(open), options_(options) {
  if (FewLamps::serves(world)) few_.emplace(world);
}

CellLight DirectLight::at(std::size_t texel, int layer, const TexelCell& cell) const {
  RayCounters own;
  const Integrator fresh(world_, few_ ? &*few_ : nullptr, texels_, texel, cell, layer, options_,
                         options_.counters ? *options_.counters : own);
  return integrate(fresh, open_.areas(layer)[texel] < texels_.area(texel), options_);
}

std::size_t directIrradiance(const World& world, const TexelMap& texels, const OpenArea& open, int layer,
                             BlockRange blocks, const DirectOptions& options, const core::Progress& progress,
                             std::span<DirectEstimate> out) {
  if (world.lights().empty()) return blocks.last;
  const DirectLight light(world, texels, open, options);
  return parallelTexels(options.threads, blocks, texels.texelCount(), progress, [&](std::size_t texel) {
    if (!(open.areas(layer)[texel] > 0)) return;
    const auto chart = static_cast<std::size_t>(texels.chartOf(texel));
    if (options.keptCharts && (*options.keptCharts)[chart]) return;
    out[texel] = light.at(texel, layer, {}).light;
  });
}

}  // namespace saccade::raytrace
