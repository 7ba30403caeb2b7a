#include "data/make_scenes/paintings.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "data/make_scenes/noise.h"
#include "data/make_scenes/textures.h"

namespace saccade::data {
namespace {

using core::kPi;
using core::Vec2;
using core::Vec3;

/// What a manner may ask: the place p (x to the right in [0, aspect], y downwards in [0, 1]), and numbers
/// that are fixed for the picture.
struct Canvas {
  Vec2 p;
  float aspect;
  std::uint32_t seed;

  float pick(std::uint32_t k, std::uint32_t j = 0) const { return hash01(seed, k, j); }
  float pick(std::uint32_t k, float lo, float hi) const { return lo + (hi - lo) * pick(k); }
  float noise(Vec2 at, int octaves, std::uint32_t k = 0) const {
    return fbm(at, octaves, 0, seed * 131U + k);
  }
};

constexpr std::array<std::array<Vec3, 5>, 8> kPalettes{{
    {{{.90f, .85f, .72f}, {.75f, .22f, .13f}, {.15f, .22f, .36f}, {.93f, .66f, .20f}, {.28f, .42f, .36f}}},
    {{{.95f, .91f, .84f}, {.11f, .28f, .44f}, {.86f, .39f, .25f}, {.41f, .62f, .66f}, {.96f, .77f, .42f}}},
    {{{.16f, .13f, .16f}, {.62f, .16f, .20f}, {.88f, .58f, .36f}, {.36f, .25f, .42f}, {.94f, .84f, .68f}}},
    {{{.87f, .90f, .88f}, {.20f, .40f, .34f}, {.55f, .66f, .36f}, {.86f, .76f, .36f}, {.30f, .24f, .20f}}},
    {{{.12f, .16f, .28f}, {.20f, .38f, .60f}, {.90f, .80f, .48f}, {.52f, .68f, .78f}, {.80f, .42f, .30f}}},
    {{{.93f, .86f, .80f}, {.80f, .52f, .50f}, {.46f, .30f, .42f}, {.34f, .46f, .54f}, {.88f, .72f, .58f}}},
    {{{.20f, .20f, .18f}, {.84f, .81f, .72f}, {.60f, .48f, .32f}, {.40f, .18f, .12f}, {.72f, .66f, .50f}}},
    {{{.96f, .94f, .88f}, {.10f, .10f, .12f}, {.84f, .12f, .12f}, {.14f, .28f, .62f}, {.96f, .82f, .16f}}},
}};

const Vec3& tone(const Canvas& c, std::uint32_t k) {
  return kPalettes[static_cast<std::size_t>(c.pick(900) * 8)][k % 5];
}

Vec3 sky(const Canvas& c, float y) {
  static const std::array<std::array<Vec3, 2>, 4> kSkies{{{{{.36f, .55f, .78f}, {.93f, .88f, .78f}}},
                                                          {{{.22f, .24f, .46f}, {.95f, .60f, .38f}}},
                                                          {{{.55f, .63f, .68f}, {.88f, .86f, .80f}}},
                                                          {{{.08f, .11f, .24f}, {.36f, .38f, .52f}}}}};
  const auto& pair = kSkies[static_cast<std::size_t>(c.pick(901) * 4)];
  const float clouds = glm::smoothstep(.5f, .75f, c.noise(c.p * Vec2(2.5f, 7), 5, 1));
  return glm::mix(glm::mix(pair[0], pair[1], glm::clamp(y, 0.f, 1.f)), Vec3(.97f, .93f, .88f), .5f * clouds);
}

/// Mountains behind mountains above a lake.
Vec3 mountains(const Canvas& c) {
  const float shore = c.pick(1, .68f, .8f);
  const bool water = c.p.y > shore;
  const float y =
      water ? 2 * shore - c.p.y + .012f * std::sin(c.p.y * 160 + 8 * c.noise(c.p * 9.f, 2, 7)) : c.p.y;
  Vec3 color = sky(c, y / shore);
  const Vec2 sun(c.aspect * c.pick(2, .2f, .8f), c.pick(3, .12f, .3f));
  color =
      glm::mix(Vec3(1, .95f, .8f), color, glm::smoothstep(.045f, .06f, glm::distance(Vec2(c.p.x, y), sun)));
  for (std::uint32_t k = 0; k < 4; ++k) {
    const auto depth = static_cast<float>(k) / 4;
    const float ridge =
        shore -
        (1 - depth) * .42f * c.noise(Vec2(c.p.x * (2 + depth * 3) + 9 * depth, depth * 5), 5, 20 + k) - .02f;
    if (y > ridge)
      color = glm::mix(glm::mix(color, tone(c, 4), .25f), tone(c, 1) * .55f, .35f + .55f * depth);
  }
  return water ? color * Vec3(.72f, .8f, .86f) : color;
}

Vec3 seascape(const Canvas& c) {
  const float horizon = c.pick(1, .38f, .55f);
  if (c.p.y < horizon) return sky(c, c.p.y / horizon);
  const float depth = (c.p.y - horizon) / (1 - horizon);
  const float wave = c.noise(Vec2(c.p.x * 5 / (.15f + depth), 1 / (.05f + depth) * 6), 4, 3);
  const float glitter = std::exp(-std::abs(c.p.x - c.aspect * c.pick(2, .3f, .7f)) * (14 - 9 * depth));
  const Vec3 deep = glm::mix(Vec3(.30f, .46f, .52f), Vec3(.06f, .20f, .28f), depth);
  const Vec3 lit = glm::mix(deep, Vec3(.86f, .88f, .82f), glm::smoothstep(.58f, .78f, wave));
  return glm::mix(lit, Vec3(1, .9f, .7f), glitter * glm::smoothstep(.45f, .6f, wave));
}

/// Soft-edged fields of colour on a ground.
Vec3 colorField(const Canvas& c) {
  const auto fields = 2 + static_cast<std::uint32_t>(c.pick(1) * 2);
  const Vec2 wobble = .018f * Vec2(c.noise(c.p * 14.f, 3, 1), c.noise(c.p * 14.f, 3, 2));
  const Vec2 at = c.p / Vec2(c.aspect, 1) + wobble;
  Vec3 color = tone(c, 0) * .85f;
  const float share = .88f / static_cast<float>(fields);
  for (std::uint32_t k = 0; k < fields; ++k) {
    const float top = .06f + static_cast<float>(k) * share, bottom = top + share * c.pick(10 + k, .8f, .93f);
    const float inside = std::min({at.x - .08f, .94f - at.x, at.y - top, bottom - at.y});
    color = glm::mix(color, tone(c, k + 1), glm::smoothstep(0.f, .035f, inside) * .94f);
  }
  return color * (.92f + .16f * c.noise(c.p * 30.f, 3, 5));
}

/// Black bars, white ground, few primaries.
Vec3 neoplastic(const Canvas& c) {
  Vec2 lo(0), hi(c.aspect, 1);
  std::uint32_t cell = 1;
  for (std::uint32_t depth = 0; depth < 5; ++depth) {
    if (depth > 2 && c.pick(cell, 7) < .35f) break;
    const int axis = (hi - lo).x > (hi - lo).y ? 0 : 1;
    const float cut = glm::mix(lo[axis], hi[axis], .25f + .5f * c.pick(cell, 3));
    const bool after = c.p[axis] > cut;
    (after ? lo : hi)[axis] = cut;
    cell = cell * 2 + (after ? 1 : 0);
  }
  const Vec2 edge = glm::min(c.p - lo, hi - c.p);
  if (std::min(edge.x, edge.y) < .011f) return Vec3(.08f);
  const float kind = c.pick(cell, 9);
  if (kind < .2f) return {.80f, .12f, .10f};
  if (kind < .36f) return {.12f, .24f, .58f};
  if (kind < .5f) return {.95f, .80f, .18f};
  return {.94f, .93f, .88f};
}

/// A grid of concentric circles.
Vec3 circles(const Canvas& c) {
  const float rows = std::floor(c.pick(1, 2, 5));
  const Vec2 scaled = c.p * rows, cell = glm::floor(scaled);
  const float r = glm::distance(scaled - cell, Vec2(.5f)) * (7 + c.noise(scaled * 3.f, 2, 2));
  const auto id = static_cast<std::uint32_t>(cell.x * 17 + cell.y * 71);
  const auto ring = static_cast<std::uint32_t>(r);
  return tone(c, static_cast<std::uint32_t>(5 * c.pick(id + 31, ring))) *
         (.88f + .2f * c.noise(c.p * 40.f, 2, 4));
}

/// Waving stripes.
Vec3 opArt(const Canvas& c) {
  const float bend =
      .1f * std::sin(c.p.y * c.pick(1, 5, 12)) + .07f * std::sin(c.p.y * 17 + c.p.x * c.pick(2, 2, 8));
  const float stripe = std::sin((c.p.x + bend) * c.pick(3, 45, 80) * (1 + .4f * std::sin(3 * c.p.x)));
  return glm::mix(tone(c, 0), c.pick(4) < .5f ? Vec3(.07f) : tone(c, 1),
                  glm::smoothstep(-.15f, .15f, stripe));
}

/// A head and shoulders before a dark ground, lit from one side.
Vec3 portrait(const Canvas& c) {
  const Vec2 at(c.p.x - c.aspect / 2, c.p.y);
  const float lightSide = c.pick(1) < .5f ? -1.f : 1.f;
  Vec3 color = glm::mix(tone(c, 2), Vec3(.1f, .08f, .07f),
                        glm::clamp(.45f + glm::length(at - Vec2(.2f * lightSide, .35f)), 0.f, 1.f));
  color *= .8f + .4f * c.noise(c.p * 6.f, 4, 1);
  const Vec2 chest = (at - Vec2(0, 1.06f)) / Vec2(.42f, .44f);
  const float brush = .85f + .3f * c.noise(c.p * Vec2(30, 12), 3, 2);
  if (glm::length(chest) < 1)
    color = glm::mix(tone(c, 1) * .35f, tone(c, 1), .5f + .5f * lightSide * chest.x) * brush;
  if (std::abs(at.x) < .065f && at.y > .45f && at.y < .7f) color = Vec3(.62f, .44f, .33f) * brush * .8f;
  const Vec2 head = (at - Vec2(0, .37f)) / Vec2(.148f, .2f);
  const Vec2 hair = (at - Vec2(0, .33f)) / Vec2(.185f, .22f);
  if (glm::length(hair) < 1 && (head.y < .1f || c.pick(2) < .5f)) color = tone(c, 4) * .3f * brush;
  if (glm::length(head) >= 1 || (head.y < -.55f && std::abs(head.x) < 1)) return color;
  const float shade = glm::clamp(.62f + .42f * lightSide * head.x - .15f * head.y, .1f, 1.05f);
  color = Vec3(.90f, .70f, .55f) * shade * (.94f + .12f * c.noise(c.p * 30.f, 2, 3));
  const Vec2 eye = (Vec2(std::abs(head.x), head.y) - Vec2(.4f, -.08f)) / Vec2(.16f, .07f);
  if (glm::length(eye) < 1) color *= .35f;
  if (glm::length((head - Vec2(0, .5f)) / Vec2(.26f, .06f)) < 1) color = Vec3(.62f, .26f, .22f) * shade;
  if (std::abs(head.x - .08f * lightSide) < .035f && head.y > -.05f && head.y < .28f) color *= 1.18f;
  return color;
}

/// Flowers in a vase.
Vec3 flowers(const Canvas& c) {
  const Vec2 at(c.p.x - c.aspect / 2, c.p.y);
  Vec3 color = c.p.y > .82f ? tone(c, 4) * .6f : tone(c, 0) * (.35f + .25f * c.noise(c.p * 5.f, 4, 1));
  const float belly = .1f + .05f * std::sin((at.y - .58f) * 9);
  if (at.y > .58f && at.y < .9f && std::abs(at.x) < belly) color = tone(c, 3) * (.9f - 2.2f * at.x);
  for (std::uint32_t k = 0; k < 22; ++k) {
    const float turn = 2.4f * static_cast<float>(k), spread = .055f * std::sqrt(static_cast<float>(k));
    const Vec2 center(spread * std::cos(turn) * 1.15f, .36f + spread * std::sin(turn));
    const Vec2 to = at - center;
    const float size = .055f + .05f * c.pick(40 + k), angle = std::atan2(to.y, to.x);
    const float petal = size * (.72f + .28f * std::cos(angle * (5 + std::floor(3 * c.pick(70 + k))) + turn));
    const float r = glm::length(to);
    if (k % 4 == 3 && r < size * 1.1f) color = Vec3(.2f, .36f, .16f) * (.6f + .8f * c.pick(90 + k));
    if (k % 4 != 3 && r < petal) color = glm::mix(tone(c, k) * .6f, tone(c, k) * 1.15f, r / size);
    if (k % 4 != 3 && r < .22f * size) color = Vec3(.9f, .7f, .2f);
  }
  return color * (.88f + .24f * c.noise(c.p * Vec2(26, 40), 3, 3));
}

/// Houses at night with lit windows.
Vec3 city(const Canvas& c) {
  Vec3 color = glm::mix(Vec3(.06f, .08f, .2f), Vec3(.5f, .32f, .36f), std::pow(c.p.y, 1.5f));
  const float moon = glm::distance(c.p, Vec2(c.aspect * c.pick(1, .15f, .85f), .17f));
  color = glm::mix(Vec3(.96f, .93f, .8f), color, glm::smoothstep(.055f, .065f, moon));
  for (std::uint32_t layer = 0; layer < 3; ++layer) {
    const auto depth = static_cast<float>(layer);
    const float block = (c.p.x + 3 + depth * .37f) * (11 - 2 * depth), column = std::floor(block);
    const auto id = static_cast<std::uint32_t>(column) + 100 * layer;
    const float roof = .28f + .18f * depth + .25f * c.pick(id, 5);
    if (c.p.y < roof) continue;
    color = glm::mix(Vec3(.22f, .2f, .3f), Vec3(.05f, .05f, .09f), (depth + 1) / 3);
    const Vec2 grid((block - column) * 5, c.p.y * (46 - 8 * depth)), pane = glm::fract(grid);
    const bool open = pane.x > .25f && pane.x < .75f && pane.y > .3f && pane.y < .8f;
    if (open && c.pick(id * 53 + static_cast<std::uint32_t>(grid.y) * 7 + static_cast<std::uint32_t>(grid.x),
                       6) < .34f)
      color = Vec3(.98f, .8f, .42f);
  }
  return color;
}

/// Whirls of short strokes over hills.
Vec3 whirls(const Canvas& c) {
  Vec2 at = c.p;
  for (std::uint32_t k = 0; k < 5; ++k) {
    const Vec2 eye(c.aspect * c.pick(10 + k), .1f + .5f * c.pick(20 + k));
    const Vec2 to = at - eye;
    const float turn = 4.5f * std::exp(-glm::length(to) * 7), s = std::sin(turn), co = std::cos(turn);
    at = eye + Vec2(co * to.x - s * to.y, s * to.x + co * to.y);
  }
  const float stroke = c.noise(at * Vec2(5, 34), 3, 1), area = c.noise(at * 2.5f, 3, 2);
  const bool land = c.p.y > .74f + .12f * std::sin(c.p.x * 5 + 6 * c.pick(3));
  if (land) return glm::mix(Vec3(.10f, .20f, .16f), Vec3(.36f, .42f, .2f), stroke);
  const Vec3 blue = glm::mix(Vec3(.08f, .16f, .42f), Vec3(.44f, .62f, .80f), stroke);
  return glm::mix(blue, Vec3(.96f, .86f, .42f), glm::smoothstep(.56f, .68f, area) * (.5f + stroke));
}

/// Paint in motion.
Vec3 gestures(const Canvas& c) {
  const Vec2 warp1(c.noise(c.p * 2.f, 4, 1), c.noise(c.p * 2.f, 4, 2));
  const Vec2 warp2(c.noise(c.p + 3.f * warp1, 4, 3), c.noise(c.p + 3.f * warp1, 4, 4));
  const float value = c.noise(c.p + 4.f * warp2, 4, 5) * 7 + c.pick(6) * 5;
  const auto index = static_cast<std::uint32_t>(value);
  const float blend = glm::smoothstep(.35f, .65f, value - static_cast<float>(index));
  return glm::mix(tone(c, index), tone(c, index + 1), blend) * (.85f + .3f * c.noise(c.p * 24.f, 3, 7));
}

/// Birches in a row.
Vec3 birches(const Canvas& c) {
  Vec3 color = glm::mix(tone(c, 3), tone(c, 4), c.p.y) * (.6f + .7f * c.noise(c.p * Vec2(14, 20), 4, 1));
  if (c.p.y > .8f) color *= Vec3(.75f, .8f, .55f);
  for (std::uint32_t k = 0; k < 11; ++k) {
    const float width = .008f + .0045f * static_cast<float>(k) * (.6f + .6f * c.pick(60 + k));
    const float foot = .72f + .024f * static_cast<float>(k);
    const float x = c.aspect * c.pick(30 + k) + .03f * std::sin(c.p.y * 5 + static_cast<float>(k));
    const float across = (c.p.x - x) / width;
    if (std::abs(across) > 1 || c.p.y > foot) continue;
    const bool scar = c.noise(Vec2(across * 1.2f, c.p.y * 60 + static_cast<float>(k)), 2, 9) > .64f;
    color = (scar ? Vec3(.16f) : Vec3(.93f, .91f, .86f)) * (.95f - .35f * std::max(0.f, across));
  }
  return color;
}

/// Fruit on a cloth before a dark wall.
Vec3 stillLife(const Canvas& c) {
  const float edge = .68f + .03f * std::sin(c.p.x * 9);
  Vec3 color = c.p.y > edge ? glm::mix(Vec3(.88f, .85f, .78f), Vec3(.5f, .48f, .46f),
                                       c.noise(Vec2(c.p.x * 9, c.p.y * 3), 3, 2))
                            : Vec3(.20f, .16f, .13f) * (.7f + .7f * c.noise(c.p * 4.f, 4, 1));
  for (std::uint32_t k = 0; k < 9; ++k) {
    const float radius = c.pick(50 + k, .075f, .13f);
    const Vec2 center(c.aspect * (.2f + .6f * c.pick(10 + k)), .52f + .022f * static_cast<float>(k));
    const Vec2 to = (c.p - center) / radius;
    if (glm::length((to - Vec2(.3f, .9f)) / Vec2(1.2f, .3f)) < 1) color *= .6f;
    if (glm::length(to) > 1) continue;
    const float light = glm::clamp(
        .35f + .65f * glm::dot(Vec3(to, std::sqrt(1 - glm::dot(to, to))), Vec3(-.5f, -.5f, .7f)), .12f, 1.f);
    const std::array<Vec3, 4> fruit{
        {{.86f, .30f, .14f}, {.90f, .70f, .20f}, {.52f, .62f, .22f}, {.56f, .12f, .22f}}};
    color = fruit[static_cast<std::size_t>(4 * c.pick(80 + k))] * light *
            (.92f + .16f * c.noise(c.p * 40.f, 2, k));
    if (glm::distance(to, Vec2(-.38f, -.4f)) < .13f) color = glm::mix(color, Vec3(1), .55f);
  }
  return color;
}

/// Overlapping transparent planes and lines.
Vec3 constructivist(const Canvas& c) {
  Vec3 color = tone(c, 0);
  for (std::uint32_t k = 0; k < 9; ++k) {
    const float angle = kPi * std::floor(c.pick(10 + k) * 6) / 6 + .12f;
    const Vec2 to = c.p - Vec2(c.aspect * c.pick(20 + k), c.pick(30 + k));
    const Vec2 at(to.x * std::cos(angle) + to.y * std::sin(angle),
                  to.y * std::cos(angle) - to.x * std::sin(angle));
    const Vec2 half(c.pick(40 + k, .12f, .4f), c.pick(50 + k, .01f, .13f));
    const bool inside =
        k % 3 == 2 ? glm::length(at) < half.y * 1.6f : std::abs(at.x) < half.x && std::abs(at.y) < half.y;
    if (inside) color = glm::mix(color, tone(c, k % 4 + 1), .84f);
  }
  return color * (.94f + .1f * c.noise(c.p * 34.f, 2, 2));
}

using Manner = Vec3 (*)(const Canvas&);
constexpr std::array<Manner, kPaintingManners> kManners{
    mountains, portrait, colorField, flowers,  whirls,  neoplastic, seascape,
    stillLife, circles,  city,       gestures, birches, opArt,      constructivist};

}  // namespace

core::ImageRgba8 painting(int manner, std::uint32_t seed, int width, int height) {
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  const Manner draw = kManners[static_cast<std::size_t>(manner)];
  return paint(width, height, [&](Vec2 uv) { return draw({uv * Vec2(aspect, 1), aspect, seed}); });
}

}  // namespace saccade::data
