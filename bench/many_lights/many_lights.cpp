// Many emissive triangles: one light sample's error and cost, by the light tree beside a choice by power
// alone. Usage: bench_many_lights [SAMPLES]
#include <cmath>
#include <cstdlib>
#include <random>

#include "bench/common.h"
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

struct Result {
  double relativeError = 0;  ///< standard deviation of one sample over the mean, root mean square over points
  double nanoseconds = 0;    ///< of choosing a lamp
};

/// Chooses by `draw(point, u, lamp, probability)`; a sample is the unoccluded irradiance of the lamp's
/// centre.
template <class Draw>
Result measure(const Hall& hall, int samples, const Draw& draw) {
  constexpr int kPoints = 200;
  std::mt19937 engine(2);
  std::uniform_real_distribution<float> u(-18, 18);
  Result result;
  for (int k = 0; k < kPoints; ++k) {
    const Vec3 point(u(engine), 0, u(engine));
    double sum = 0, squares = 0;
    for (int i = 0; i < samples; ++i) {
      core::PixelSampler random(static_cast<std::uint32_t>(k), 0, static_cast<std::uint64_t>(i), 1);
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
    const double mean = sum / samples;
    result.relativeError += (squares / samples - mean * mean) / (mean * mean) / kPoints;
  }
  result.relativeError = std::sqrt(result.relativeError);
  const double seconds = timed([&] {
    float sink = 0;
    for (int i = 0; i < kPoints * samples; ++i) {
      core::PixelSampler random(static_cast<std::uint32_t>(i), 1, 0, 1);
      std::uint32_t lamp = 0;
      float probability = 0;
      draw(Vec3(static_cast<float>(i % 36) - 18, 0, 3), random.next1D(), lamp, probability);
      sink += probability;
    }
    if (sink < 0) std::printf("\n");  // never; keeps the loop
  });
  result.nanoseconds = seconds * 1e9 / (static_cast<double>(kPoints) * samples);
  return result;
}

int run(int argc, char** argv) {
  printProvenance(argc, argv);
  const int samples = argc > 1 ? std::atoi(argv[1]) : 4096;
  std::printf("%10s %8s %22s %22s %18s\n", "lamps", "depth", "error by tree, power", "ratio of samples",
              "ns by tree, power");
  for (const int count : {16, 100, 1000, 10000, 100000}) {
    const Hall hall(count);
    const double build = timed([&] { raytrace::LightTree warm(hall.lamps); });
    const raytrace::LightTree tree(hall.lamps);
    const std::vector<double> powers(hall.lamps.size(), 1);
    const raytrace::AliasTable table(powers);
    const Result byTree =
        measure(hall, samples, [&](const Vec3& p, float u, std::uint32_t& lamp, float& chance) {
          raytrace::LightTree::Drawn drawn;
          if (!tree.draw(p, u, drawn)) return false;
          lamp = drawn.lamp;
          chance = drawn.probability;
          return true;
        });
    const Result byPower =
        measure(hall, samples, [&](const Vec3&, float u, std::uint32_t& lamp, float& chance) {
          float rest = 0;
          lamp = table.sample(u, rest);
          chance = table.probability(lamp);
          return true;
        });
    const double ratio = byPower.relativeError / byTree.relativeError;
    std::printf("%10d %8d %11.2f, %9.2f %22.1f %9.0f, %7.0f   built in %.3f s\n", count, tree.depth(),
                byTree.relativeError, byPower.relativeError, ratio * ratio, byTree.nanoseconds,
                byPower.nanoseconds, build);
  }
  return 0;
}

}  // namespace
}  // namespace saccade::bench

int main(int argc, char** argv) { return saccade::bench::run(argc, argv); }
