// The sheen lobe of KHR_materials_sheen: Charlie's distribution with the shadowing of Estevez and Kulla
// (Production Friendly Microfacet Sheen BRDF, 2017), and its albedo, tabulated once.
// Departures: the lobe reflects more than 1 towards grazing angles for perceptual roughness below 0.25; there
// it is divided by the larger albedo of both directions, which stays reciprocal. Perceptual roughness below
// kSmoothestSheen is raised to it: the lobe would shrink to the horizon's last degree.
#pragma once

namespace saccade::core {

inline constexpr float kSmoothestSheen = 0.1f;

/// f cosLight for white sheen. Cosines > 0 against the normal; cosHalf: of the half vector. Roughness
/// (perceptual) in [0, 1], clamped. Any thread.
float sheenLobe(float cosView, float cosLight, float cosHalf, float roughness);
/// Albedo of white sheen seen under cosView; [0, 1]. Any thread.
float sheenAlbedo(float cosView, float roughness);
/// Cosine-weighted mean over the hemisphere. Any thread.
float sheenMeanAlbedo(float roughness);

}  // namespace saccade::core
