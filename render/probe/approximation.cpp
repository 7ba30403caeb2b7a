#include "render/probe/approximation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "core/scene/specular_albedo.h"

namespace saccade::render {

using core::Vec2;
using core::Vec3;

namespace {

/// Objects that reflect or transmit more than this show little in the base layer: a probe looks past them
/// rather than at something black.
constexpr float kMostlyReflecting = 0.5f;
/// One-sided differences of depth that differ by no more than this factor belong to one smooth surface.
constexpr float kSmooth = 2;
constexpr float kSmallestCosine = 0.02f;

/// Points of a frame's depth buffer.
class Points {
 public:
  explicit Points(const core::FrameSnapshot& frame) : frame_(frame) {}

  Vec3 at(int x, int y) const {
    const Vec2 center(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
    return frame_.view.unproject(center, frame_.depth[frame_.index(x, y)]);
  }
  /// Unit, towards the eye: across the neighbours of the same object. `p` = at(x, y), `toEye` unit.
  Vec3 normal(int x, int y, const Vec3& p, const Vec3& toEye) const {
    const Vec3 n = glm::cross(along(x, y, 1, 0, p), along(x, y, 0, 1, p));
    const float length = glm::length(n);
    if (!(length > 0)) return toEye;
    return n * ((glm::dot(n, toEye) < 0 ? -1 : 1) / length);
  }

 private:
  /// How the surface goes on from a pixel to the next one in a direction; 0 where there is none of the
  /// object.
  Vec3 along(int x, int y, int dx, int dy, const Vec3& p) const {
    const std::optional<Vec3> ahead = neighbour(x + dx, y + dy, frame_.ids[frame_.index(x, y)]);
    const std::optional<Vec3> behind = neighbour(x - dx, y - dy, frame_.ids[frame_.index(x, y)]);
    if (!ahead && !behind) return Vec3(0);
    if (!behind) return *ahead - p;
    if (!ahead) return p - *behind;
    const float a = glm::distance(*ahead, p), b = glm::distance(*behind, p);
    if (a > kSmooth * b) return p - *behind;
    if (b > kSmooth * a) return *ahead - p;
    return 0.5f * (*ahead - *behind);
  }
  std::optional<Vec3> neighbour(int x, int y, float id) const {
    const bool inside = x >= 0 && y >= 0 && x < frame_.view.width() && y < frame_.view.height();
    if (!inside || frame_.ids[frame_.index(x, y)] != id) return {};
    return at(x, y);
  }

  const core::FrameSnapshot& frame_;
};

/// The unit vector `direction` bent by a surface of relative index `eta` (before over behind); 0 beyond the
/// critical angle. `normal` is against it.
Vec3 refracted(const Vec3& direction, const Vec3& normal, float eta) {
  const float cosine = -glm::dot(direction, normal);
  const float k = 1 - eta * eta * (1 - cosine * cosine);
  return k < 0 ? Vec3(0) : eta * direction + (eta * cosine - std::sqrt(k)) * normal;
}

/// Out of a massive solid, taken for a ball that has the surface's normal where light enters.
Vec3 through(const Vec3& direction, const Vec3& normal, float ior) {
  if (ior == 1) return direction;
  const Vec3 within = refracted(direction, normal, 1 / ior);
  const Vec3 wall = 2 * glm::dot(normal, within) * within - normal;  // inwards, where it leaves
  const Vec3 out = refracted(within, wall, ior);
  return out == Vec3(0) ? direction : out;
}

/// Full radiance - base of a point: added + base * ofBase.
struct Glanced {
  Vec3 added{0}, ofBase{0};
};

Glanced glance(const Glance& g, const Probe& probe, const Vec3& point, const Vec3& normal,
               const Vec3& direction) {
  Glanced sum;
  const Vec3 behind = g.coverage < 1 ? (1 - g.coverage) * probe.radiance(point, direction, 0) : Vec3(0);
  if (g.unlit) return {behind, Vec3(0)};
  const float cosine = std::max(-glm::dot(direction, normal), kSmallestCosine);
  const Vec3 reflected = direction + 2 * cosine * normal;
  const core::AlbedoPair pair = core::directionalAlbedo(cosine, g.means.roughness);
  const Vec3 dielectric = core::lobeAlbedo(pair, g.means.over.f0, g.means.over.f90);
  Vec3 albedo = glm::mix(dielectric, core::lobeAlbedo(pair, g.means.baseColor, 1), g.means.metallic);
  if (g.ward) albedo = g.ward->specular;
  sum.added = albedo * probe.radiance(point, reflected, g.spread);
  if (g.transmitted != Vec3(0)) {
    const Vec3 passes = (Vec3(1) - dielectric) * g.transmitted;
    sum.added += passes * probe.radiance(point, through(direction, normal, g.ior), g.spread);
  }
  // The view-dependent part of the Lambert lobe. Emission, which it does not concern, is taken for diffuse.
  if (!g.ward && g.diffuseFactor > 0) sum.ofBase = (Vec3(1) - dielectric) / g.diffuseFactor - Vec3(1);
  if (g.means.over.coat > 0) {
    const core::AlbedoPair coat = core::directionalAlbedo(cosine, g.means.over.coatRoughness);
    const float kept = std::min(g.means.over.coat * (core::kCoatF0 * coat.scale + coat.bias), 1.0f);
    sum.added = (1 - kept) * sum.added + kept * probe.radiance(point, reflected, g.coatSpread);
    sum.ofBase = (1 - kept) * (sum.ofBase + Vec3(1)) - Vec3(1);
  }
  sum.added = g.coverage * sum.added + behind;
  return sum;
}

}  // namespace

Approximation::Approximation(const core::Scene& scene, BaseRenderer& renderer)
    : scene_(scene), renderer_(renderer), mapsNumber_(renderer.mapsNumber()) {
  const std::size_t ids = std::size_t{scene.idCount()} + 1;
  objects_.resize(ids);
  glances_.resize(ids);
  placeOf_.resize(ids);
  std::vector<std::uint32_t> all;
  for (const core::Object& object : scene.objects) {
    if (object.id == 0 || object.bounds.empty()) continue;
    objects_[object.id] = &object;
    glances_[object.id] = Glance(scene, object);
    all.push_back(object.id);
  }
  if (!all.empty()) assign(std::move(all));
}

/// Splits the widest group of objects in two until there are enough groups or each is one object.
void Approximation::assign(std::vector<std::uint32_t> ids) {
  const auto spreadOf = [this](const std::vector<std::uint32_t>& group) {
    core::Bounds centers;
    for (const std::uint32_t id : group) centers.add(objects_[id]->bounds.center());
    return centers;
  };
  std::vector<std::vector<std::uint32_t>> groups{std::move(ids)};
  while (groups.size() < kMostProbes) {
    const auto widest = std::max_element(groups.begin(), groups.end(), [&](const auto& a, const auto& b) {
      return spreadOf(a).diagonal() < spreadOf(b).diagonal();
    });
    const core::Bounds centers = spreadOf(*widest);
    const Vec3 size = centers.extent();
    if (!(centers.diagonal() > 0)) break;
    const int a = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto far = std::stable_partition(widest->begin(), widest->end(), [&](std::uint32_t id) {
      return objects_[id]->bounds.center()[a] < centers.center()[a];
    });
    std::vector<std::uint32_t> rest(far, widest->end());
    widest->erase(far, widest->end());
    groups.push_back(std::move(rest));
  }
  for (const std::vector<std::uint32_t>& group : groups) {
    Vec3 sum(0);
    for (const std::uint32_t id : group) {
      placeOf_[id] = places_.size();
      sum += objects_[id]->bounds.center();
    }
    places_.push_back({sum / static_cast<float>(group.size()), nullptr});
  }
}

/// What surrounds a probe, and what it would see as black.
std::vector<char> Approximation::hiddenFrom(const Vec3& center) const {
  std::vector<char> hidden(scene_.objects.size(), 0);
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    const core::Object& object = scene_.objects[i];
    hidden[i] =
        object.id != 0 && (object.bounds.contains(center) || object.nonDiffuseAlbedo > kMostlyReflecting);
  }
  return hidden;
}

std::size_t Approximation::probesMade() const {
  return static_cast<std::size_t>(
      std::count_if(places_.begin(), places_.end(), [](const Place& p) { return p.probe != nullptr; }));
}

void Approximation::prepare(const core::FrameSnapshot& frame, std::span<const core::Pixel> pixels,
                            std::size_t atMost) {
  if (mapsNumber_ != renderer_.mapsNumber()) {
    mapsNumber_ = renderer_.mapsNumber();
    for (Place& place : places_) place.probe.reset();
  }
  std::vector<std::size_t> wanted(places_.size(), 0);  // pixels
  for (const core::Pixel& pixel : pixels) {
    const std::size_t place = placeOf_[frame.idAt(pixel.x, pixel.y)];
    if (!places_[place].probe) ++wanted[place];
  }
  for (; atMost > 0; --atMost) {
    const auto most = std::max_element(wanted.begin(), wanted.end());
    if (most == wanted.end() || *most == 0) return;
    *most = 0;
    Place& place = places_[static_cast<std::size_t>(most - wanted.begin())];
    place.probe = std::make_unique<Probe>(renderer_, scene_, place.center, hiddenFrom(place.center));
  }
}

void Approximation::at(const core::FrameSnapshot& frame, std::span<const core::Pixel> pixels,
                       std::vector<Vec3>& corrections) const {
  corrections.clear();
  corrections.reserve(pixels.size());
  const Points points(frame);
  const Vec3 eye = frame.view.camera().eye;
  Glanced glanced;
  core::Pixel last{-1, -1};
  std::uint32_t lastId = 0;
  for (const core::Pixel& pixel : pixels) {
    const std::uint32_t id = frame.idAt(pixel.x, pixel.y);
    const Probe* probe = places_[placeOf_[id]].probe.get();
    if (!probe) {
      corrections.emplace_back(0.0f);
      continue;
    }
    if (id != lastId || pixel.x / 2 != last.x / 2 || pixel.y / 2 != last.y / 2) {
      const Vec3 point = points.at(pixel.x, pixel.y);
      const Vec3 direction = glm::normalize(point - eye);
      const Vec3 normal = points.normal(pixel.x, pixel.y, point, -direction);
      glanced = glance(glances_[id], *probe, point, normal, direction);
      last = pixel;
      lastId = id;
    }
    const Vec3 base(frame.baseAndId[frame.index(pixel.x, pixel.y)]);
    corrections.push_back(glanced.added + base * glanced.ofBase);
  }
}

}  // namespace saccade::render
