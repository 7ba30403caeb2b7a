#include "core/scene/thin_film.h"

#include <algorithm>
#include <cmath>

namespace saccade::core {
namespace {

constexpr float kFullFilm = 0.03f;  ///< nm over which the film's index grows from 1 to its own

float square(float x) { return x * x; }

/// (1 - cosine)^5, what Schlick mixes by.
float fifth(float cosine) {
  const float m = std::clamp(1 - cosine, 0.0f, 1.0f);
  return square(square(m)) * m;
}

float f0OfIors(float transmitted, float incident) {
  return square((transmitted - incident) / (transmitted + incident));
}

float schlickOne(float f0, float cosine) { return f0 + (1 - f0) * fifth(cosine); }

/// Unpolarised reflectance from air into an index, both cosines known.
float interfaceReflectance(float cosine, float transmittedCosine, float ior) {
  const float g = ior * transmittedCosine;
  if (!(cosine + g > 0)) return 1;
  return 0.5f *
         (square((cosine - g) / (cosine + g)) + square((ior * ior * cosine - g) / (ior * ior * cosine + g)));
}

/// The spectrum's sum over Rec. 709's channels of a cosine of that phase: section 4 of the paper, with the
/// extension's fit. Shift: phase at reflection, by channel.
Vec3 sensitivity(float opticalPathNm, const Vec3& shift) {
  const float phase = 2 * kPi * opticalPathNm * 1e-9f;
  const auto lobe = [phase](float value, float position, float variance, float by) {
    return value * std::sqrt(2 * kPi * variance) * std::cos(position * phase + by) *
           std::exp(-square(phase) * variance);
  };
  constexpr float kNormal = 1.0685e-7f;
  const float x =
      (lobe(5.4856e-13f, 1.6810e6f, 4.3278e9f, shift.x) + lobe(9.7470e-14f, 2.2399e6f, 4.5282e9f, shift.x)) /
      kNormal;
  const float y = lobe(4.4201e-13f, 1.7953e6f, 9.3046e9f, shift.y) / kNormal;
  const float z = lobe(5.2481e-13f, 2.2084e6f, 6.6121e9f, shift.z) / kNormal;
  return {3.2404542f * x - 1.5371385f * y - 0.4985314f * z, -0.9692660f * x + 1.8760108f * y + 0.0415560f * z,
          0.0556434f * x - 0.2040259f * y + 1.0572252f * z};
}

}  // namespace

Vec3 filmReflectance(const ThinFilm& film, const Vec3& baseF0, float cosine) {
  const float s = std::clamp(film.thickness / kFullFilm, 0.0f, 1.0f);
  const float ior = 1 + (film.ior - 1) * s * s * (3 - 2 * s);
  const float cosine2 = std::sqrt(std::max(0.0f, 1 - (1 - square(cosine)) / square(ior)));
  const float r12 = std::min(1.0f, interfaceReflectance(cosine, cosine2, ior)), t121 = 1 - r12;
  Vec3 r23, shift;
  for (int c = 0; c < 3; ++c) {
    const float root = std::sqrt(std::clamp(baseF0[c], 0.0f, 0.9999f));
    const float base = (1 + root) / (1 - root);
    r23[c] = schlickOne(f0OfIors(base, ior), cosine2);
    // Of one way down and up inside the film: half a wave at its top, another one on a thinner base.
    shift[c] = kPi + (base < ior ? kPi : 0.0f);
  }
  const Vec3 r123 = glm::min(r12 * r23, Vec3(0.9999f));
  const Vec3 rs = square(t121) * r23 / (Vec3(1) - r123);
  const float path = 2 * ior * film.thickness * cosine2;
  Vec3 sum = r12 + rs;
  Vec3 amplitude = rs - t121;
  for (int m = 1; m <= 2; ++m) {
    const auto order = static_cast<float>(m);
    amplitude *= glm::sqrt(r123);
    sum += amplitude * 2.0f * sensitivity(order * path, order * shift);
  }
  return glm::clamp(sum, Vec3(0), Vec3(1));
}

Vec3 filmedF0(const ThinFilm& film, const Vec3& baseF0, float f90) {
  if (!film) return baseF0;
  constexpr int kAngles = 16;
  Vec3 bound = baseF0;
  for (int i = 1; i <= kAngles; ++i) {
    const float cosine = static_cast<float>(i) / kAngles, grazing = fifth(cosine);
    const Vec3 plain = baseF0 + (Vec3(f90) - baseF0) * grazing;
    const Vec3 mixed = glm::mix(plain, filmReflectance(film, baseF0, cosine) * f90, film.weight);
    bound = glm::max(bound, (mixed - f90 * grazing) / std::max(1 - grazing, 1e-3f));
  }
  return glm::min(bound, Vec3(1));
}

}  // namespace saccade::core
