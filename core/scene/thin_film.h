// The thin film of KHR_materials_iridescence: Belcour and Barla, A Practical Extension to Microfacet Theory
// for the Modeling of Varying Iridescence, 2017, with the extension's Schlick Fresnel of the base and its
// Gaussian sensitivities. Departures, so that a film of no thickness is no film: the top reflects by
// Fresnel's own formula (Schlick's reflects at grazing angles where the indices are equal), and R12 R23 has
// no lower bound. The result is clamped to [0, 1], which Rec. 709 leaves for saturated fringes.
#pragma once

#include "core/math/types.h"

namespace saccade::core {

struct ThinFilm {
  float weight = 0;     ///< KHR_materials_iridescence's factor, [0, 1]
  float ior = 1.3f;     ///< >= 1
  float thickness = 0;  ///< nm; 0: no film

  explicit operator bool() const { return weight > 0 && thickness > 0; }
};

/// Reflectance in air of a film on a base of that F0, seen under a cosine in [0, 1]; the weight is left out.
Vec3 filmReflectance(const ThinFilm& film, const Vec3& baseF0, float cosine);

/// The smallest F0 with which Schlick's formula reflects no less than base and film, mixed by weight, under
/// any angle: what lies below is darkened by its albedo. The base's F0 without film.
Vec3 filmedF0(const ThinFilm& film, const Vec3& baseF0, float f90);

}  // namespace saccade::core
