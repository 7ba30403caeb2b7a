// Direct light where lamps are few: unshadowed irradiance in closed form times the share of it that is seen.
//
// Per point the irradiance of every lamp is known but for what stands in the way (polygon_light.h; punctual
// lights by their own law). One lamp is drawn by it, a place on the lamp by projected solid angle, nearly,
// and one shadow ray asks whether it is seen. The seen share of a group of lamps is the quotient of two sums
// of the same weights, seen and all (the ratio estimator: E. Heitz, S. Hill, M. McGuire, "Combining Analytic
// Direct Illumination and Stochastic Shadows", I3D 2018): exactly 1 in the open and 0 in full shadow, at any
// number of samples and any distance from a lamp. Its bias is of the order of (spread of the weights) / (rays
// to the group), in penumbrae only. Lamps with an emission texture are summed without the quotient, unbiased.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "raytrace/bake/receiver.h"
#include "raytrace/lights.h"

namespace saccade::raytrace {

/// Sums over the samples of one texel.
class LampTally;

/// Read-only once built: any thread may sample.
class FewLamps {
 public:
  /// Emissive triangles and punctual lights; where there are more this does not serve.
  static constexpr std::size_t kMost = 48;
  static bool serves(const World& world);

  /// serves(world). The world must outlive it.
  explicit FewLamps(const World& world);

  /// One sample: a shadow ray at most. uLamp in [0, 1), u in [0, 1)^2. The first `wholePoints` samples of a
  /// tally look at all lamps; where these agree the later ones look at the drawn lamp alone, drawn by what
  /// they found.
  void sample(const Receiver& at, float uLamp, const Vec2& u, int wholePoints, RayCounters& counters,
              LampTally& tally) const;

 private:
  struct Lamp {
    Vec3 corner[3];           ///< of an emissive triangle
    Vec3 normal;              ///< unit
    Vec3 radiance;            ///< textured: only its mean luminance counts
    float area = 0;           ///< m^2
    float longest = 0;        ///< edge, m
    std::int32_t light = -1;  ///< of a punctual one: index into the scene's lights
    std::uint32_t triangle = 0;
    std::uint32_t group = 0;  ///< lamps that are likely to be hidden by the same things: those of an object
    bool doubleSided = false, textured = false;
  };
  /// A way to a lamp.
  struct Way {
    LightSample light;
    float weight = 0;  ///< near 1; 0: none
    Vec2 place{0};     ///< barycentric, of textured ones
  };
  /// The lamp that a sample asks for, and its irradiance, all of it seen, over its probability.
  struct Draw {
    std::size_t lamp = 0;
    float irradiance = 0;  ///< luminance
    double weight = 0;     ///< 0: none
  };
  void addEmissive();
  void addPunctual();
  Draw drawHere(const Receiver& at, const Vec3& origin, float uLamp, LampTally& tally) const;
  Draw drawAsBefore(const Receiver& at, const Vec3& origin, float uLamp, const LampTally& tally) const;
  Vec3 unshadowed(const Lamp& lamp, const Receiver& at, const Vec3& origin) const;
  Way wayTo(const Lamp& lamp, const Receiver& at, const Vec3& origin, const Vec2& u, float irradiance) const;

  const World& world_;
  std::vector<Lamp> lamps_;
};

class LampTally {
 public:
  /// Mean irradiance of the samples so far and the variance of its luminance. Lamps of which too few rays
  /// know share their seen share.
  struct Result {
    glm::dvec3 irradiance{0};
    double variance = 0;
    double unshadowed = 0;  ///< luminance of the irradiance if nothing stood in the way
  };
  Result result() const;

 private:
  friend class FewLamps;
  /// Of one group of lamps.
  struct Group {
    glm::dvec3 unshadowed{0};
    double squares = 0;                       ///< of its luminance
    double all = 0, seen = 0;                 ///< weights
    double all2 = 0, allSeen = 0, seen2 = 0;  ///< products of them
    int rays = 0;

    void add(double weight, double free);
    void add(const Group& o);
    double share() const { return all > 0 ? seen / all : 0; }
    double shareVariance() const;
  };
  std::array<Group, FewLamps::kMost> groups_;
  std::array<double, FewLamps::kMost> ofLamp_{};  ///< luminance, all of it seen, summed over whole points
  std::size_t groupCount_ = 0;
  glm::dvec3 textured_{0};
  double texturedSquares_ = 0;
  int count_ = 0, wholePoints_ = 0;
  /// Luminance of all lamps, all of them seen: over whole points, and estimated over all samples.
  double atWholePoints_ = 0, atAll_ = 0;
  double squaresAtWholePoints_ = 0;

  bool wholePointsAgree() const;
};

}  // namespace saccade::raytrace
