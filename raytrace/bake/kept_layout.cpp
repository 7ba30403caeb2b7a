#include "raytrace/bake/kept_layout.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "raytrace/bake/free_space.h"
#include "raytrace/bake/texel_map.h"

namespace saccade::raytrace {
namespace {

constexpr int kBorder = 1;          // texels around a chart that are its own
constexpr int kSizeStep = 64;       // by which the atlas grows
constexpr double kFiner = 2;        // times as many texels are wanted: a chart does not stay as it was
constexpr double kRounding = 0.01;  // texels by which coordinates may be off

using Uv = std::vector<glm::dvec2>;

/// Whole texels, without a border.
struct Rect {
  int x0 = 0, y0 = 0, x1 = 1, y1 = 1;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  double texels() const { return static_cast<double>(width()) * height(); }
};

/// Bounds of coordinates in texels.
class Extent {
 public:
  void add(const glm::dvec2& p) {
    lo_ = glm::min(lo_, p);
    hi_ = glm::max(hi_, p);
  }
  Rect rect() const {
    if (lo_.x > hi_.x) return {};
    Rect r{static_cast<int>(std::floor(lo_.x + kRounding)), static_cast<int>(std::floor(lo_.y + kRounding)),
           0, 0};
    r.x1 = std::max(r.x0 + 1, static_cast<int>(std::ceil(hi_.x - kRounding)));
    r.y1 = std::max(r.y0 + 1, static_cast<int>(std::ceil(hi_.y - kRounding)));
    return r;
  }

 private:
  glm::dvec2 lo_{1e9}, hi_{-1e9};
};

Uv inTexels(const std::vector<core::Vec2>& uv, int size) {
  Uv out;
  out.reserve(uv.size());
  for (const core::Vec2& p : uv) out.push_back(glm::dvec2(p) * static_cast<double>(size));
  return out;
}

class Layout {
 public:
  Layout(const core::Scene& scene, const ChartAtlas& fresh, const SceneMatch& match,
         const core::Scene& before, const core::IlluminationMaps& previous)
      : scene_(scene),
        fresh_(fresh),
        match_(match),
        before_(before),
        previous_(previous),
        stays_(scene.objects.size(), 0),
        from_(scene.meshes.size(), SceneMatch::kNone),
        chartOf_(scene.meshes.size()),
        inPlace_(scene.meshes.size()),
        shift_(scene.meshes.size()),
        space_(previous.width) {
    for (std::size_t o = 0; o < scene.objects.size(); ++o) stays_[o] = findEarlier(o);
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
      uv_.push_back(from_[m] >= 0 ? inTexels(earlierCharts(m).uv, previous.width)
                                  : inTexels(fresh.charts.meshes[m].uv, fresh.size));
    }
  }

  std::optional<KeptLayout> place(int largest) {
    std::vector<std::size_t> lit;
    for (std::size_t o = 0; o < scene_.objects.size(); ++o)
      if (isLit(scene_, scene_.objects[o])) lit.push_back(o);
    if (std::none_of(lit.begin(), lit.end(), [&](std::size_t o) { return stays_[o] != 0; })) return {};
    places_.assign(scene_.objects.size(), core::Vec4(1, 1, 0, 0));
    for (const std::size_t o : lit) scene_.meshOf(scene_.objects[o]).instanced ? keepBlock(o) : keepCharts(o);
    wanted_.push_back({1 + 2 * kBorder, 1 + 2 * kBorder, kShared, 0, {}});
    if (!placeWanted(largest)) return {};
    return result(lit);
  }

 private:
  static constexpr std::size_t kShared = static_cast<std::size_t>(-1);

  /// A rectangle, its border included, that needs a place.
  struct Wanted {
    int width = 0, height = 0;
    std::size_t object = 0;  ///< or kShared: the texel of what shows no irradiance
    std::int32_t chart = 0;  ///< of a mesh that is not instanced
    Rect rect;               ///< where its coordinates are now
    int scale = 1;           ///< of an instance's block
  };

  static bool isLit(const core::Scene& scene, const core::Object& object) {
    return showsIrradiance(scene.materials[static_cast<std::size_t>(object.material)]);
  }
  const core::MeshCharts& earlierCharts(std::size_t mesh) const {
    return previous_.charts.meshes[static_cast<std::size_t>(from_[mesh])];
  }

  /// The object was lit before, by charts that are cut alike; notes where its mesh's charts come from.
  bool findEarlier(std::size_t o) {
    const core::Object& object = scene_.objects[o];
    if (match_.before[o] == SceneMatch::kNone || !isLit(scene_, object)) return false;
    const core::Object& earlier = before_.objects[static_cast<std::size_t>(match_.before[o])];
    if (!isLit(before_, earlier)) return false;
    const auto mesh = static_cast<std::int32_t>(earlier.mesh);
    if (from_[object.mesh] != SceneMatch::kNone) return from_[object.mesh] == mesh;
    const core::MeshCharts &was = previous_.charts.meshes[earlier.mesh],
                           &is = fresh_.charts.meshes[object.mesh];
    if (was.sourceVertex != is.sourceVertex || was.indices != is.indices || was.perVertex != is.perVertex)
      return false;
    from_[object.mesh] = mesh;
    return true;
  }

  /// By vertex.
  std::vector<std::int32_t> chartsOf(std::size_t m, std::int32_t& count) {
    const core::Mesh& mesh = scene_.meshes[m];
    if (mesh.vertexLit) {
      count = 1;
      return std::vector<std::int32_t>(mesh.positions.size(), 0);
    }
    const std::vector<std::int32_t> ofTriangle = chartsOfUv(mesh, fresh_.charts.meshes[m].uv);
    std::vector<std::int32_t> out(mesh.positions.size(), 0);
    count = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
      out[mesh.indices[i]] = ofTriangle[i / 3];
      count = std::max(count, ofTriangle[i / 3] + 1);
    }
    return out;
  }

  static std::vector<Rect> rectsOf(const Uv& uv, const std::vector<std::int32_t>& chartOf,
                                   std::int32_t count) {
    std::vector<Extent> extents(static_cast<std::size_t>(count));
    for (std::size_t v = 0; v < uv.size(); ++v) extents[static_cast<std::size_t>(chartOf[v])].add(uv[v]);
    std::vector<Rect> out;
    out.reserve(extents.size());
    for (const Extent& e : extents) out.push_back(e.rect());
    return out;
  }

  static Rect rectOf(const Uv& uv) {
    Extent extent;
    for (const glm::dvec2& p : uv) extent.add(p);
    return extent.rect();
  }

  /// Of a mesh of one object.
  void keepCharts(std::size_t o) {
    const std::size_t m = scene_.objects[o].mesh;
    std::int32_t count = 0;
    chartOf_[m] = chartsOf(m, count);
    const Uv freshUv = inTexels(fresh_.charts.meshes[m].uv, fresh_.size);
    const std::vector<Rect> now = rectsOf(uv_[m], chartOf_[m], count),
                            wish = rectsOf(freshUv, chartOf_[m], count);
    inPlace_[m].assign(static_cast<std::size_t>(count), 0);
    shift_[m].assign(static_cast<std::size_t>(count), glm::dvec2(0));
    for (std::size_t c = 0; c < now.size(); ++c) {
      inPlace_[m][c] = stays_[o] && wish[c].texels() <= kFiner * now[c].texels();
      if (inPlace_[m][c])
        space_.take(now[c].x0 - kBorder, now[c].y0 - kBorder, now[c].x1 + kBorder, now[c].y1 + kBorder);
      else
        wanted_.push_back({wish[c].width() + 2 * kBorder, wish[c].height() + 2 * kBorder, o,
                           static_cast<std::int32_t>(c), wish[c]});
    }
    for (std::size_t v = 0; v < freshUv.size(); ++v)
      if (!inPlace_[m][static_cast<std::size_t>(chartOf_[m][v])]) uv_[m][v] = freshUv[v];
  }

  /// Of an object that shares its mesh: all its charts together, larger by a power of two.
  void keepBlock(std::size_t o) {
    const std::size_t m = scene_.objects[o].mesh;
    const Rect block = rectOf(uv_[m]), freshBlock = rectOf(inTexels(fresh_.charts.meshes[m].uv, fresh_.size));
    const double freshScale = fresh_.charts.places[o].x;
    const double ratio = freshScale * std::sqrt(freshBlock.texels() / block.texels());
    int scale = 1 << static_cast<int>(std::max(0.0, std::round(std::log2(ratio))));
    if (stays_[o]) {
      const core::Vec4 was = previous_.charts.places[static_cast<std::size_t>(match_.before[o])];
      if (freshScale * freshScale * freshBlock.texels() <= kFiner * was.x * was.x * block.texels()) {
        const auto times = static_cast<int>(was.x);
        const int x = static_cast<int>(std::lround(was.z * static_cast<float>(previous_.width))),
                  y = static_cast<int>(std::lround(was.w * static_cast<float>(previous_.width)));
        space_.take(x, y, x + times * (block.x1 + kBorder), y + times * (block.y1 + kBorder));
        places_[o] = core::Vec4(was.x, was.y, x, y);
        return;
      }
      stays_[o] = 0;
    }
    wanted_.push_back({scale * (block.x1 + kBorder), scale * (block.y1 + kBorder), o, 0, block, scale});
  }

  bool placeWanted(int largest) {
    std::vector<std::size_t> order(wanted_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return wanted_[a].height > wanted_[b].height; });
    for (const std::size_t i : order) {
      const Wanted& want = wanted_[i];
      int x = 0, y = 0;
      while (!space_.place(want.width, want.height, x, y)) {
        if (space_.size() >= largest) return false;
        space_.grow(std::min(largest, space_.size() + kSizeStep));
      }
      move(want, x, y);
    }
    return true;
  }

  /// To its place, whose corner, border included, is (x, y).
  void move(const Wanted& want, int x, int y) {
    if (want.object == kShared) {
      shared_ = glm::dvec2(x, y) + (kBorder + 0.5);
      return;
    }
    const std::size_t m = scene_.objects[want.object].mesh;
    if (scene_.meshes[m].instanced) {
      places_[want.object] = core::Vec4(want.scale, want.scale, x, y);
      return;
    }
    shift_[m][static_cast<std::size_t>(want.chart)] =
        glm::dvec2(x + kBorder - want.rect.x0, y + kBorder - want.rect.y0);
  }

  KeptLayout result(const std::vector<std::size_t>& lit) const {
    KeptLayout out;
    out.size = space_.size();
    const double size = out.size;
    out.charts = fresh_.charts;
    std::vector<char> used(scene_.meshes.size(), 0);
    for (const std::size_t o : lit) used[scene_.objects[o].mesh] = 1;
    for (std::size_t m = 0; m < uv_.size(); ++m) {
      for (std::size_t v = 0; v < uv_[m].size(); ++v)
        out.charts.meshes[m].uv[v] = core::Vec2((used[m] ? uv_[m][v] + shiftOf(m, v) : shared_) / size);
      if (!used[m] && scene_.meshes[m].instanced)
        out.charts.meshes[m].uv.assign(uv_[m].size(), core::Vec2(0));
    }
    out.charts.places = places_;
    for (std::size_t o = 0; o < places_.size(); ++o) {
      core::Vec4& place = out.charts.places[o];
      const bool instanced = scene_.meshOf(scene_.objects[o]).instanced;
      if (instanced && !isLit(scene_, scene_.objects[o])) place = core::Vec4(0, 0, shared_);
      place.z = static_cast<float>(place.z / size);
      place.w = static_cast<float>(place.w / size);
    }
    for (const std::size_t o : lit) {
      const std::size_t m = scene_.objects[o].mesh;
      if (!scene_.meshes[m].instanced) {
        out.inPlace.insert(out.inPlace.end(), inPlace_[m].begin(), inPlace_[m].end());
        continue;
      }
      const std::vector<std::int32_t> charts = chartsOfUv(scene_.meshes[m], out.charts.meshes[m].uv);
      const std::int32_t count = charts.empty() ? 0 : 1 + *std::max_element(charts.begin(), charts.end());
      out.inPlace.insert(out.inPlace.end(), static_cast<std::size_t>(count), stays_[o]);
    }
    return out;
  }

  glm::dvec2 shiftOf(std::size_t m, std::size_t v) const {
    return shift_[m].empty() ? glm::dvec2(0) : shift_[m][static_cast<std::size_t>(chartOf_[m][v])];
  }

  const core::Scene& scene_;
  const ChartAtlas& fresh_;
  const SceneMatch& match_;
  const core::Scene& before_;
  const core::IlluminationMaps& previous_;
  std::vector<char> stays_;                         ///< by object
  std::vector<std::int32_t> from_;                  ///< by mesh: the earlier one whose charts it has
  std::vector<std::vector<std::int32_t>> chartOf_;  ///< by mesh and vertex
  std::vector<std::vector<char>> inPlace_;          ///< by mesh and chart
  std::vector<std::vector<glm::dvec2>> shift_;      ///< by mesh and chart: to its place
  std::vector<Uv> uv_;                              ///< by mesh, in texels
  std::vector<core::Vec4> places_;                  ///< by object, offsets in texels
  std::vector<Wanted> wanted_;
  glm::dvec2 shared_{0};
  FreeSpace space_;
};

}  // namespace

std::optional<KeptLayout> keepLayout(const core::Scene& charted, const ChartAtlas& fresh,
                                     const SceneMatch& match, const core::Scene& before,
                                     const core::IlluminationMaps& previous, int largest) {
  return Layout(charted, fresh, match, before, previous).place(largest);
}

}  // namespace saccade::raytrace
