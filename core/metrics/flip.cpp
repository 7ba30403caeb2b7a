#include "core/metrics/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

#include "core/error.h"
#include "core/image_io.h"
#include "core/metrics/separable.h"

namespace saccade::core {
namespace {

// Section 4.1 (color) and 4.2 (features) of the paper; its symbols.
constexpr double kPiD = 3.14159265358979323846;
constexpr double kPi2 = kPiD * kPiD;
constexpr double kQc = 0.7, kPc = 0.4, kPt = 0.95;
constexpr double kQf = 0.5, kFeatureWidthDegrees = 0.082;

/// Contrast sensitivity in space: a1 sqrt(pi / b1) exp(-pi^2 x^2 / b1) + a2 sqrt(pi / b2) exp(-pi^2 x^2 /
/// b2), x in degrees (Table 1).
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr Sensitivity kAchromatic{1, 0.0047, 0, 1e-5};
constexpr Sensitivity kRedGreen{1, 0.0053, 0, 1e-5};
constexpr Sensitivity kBlueYellow{34.1, 0.04, 13.5, 0.025};
constexpr double kWidestB = 0.04;

const glm::dvec3 kWhite{0.950428545, 1, 1.088900371};

glm::dvec3 xyzOf(const glm::dvec3& rgb) {
  return {(10135552 * rgb.x + 8788810 * rgb.y + 4435075 * rgb.z) / 24577794,
          (2613072 * rgb.x + 8788810 * rgb.y + 887015 * rgb.z) / 12288897,
          (1425312 * rgb.x + 8788810 * rgb.y + 70074185 * rgb.z) / 73733382};
}

glm::dvec3 rgbOf(const glm::dvec3& xyz) {
  static const glm::dmat3 inverse =
      glm::inverse(glm::dmat3(xyzOf({1, 0, 0}), xyzOf({0, 1, 0}), xyzOf({0, 0, 1})));
  return inverse * xyz;
}

/// Linear opponent space: Y, Cx, Cz.
glm::dvec3 opponentOf(const glm::dvec3& rgb) {
  const glm::dvec3 r = xyzOf(rgb) / kWhite;
  return {116 * r.y - 16, 500 * (r.x - r.y), 200 * (r.y - r.z)};
}

glm::dvec3 rgbOfOpponent(const glm::dvec3& o) {
  const double y = (o.x + 16) / 116;
  return rgbOf(glm::dvec3(y + o.y / 500, y, y - o.z / 200) * kWhite);
}

/// CIELAB with the Hunt effect: chroma grows with lightness.
glm::dvec3 huntLabOf(const glm::dvec3& rgb) {
  const auto f = [](double t) {
    constexpr double d = 6.0 / 29;
    return t > d * d * d ? std::cbrt(t) : t / (3 * d * d) + 4.0 / 29;
  };
  const glm::dvec3 r = xyzOf(rgb) / kWhite;
  const double fx = f(r.x), fy = f(r.y), fz = f(r.z);
  const double lightness = 116 * fy - 16;
  return {lightness, 0.01 * lightness * 500 * (fx - fy), 0.01 * lightness * 200 * (fy - fz)};
}

double hyAb(const glm::dvec3& a, const glm::dvec3& b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

/// One image in Y, Cx, Cz planes.
using Planes = std::array<ImageGray, 3>;

constexpr std::size_t kPollPixels = 1 << 14;  ///< between two looks at the stop flag: some milliseconds

void poll(const std::stop_token& stop) {
  if (stop.stop_requested()) throw Error("FLIP was stopped");
}

Planes opponentPlanes(const ImageRgba8& image) {
  std::array<double, 256> linear{};
  for (int code = 0; code < 256; ++code) linear[code] = decodeSrgb(static_cast<float>(code) / 255);
  Planes planes;
  planes.fill(ImageGray(image.width(), image.height()));
  for (std::size_t i = 0; i < image.pixels().size(); ++i) {
    const Rgba8& p = image.pixels()[i];
    const glm::dvec3 o = opponentOf({linear[p.r], linear[p.g], linear[p.b]});
    for (int c = 0; c < 3; ++c) planes[c].pixels()[i] = static_cast<float>(o[c]);
  }
  return planes;
}

std::vector<double> gaussian(double perSquare, int radius) {
  std::vector<double> g;
  for (int i = -radius; i <= radius; ++i) g.push_back(std::exp(-perSquare * i * i));
  return g;
}

std::vector<float> scaled(const std::vector<double>& weights, double factor) {
  std::vector<float> out;
  out.reserve(weights.size());
  for (double w : weights) out.push_back(static_cast<float>(w * factor));
  return out;
}

double sumOf(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); }

/// The filter is a sum of two Gaussians of the distance, each of them separable; normalised to sum 1
/// together.
ImageGray filterBySensitivity(const ImageGray& plane, const Sensitivity& s, double ppd) {
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(kWidestB / (2 * kPi2)) * ppd));
  const auto g1 = gaussian(kPi2 / (s.b1 * ppd * ppd), radius);
  const auto g2 = gaussian(kPi2 / (s.b2 * ppd * ppd), radius);
  const double weight1 = s.a1 * std::sqrt(kPiD / s.b1), weight2 = s.a2 * std::sqrt(kPiD / s.b2);
  const double total = weight1 * sumOf(g1) * sumOf(g1) + weight2 * sumOf(g2) * sumOf(g2);
  ImageGray out = filterSeparable(plane, scaled(g1, weight1 / total), scaled(g1, 1));
  if (s.a2 == 0) return out;
  const ImageGray second = filterSeparable(plane, scaled(g2, weight2 / total), scaled(g2, 1));
  std::transform(out.pixels().begin(), out.pixels().end(), second.pixels().begin(), out.pixels().begin(),
                 std::plus<>());
  return out;
}

/// What the eye sees of the colours: filtered, back in the gamut, in a perceptually uniform space.
std::vector<glm::dvec3> perceivedColors(const Planes& planes, double ppd, const std::stop_token& stop) {
  const ImageGray y = filterBySensitivity(planes[0], kAchromatic, ppd);
  poll(stop);
  const ImageGray cx = filterBySensitivity(planes[1], kRedGreen, ppd);
  poll(stop);
  const ImageGray cz = filterBySensitivity(planes[2], kBlueYellow, ppd);
  std::vector<glm::dvec3> colors(y.pixels().size());
  for (std::size_t i = 0; i < colors.size(); ++i) {
    if (i % kPollPixels == 0) poll(stop);
    const glm::dvec3 rgb = rgbOfOpponent({y.pixels()[i], cx.pixels()[i], cz.pixels()[i]});
    colors[i] = huntLabOf(glm::clamp(rgb, 0.0, 1.0));
  }
  return colors;
}

/// Compresses large colour differences into the last 5 % (section 4.1.3).
double redistribute(double difference) {
  static const double largest = std::pow(hyAb(huntLabOf({0, 1, 0}), huntLabOf({0, 0, 1})), kQc);
  const double knee = kPc * largest;
  const double powered = std::pow(difference, kQc);
  return powered < knee ? kPt / knee * powered : kPt + (powered - knee) / (largest - knee) * (1 - kPt);
}

/// Derivative weights along one axis; positive ones sum to 1 and negative ones to -1 once multiplied by the
/// normalised Gaussian of the other axis.
std::vector<float> normalisedBySign(const std::vector<double>& weights) {
  double positive = 0, negative = 0;
  for (double w : weights) (w > 0 ? positive : negative) += w;
  std::vector<float> out;
  out.reserve(weights.size());
  for (double w : weights) out.push_back(static_cast<float>(w / (w > 0 ? positive : -negative)));
  return out;
}

struct FeatureFilters {
  std::vector<float> smooth, edge, point;

  explicit FeatureFilters(double ppd) {
    const double sigma = 0.5 * kFeatureWidthDegrees * ppd;
    const int radius = static_cast<int>(std::ceil(3 * sigma));
    const auto g = gaussian(1 / (2 * sigma * sigma), radius);
    std::vector<double> first, second;
    for (int i = -radius; i <= radius; ++i) {
      first.push_back(-i * g[i + radius]);
      second.push_back((i * i / (sigma * sigma) - 1) * g[i + radius]);
    }
    smooth = scaled(g, 1 / sumOf(g));
    edge = normalisedBySign(first);
    point = normalisedBySign(second);
  }
};

/// Length of the gradient (or of the second derivatives) of the achromatic plane at each pixel.
ImageGray featureStrength(const ImageGray& achromatic, const std::vector<float>& derivative,
                          const std::vector<float>& smooth) {
  ImageGray strength = filterSeparable(achromatic, derivative, smooth);
  const ImageGray alongY = filterSeparable(achromatic, smooth, derivative);
  std::transform(strength.pixels().begin(), strength.pixels().end(), alongY.pixels().begin(),
                 strength.pixels().begin(), [](float x, float y) { return std::sqrt(x * x + y * y); });
  return strength;
}

/// Differences of edge and point content, each pixel in [0, 1] (section 4.2).
ImageGray featureDifference(ImageGray reference, ImageGray test, double ppd, const std::stop_token& stop) {
  for (ImageGray* plane : {&reference, &test}) {
    for (float& y : plane->pixels()) y = (y + 16) / 116;
  }
  const FeatureFilters filters(ppd);
  const ImageGray edgeR = featureStrength(reference, filters.edge, filters.smooth);
  poll(stop);
  const ImageGray edgeT = featureStrength(test, filters.edge, filters.smooth);
  poll(stop);
  const ImageGray pointR = featureStrength(reference, filters.point, filters.smooth);
  poll(stop);
  const ImageGray pointT = featureStrength(test, filters.point, filters.smooth);
  ImageGray out(reference.width(), reference.height());
  for (std::size_t i = 0; i < out.pixels().size(); ++i) {
    if (i % kPollPixels == 0) poll(stop);
    const float edge = std::abs(edgeR.pixels()[i] - edgeT.pixels()[i]);
    const float point = std::abs(pointR.pixels()[i] - pointT.pixels()[i]);
    const double larger = std::max(edge, point);
    out.pixels()[i] = static_cast<float>(std::min(1.0, std::pow(larger / std::sqrt(2.0), kQf)));
  }
  return out;
}

}  // namespace

ImageGray flip(const ImageRgba8& reference, const ImageRgba8& test, double pixelsPerDegree,
               const std::stop_token& stop) {
  const Planes planesR = opponentPlanes(reference), planesT = opponentPlanes(test);
  const auto colorsR = perceivedColors(planesR, pixelsPerDegree, stop);
  const auto colorsT = perceivedColors(planesT, pixelsPerDegree, stop);
  ImageGray map = featureDifference(planesR[0], planesT[0], pixelsPerDegree, stop);
  for (std::size_t i = 0; i < map.pixels().size(); ++i) {
    if (i % kPollPixels == 0) poll(stop);
    const double color = std::clamp(redistribute(hyAb(colorsR[i], colorsT[i])), 0.0, 1.0);
    map.pixels()[i] = static_cast<float>(std::pow(color, 1 - double{map.pixels()[i]}));
  }
  return map;
}

double meanOf(const ImageGray& map) {
  if (map.empty()) return 0;
  return std::accumulate(map.pixels().begin(), map.pixels().end(), 0.0) /
         static_cast<double>(map.pixels().size());
}

double weightedMeanOf(const ImageGray& map, const ImageGray& weights) {
  if (map.width() != weights.width() || map.height() != weights.height())
    throw Error("an error map and its weights differ in size: give both the reference's");
  double sum = 0, total = 0;
  for (std::size_t i = 0; i < map.pixels().size(); ++i) {
    sum += static_cast<double>(weights.pixels()[i]) * map.pixels()[i];
    total += weights.pixels()[i];
  }
  return total > 0 ? sum / total : meanOf(map);
}

double weightedPercentile(const ImageGray& map, double fraction) {
  std::vector<float> values = map.pixels();
  std::sort(values.begin(), values.end());
  const double wanted = fraction * std::accumulate(values.begin(), values.end(), 0.0);
  double sum = 0;
  for (float v : values) {
    sum += v;
    if (sum >= wanted) return v;
  }
  return values.empty() ? 0 : values.back();
}

}  // namespace saccade::core
