#include <algorithm>
#include <array>
#include <string>

#include "data/make_scenes/gallery.h"
#include "data/make_scenes/materials.h"
#include "data/make_scenes/paintings.h"
#include "data/make_scenes/profiles.h"
#include "data/make_scenes/shapes.h"
#include "data/make_scenes/textures.h"

namespace saccade::data {
namespace {

enum Format { kSmall, kPortrait, kLandscape, kGrand, kMirror, kFormats };

/// Opening of the frame in metres, the frame's border, and the picture's resolution.
struct FormatSize {
  float width, height, border;
  int pixelsWide, pixelsHigh;
};
constexpr std::array<FormatSize, kFormats> kSizes{{{0.86f, 0.72f, 0.09f, 160, 134},
                                                   {1.15f, 1.60f, 0.13f, 132, 184},
                                                   {1.85f, 1.25f, 0.14f, 192, 130},
                                                   {3.30f, 2.10f, 0.20f, 224, 142},
                                                   {1.00f, 2.30f, 0.10f, 0, 0}}};

/// Hangs things on one wall: `onWall` is metres along it from its middle, to the right as seen from the room.
class Hanger {
 public:
  Hanger(GlbWriter& glb);
  void setWall(const Vec3& middle, float degrees) { middle_ = middle, degrees_ = degrees; }
  void hang(Format format, float onWall, float height);
  /// Centred columns of pictures over the whole wall.
  void hangRow(const std::string& columns);

 private:
  void hangColumn(char kind, float onWall);
  int nextPicture(Format format);

  GlbWriter& glb_;
  Vec3 middle_{0};
  float degrees_ = 0;
  std::array<int, kFormats> frames_{}, canvases_{};
  std::array<int, 5> metals_{};
  int mirrorGlass_ = 0;
  int pictures_ = 0;
};

constexpr float kFrameDepth = 0.06f;

Hanger::Hanger(GlbWriter& glb) : glb_(glb) {
  for (std::size_t f = 0; f < kFormats; ++f) {
    const FormatSize& s = kSizes[f];
    frames_[f] = glb.addGeometry(frame(s.width, s.height, s.border, kFrameDepth, 9), true, true);
    canvases_[f] = glb.addGeometry(
        panel({-s.width / 2, -s.height / 2, 0.015f}, {s.width, 0, 0}, {0, s.height, 0}), f != kMirror);
  }
  const std::array<Vec3, 5> tones{kGold, kBronze, kSilver, kGold * Vec3(.86f, .78f, .62f), kSteel * 0.62f};
  const std::array<float, 5> roughness{.28f, .34f, .22f, .38f, .2f};
  const std::array<const char*, 5> names{"gilt frame", "bronze frame", "silver frame", "old gold frame",
                                         "steel frame"};
  for (std::size_t k = 0; k < 5; ++k) {
    MaterialDesc m = metal(names[k], tones[k], 1);
    const int style = static_cast<int>(k);
    if (k < 3)
      m.normalTexture =
          glb.addPng(m.name + " carving", normalMap(
                                              96, [&](Vec2 uv) { return carvedHeight(uv, style); }, 0.014f));
    m.metallicRoughnessTexture = glb.addJpeg(
        m.name + " wear",
        metallicRoughnessMap(
            96, 1,
            [&](Vec2 uv) {
              return mottledColor(uv, Vec3(roughness[k]), 0.45f, 300 + static_cast<std::uint32_t>(k)).x;
            }),
        82);
    metals_[k] = glb.addMaterial(m);
  }
  mirrorGlass_ = glb.addMaterial(metal("mirror glass", Vec3(0.93f, 0.94f, 0.93f), 0));
}

int Hanger::nextPicture(Format format) {
  const FormatSize& s = kSizes[format];
  const int manner = pictures_ % kPaintingManners;
  const std::string name = "picture " + std::to_string(pictures_ + 1);
  const auto seed = static_cast<std::uint32_t>(1000 + 37 * pictures_);
  return glb_.addMaterial(
      lambert(name, Vec3(1), glb_.addJpeg(name, painting(manner, seed, s.pixelsWide, s.pixelsHigh), 80)));
}

void Hanger::hang(Format format, float onWall, float height) {
  Placement place = standing(middle_, degrees_);
  place.translation += place.rotation * Vec3(onWall, height, 0);
  const bool isMirror = format == kMirror;
  const std::string name = isMirror ? "mirror" : "picture " + std::to_string(pictures_ + 1);
  glb_.addNode(name, canvases_[format], isMirror ? mirrorGlass_ : nextPicture(format), place);
  const auto choice = static_cast<std::size_t>(format == kGrand ? 0 : (pictures_ * 7 + pictures_ / 5) % 5);
  glb_.addNode(name + " frame", frames_[format], metals_[choice], place);
  if (!isMirror) ++pictures_;
}

void Hanger::hangColumn(char kind, float onWall) {
  switch (kind) {
    case 'S':
      for (const float height : {1.02f, 1.99f, 2.96f}) hang(kSmall, onWall, height);
      break;
    case 'P':
      hang(kPortrait, onWall, 1.68f);
      hang(kSmall, onWall, 3.18f);
      break;
    case 'L':
      hang(kLandscape, onWall, 1.62f);
      for (const float shift : {-0.55f, 0.55f}) hang(kSmall, onWall + shift, 2.98f);
      break;
    case 'G':
      hang(kGrand, onWall, 2.0f);
      break;
    default:
      hang(kMirror, onWall, 1.75f);
  }
}

void Hanger::hangRow(const std::string& columns) {
  constexpr float kGap = 0.26f;
  const auto widthOf = [](char kind) {
    switch (kind) {
      case 'S':
        return 1.04f;
      case 'P':
        return 1.41f;
      case 'L':
        return 2.14f;
      case 'G':
        return 3.7f;
      default:
        return 1.2f;
    }
  };
  float total = -kGap;
  for (const char kind : columns) total += widthOf(kind) + kGap;
  float at = -total / 2;
  for (const char kind : columns) {
    hangColumn(kind, at + widthOf(kind) / 2);
    at += widthOf(kind) + kGap;
  }
}

void addDoor(GlbWriter& glb) {
  MaterialDesc oak =
      lambert("door oak", Vec3(1),
              glb.addJpeg("door oak",
                          paint(128, 192,
                                [](Vec2 uv) {
                                  return boardColor(Vec2(uv.y, uv.x) * 0.5f, {8}, {.36f, .24f, .15f}, 81);
                                }),
                          80));
  oak.normalTexture =
      glb.addPng("door relief", normalMap(
                                    96,
                                    [](Vec2 uv) {
                                      const Vec2 coffer = glm::abs(glm::fract(uv * Vec2(2, 3)) - 0.5f);
                                      return glm::smoothstep(0.3f, 0.4f, std::max(coffer.x, coffer.y));
                                    },
                                    0.03f));
  const int material = glb.addMaterial(oak);
  const int wing = glb.addGeometry(box({0, 1.35f, 0}, {0.95f, 2.7f, 0.08f}, 2.7f), true, true);
  const int knob = glb.addMaterial(metal("door knob", kBrass, 0.15f));
  const int ball = glb.addGeometry(lathe(sphereProfile(0.04f, 16), 24));
  for (const float side : {-1.f, 1.f}) {
    glb.addNode("door wing", wing, material, standing({0.48f * side, 0, kHallHalfLength - 0.05f}));
    glb.addNode("door knob", ball, knob, standing({0.1f * side, 1.08f, kHallHalfLength - 0.15f}));
  }
}

}  // namespace

void addPictures(GlbWriter& glb) {
  Hanger hanger(glb);
  hanger.setWall({-kHallHalfWidth, 0, 0}, 90);
  hanger.hangRow("SPLMSPLSPSLPS");
  hanger.setWall({kHallHalfWidth, 0, 0}, -90);
  hanger.hangRow("PSLSPMLSPSLSP");
  hanger.setWall({0, 0, -kHallHalfLength}, 0);
  hanger.hangRow("SPGPS");
  hanger.setWall({0, 0, kHallHalfLength}, 180);
  for (const float side : {-1.f, 1.f}) {
    hanger.hang(kMirror, 1.9f * side, 1.75f);
    hanger.hang(kLandscape, 3.7f * side, 1.62f);
  }
  addDoor(glb);
}

}  // namespace saccade::data
