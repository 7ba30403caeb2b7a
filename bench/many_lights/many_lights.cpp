#include "bench/many_lights/many_lights.h"

#include <cmath>
#include <random>

#include "core/math/random.h"
#include "raytrace/alias_table.h"
#include "raytrace/light_tree.h"
#include "raytrace/lights.h"

namespace saccade::bench {
namespace {

using core::Vec3;

/// A hall of 40 x 40 m under a ceiling of small lamps, all of the same power, that face anywhere.
struct Hall {
  core::Scene scene;
  std::vector<raytrace::LightBounds> lamps;

  explicit Hall(int count) {
    std::mt19937 engine(1);
    std::uniform_real_distribution<float> u(-1, 1);
    core::Material glowing;
    glowing.baseColor = Vec3(0);
    glowing.emission = Vec3(1);
    scene.materials.push_back(glowing);
    core::Mesh mesh;
    for (int i = 0; i < count; ++i) {
      const Vec3 center(20 * u(engine), 2.5f + 0.5f * u(engine), 20 * u(engine));
      const Vec3 normal = glm::normalize(Vec3(u(engine), u(engine), u(engine)) + Vec3(1e-3f));
      const Vec3 a = glm::normalize(glm::cross(normal, Vec3(0.3f, 0.5f, 0.8f))), b = glm::cross(normal, a);
      raytrace::LightBounds lamp;
      lamp.axis = normal;
      lamp.emission = core::kPi / 2;
      for (const Vec3& corner : {a, -0.5f * a + 0.866f * b, -0.5f * a - 0.866f * b}) {
        mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.positions.push_back(center + 0.03f * corner);
        mesh.normals.push_back(normal);
        lamp.box.add(mesh.positions.back());
      }
      lamp.power = 1;
      lamps.push_back(lamp);
    }
    core::Object object;
    for (const Vec3& p : mesh.positions) object.bounds.add(p);
    scene.bounds = object.bounds;
    scene.meshes.push_back(std::move(mesh));
    scene.objects.push_back(std::move(object));
  }
};

constexpr int kPoints = 200;     ///< on the floor
constexpr int kSamples = 1024;   ///< a point, for the error
constexpr int kDraws = 100'000;  ///< of one timing

/// Chooses a lamp for a point from one uniform number; false: none.
using Draw = std::function<bool(const Vec3& point, float u, std::uint32_t& lamp, float& probability)>;

/// Variance over squared mean of one sample at a point: the unoccluded irradiance of the chosen lamp's
/// centre.
double relativeVariance(const Hall& hall, const Vec3& point, std::uint32_t index, const Draw& draw) {
  double sum = 0, squares = 0;
  for (int i = 0; i < kSamples; ++i) {
    core::PixelSampler random(index, 0, static_cast<std::uint64_t>(i), 1);
    std::uint32_t lamp = 0;
    float probability = 0;
    if (!draw(point, random.next1D(), lamp, probability)) continue;
    const Vec3 to = hall.lamps[lamp].box.center() - point;
    const float squared = glm::dot(to, to);
    const float cosine = -glm::dot(hall.lamps[lamp].axis, to) / std::sqrt(squared);
    const double e =
        cosine > 0 ? static_cast<double>(cosine * to.y / (squared * std::sqrt(squared)) / probability) : 0;
    sum += e;
    squares += e * e;
  }
  const double mean = sum / kSamples;
  return (squares / kSamples - mean * mean) / (mean * mean);
}

/// Standard deviation of one sample over the mean, root mean square over the floor.
double relativeError(const Hall& hall, const Draw& draw) {
  std::mt19937 engine(2);
  std::uniform_real_distribution<float> u(-18, 18);
  double sum = 0;
  for (std::uint32_t k = 0; k < kPoints; ++k) {
    const Vec3 point(u(engine), 0, u(engine));
    sum += relativeVariance(hall, point, k, draw);
  }
  return std::sqrt(sum / kPoints);
}

/// Of choosing a lamp.
double nanoseconds(const Draw& draw) {
  volatile float sink = 0;  // keeps the loop
  const double seconds = timed([&] {
    float sum = 0;
    for (int i = 0; i < kDraws; ++i) {
      core::PixelSampler random(static_cast<std::uint32_t>(i), 1, 0, 1);
      std::uint32_t lamp = 0;
      float probability = 0;
      draw(Vec3(static_cast<float>(i % 36) - 18, 0, 3), random.next1D(), lamp, probability);
      sum += probability;
    }
    sink = sum;
  });
  return 1e9 * seconds / kDraws;
}

Value nanosecondsOf(const std::vector<double>& repeats) {
  Value value = Value::milliseconds(repeats);
  value.unit = "ns";
  return value;
}

Record measureHall(int lamps, const std::stop_token& stop) {
  const Hall hall(lamps);
  std::optional<raytrace::LightTree> tree;
  std::vector<double> buildSeconds;
  for (int i = 0; i < kRepeats; ++i) buildSeconds.push_back(timed([&] { tree.emplace(hall.lamps); }));
  const raytrace::AliasTable table(std::vector<double>(hall.lamps.size(), 1));
  const Draw byTree = [&](const Vec3& point, float u, std::uint32_t& lamp, float& probability) {
    raytrace::LightTree::Drawn drawn;
    if (!tree->draw(point, u, drawn)) return false;
    lamp = drawn.lamp;
    probability = drawn.probability;
    return true;
  };
  const Draw byPower = [&](const Vec3&, float u, std::uint32_t& lamp, float& probability) {
    float rest = 0;
    lamp = table.sample(u, rest);
    probability = table.probability(lamp);
    return true;
  };
  std::vector<double> treeNs, powerNs;
  alternate(2, kRepeats, stop, [&](int variant, int round) {
    const double ns = nanoseconds(variant == 0 ? byTree : byPower);
    if (round >= 0) (variant == 0 ? treeNs : powerNs).push_back(ns);
  });
  const double treeError = relativeError(hall, byTree), powerError = relativeError(hall, byPower);
  Record record;
  record.key = "many-lights/" + std::to_string(lamps);
  record.at = {{"lamps", lamps}};
  record.values = {{"depth", Value::count(tree->depth())},
                   {"error_tree", Value::error(treeError)},
                   {"error_power", Value::error(powerError)},
                   {"fewer_samples", Value::ratio({std::pow(powerError / treeError, 2)}, Better::higher)},
                   {"choice_tree", nanosecondsOf(treeNs)},
                   {"choice_power", nanosecondsOf(powerNs)},
                   {"build", Value::seconds(buildSeconds)}};
  return record;
}

}  // namespace

void measureManyLights(Session& session) {
  const std::vector<int> counts =
      session.quick() ? std::vector<int>{100, 1000} : std::vector<int>{16, 100, 1000, 10000, 100000};
  for (const int lamps : counts) {
    session.say("many-lights: " + std::to_string(lamps));
    const LoadWatch watch;
    const Pinned one(mainCores());
    session.add(measureHall(lamps, session.stop()), &watch);
  }
}

}  // namespace saccade::bench
