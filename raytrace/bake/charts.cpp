#include "raytrace/bake/charts.h"

#include <stb/stb_rect_pack.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "raytrace/bake/chart_clusters.h"

namespace saccade::raytrace {
namespace {

constexpr int kDefaultSize = 1024;
constexpr int kBorder = 1;              // texels around a chart that are its own: two between charts
constexpr double kFirstFill = 0.85;     // share of the atlas that charts could fill at best
constexpr double kCoarsenStep = 1.06;   // texel side grows by this until all fits
constexpr double kWorthDoubling = 2.0;  // coarser than this times the wish: take a larger atlas

/// A rectangle of texels, its border included.
struct Place {
  int width = 0, height = 0, x = 0, y = 0;
};

struct PlacedChart {
  Chart chart;
  Place place;  ///< in the atlas, or in the block of an instanced mesh
};

/// The charts of an instanced mesh, packed.
struct Block {
  std::uint32_t mesh = 0;
  double unit = 0;  ///< metres in the world per unit of the mesh, of the smallest lit object
  int width = 0, height = 0;
};

/// A lit object of an instanced mesh.
struct PlacedBlock {
  std::size_t object = 0, block = 0;
  int scale = 1;  ///< texels a texel of the block takes, a power of two
  Place place;
};

int texelsFor(double metres, double texel) {
  return static_cast<int>(std::clamp(std::round(metres / texel), 1.0, 1e6));
}

/// Cube root of the volume that a unit of the mesh's space takes.
double unitOf(const core::Object& object) {
  return std::cbrt(std::abs(glm::determinant(glm::dmat3(object.meshToWorld))));
}

/// Places the rectangles in width x height texels; false when they do not fit.
bool packRects(const std::vector<Place*>& places, int width, int height) {
  std::vector<stbrp_rect> rects(places.size());
  double needed = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (std::max(places[i]->width - width, places[i]->height - height) > 0) return false;
    rects[i] = {};
    rects[i].id = static_cast<int>(i);
    rects[i].w = places[i]->width;
    rects[i].h = places[i]->height;
    needed += static_cast<double>(rects[i].w) * rects[i].h;
  }
  if (needed > static_cast<double>(width) * height) return false;
  std::vector<stbrp_node> nodes(static_cast<std::size_t>(width));
  stbrp_context context;
  stbrp_init_target(&context, width, height, nodes.data(), width);
  if (!stbrp_pack_rects(&context, rects.data(), static_cast<int>(rects.size()))) return false;
  for (const stbrp_rect& r : rects) {
    places[static_cast<std::size_t>(r.id)]->x = r.x;
    places[static_cast<std::size_t>(r.id)]->y = r.y;
  }
  return true;
}

void sizeCharts(std::vector<PlacedChart>& charts, double texel) {
  for (PlacedChart& p : charts) {
    const glm::dvec2 extent = p.chart.hi - p.chart.lo;
    p.place.width = texelsFor(extent.x, texel) + 2 * kBorder;
    p.place.height = texelsFor(extent.y, texel) + 2 * kBorder;
  }
}

/// Everything that takes a part of the atlas.
class Layout {
 public:
  explicit Layout(const core::Scene& scene) : scene_(scene), charts_(scene.meshes.size()) {
    std::vector<std::size_t> blockOf(scene.meshes.size(), kNone);
    for (std::size_t o = 0; o < scene.objects.size(); ++o) {
      const core::Object& object = scene.objects[o];
      if (!isLit(object)) {
        shared_ = true;
      } else if (scene.meshOf(object).instanced) {
        addInstance(o, blockOf[object.mesh]);
      } else {
        cluster(object.mesh, 1);
        order_.push_back(object.mesh);
      }
    }
    for (PlacedBlock& b : instances_) {
      const Block& block = blocks_[b.block];
      const double ratio = unitOf(scene.objects[b.object]) / block.unit;
      b.scale = 1 << static_cast<int>(std::clamp(std::round(std::log2(ratio)), 0.0, kMostDoublings));
    }
    if (shared_) sharedPlace_.width = sharedPlace_.height = 1 + 2 * kBorder;
  }

  double area() const { return area_; }                    ///< of all charts, m^2
  double largestExtent() const { return largestExtent_; }  ///< of a chart, m
  std::size_t chartCount() const { return count_ + (shared_ ? 1 : 0); }

  /// Tries to place everything with texels of this side.
  bool pack(double texel, int size) {
    std::vector<Place*> places;
    for (const std::uint32_t mesh : order_) {
      sizeCharts(charts_[mesh], texel);
      for (PlacedChart& p : charts_[mesh]) places.push_back(&p.place);
    }
    if (shared_) places.push_back(&sharedPlace_);
    for (Block& b : blocks_) {
      if (!packBlock(b, texel / b.unit, size)) return false;
    }
    for (PlacedBlock& b : instances_) {
      b.place.width = blocks_[b.block].width * b.scale;
      b.place.height = blocks_[b.block].height * b.scale;
      places.push_back(&b.place);
    }
    return packRects(places, size, size);
  }

  core::SceneCharts cut(int size) const {
    core::SceneCharts out;
    const core::Vec2 shared =
        (core::Vec2(static_cast<float>(sharedPlace_.x), static_cast<float>(sharedPlace_.y)) +
         (kBorder + 0.5f)) /
        static_cast<float>(size);
    for (std::size_t m = 0; m < scene_.meshes.size(); ++m) {
      const core::Mesh& mesh = scene_.meshes[m];
      out.meshes.push_back(!charts_[m].empty() ? cutMesh(mesh, charts_[m], size)
                                               : wholeMesh(mesh, mesh.instanced ? core::Vec2(0) : shared));
    }
    for (const core::Object& o : scene_.objects) {
      out.places.push_back(scene_.meshOf(o).instanced ? core::Vec4(0, 0, shared) : core::Vec4(1, 1, 0, 0));
    }
    for (const PlacedBlock& b : instances_) {
      const core::Vec2 corner(static_cast<float>(b.place.x), static_cast<float>(b.place.y));
      out.places[b.object] =
          core::Vec4(core::Vec2(static_cast<float>(b.scale)), corner / static_cast<float>(size));
    }
    return out;
  }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  static constexpr double kMostDoublings = 6;  ///< a border widens with its block

  bool isLit(const core::Object& object) const {
    return showsIrradiance(scene_.materials[static_cast<std::size_t>(object.material)]);
  }

  void addInstance(std::size_t o, std::size_t& block) {
    const core::Object& object = scene_.objects[o];
    const double unit = unitOf(object);
    if (block == kNone) {
      block = blocks_.size();
      blocks_.push_back({object.mesh, unit, 0, 0});
    }
    blocks_[block].unit = std::min(blocks_[block].unit, unit);
    instances_.push_back({o, block, 1, {}});
    cluster(object.mesh, unit);
  }

  /// Charts of a mesh, once, and their size as an object of `unit` has them.
  void cluster(std::uint32_t mesh, double unit) {
    std::vector<PlacedChart>& charts = charts_[mesh];
    if (charts.empty()) {
      for (Chart& chart : clusterMesh(scene_.meshes[mesh])) charts.push_back({std::move(chart), {}});
    }
    for (const PlacedChart& p : charts) {
      const glm::dvec2 extent = (p.chart.hi - p.chart.lo) * unit;
      area_ += extent.x * extent.y;
      largestExtent_ = std::max({largestExtent_, extent.x, extent.y});
    }
    count_ += charts.size();
  }

  /// `texel` in units of the mesh.
  bool packBlock(Block& block, double texel, int size) {
    std::vector<PlacedChart>& charts = charts_[block.mesh];
    sizeCharts(charts, texel);
    std::vector<Place*> places;
    double needed = 0;
    int widest = 1;
    for (PlacedChart& p : charts) {
      places.push_back(&p.place);
      needed += static_cast<double>(p.place.width) * p.place.height;
      widest = std::max(widest, p.place.width);
    }
    constexpr double kRoom = 1.1;  // for what rectangles leave between them
    block.width = std::max(widest, static_cast<int>(std::ceil(std::sqrt(kRoom * needed))));
    if (block.width > size || !packRects(places, block.width, size)) return false;
    block.height = 0;
    for (const Place* p : places) block.height = std::max(block.height, p->y + p->height);
    return true;
  }

  static core::Vec2 atlasUv(const PlacedChart& placed, const core::Vec3& position, int size) {
    const Chart& chart = placed.chart;
    const glm::dvec2 extent = chart.hi - chart.lo;
    const glm::dvec2 q = chart.project(position) - chart.lo;
    const auto texel = [](double at, double whole, int first, int count) {
      const double share = whole > 0 && std::isfinite(at) ? std::clamp(at / whole, 0.0, 1.0) : 0.5;
      return first + kBorder + share * (count - 2 * kBorder);
    };
    return core::Vec2(texel(q.x, extent.x, placed.place.x, placed.place.width) / size,
                      texel(q.y, extent.y, placed.place.y, placed.place.height) / size);
  }

  /// New vertices, chart by chart.
  static core::MeshCharts cutMesh(const core::Mesh& mesh, const std::vector<PlacedChart>& charts, int size) {
    core::MeshCharts out;
    out.indices.resize(mesh.indices.size());
    std::vector<std::uint32_t> newVertex(mesh.positions.size(), 0);
    std::vector<std::size_t> ownerChart(mesh.positions.size(), kNone);
    for (std::size_t c = 0; c < charts.size(); ++c) {
      for (const std::uint32_t t : charts[c].chart.triangles) {
        for (std::uint32_t corner = 3 * t; corner < 3 * t + 3; ++corner) {
          const std::uint32_t v = mesh.indices[corner];
          if (ownerChart[v] != c) {
            ownerChart[v] = c;
            newVertex[v] = static_cast<std::uint32_t>(out.sourceVertex.size());
            out.sourceVertex.push_back(v);
            out.uv.push_back(atlasUv(charts[c], mesh.positions[v], size));
          }
          out.indices[corner] = newVertex[v];
        }
      }
    }
    return out;
  }

  /// A mesh that shows no irradiance keeps its vertices; all lie at one point.
  static core::MeshCharts wholeMesh(const core::Mesh& mesh, const core::Vec2& uv) {
    core::MeshCharts out;
    out.sourceVertex.resize(mesh.positions.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      out.sourceVertex[v] = static_cast<std::uint32_t>(v);
    out.uv.assign(mesh.positions.size(), uv);
    out.indices = mesh.indices;
    return out;
  }

  const core::Scene& scene_;
  std::vector<std::vector<PlacedChart>> charts_;  ///< by mesh
  std::vector<std::uint32_t> order_;              ///< meshes in world space, in the order of their objects
  std::vector<Block> blocks_;
  std::vector<PlacedBlock> instances_;
  bool shared_ = false;  ///< some object shows no irradiance: all those share a texel
  Place sharedPlace_;
  double area_ = 0, largestExtent_ = 0;
  std::size_t count_ = 0;
};

/// Smallest texel side >= wish at which everything fits; 0 when not even one texel a chart fits.
double packFrom(Layout& layout, double wish, int size) {
  for (double texel = wish;; texel *= kCoarsenStep) {
    if (layout.pack(texel, size)) return texel;
    if (texel > 2 * layout.largestExtent()) return 0;  // every chart is one texel already
  }
}

/// Packs into the planned atlas, or a doubled one; sets out.size and out.texelMetres.
void chooseSize(ChartAtlas& out, Layout& layout, const core::Plan& plan, int maxAtlasSize) {
  out.size =
      std::clamp(plan.lightmapSize > 0 ? plan.lightmapSize : kDefaultSize, 1, std::max(maxAtlasSize, 1));
  for (;; out.size = std::min(2 * out.size, maxAtlasSize)) {
    const double fits = std::sqrt(layout.area() / (kFirstFill * out.size * static_cast<double>(out.size)));
    const double wish = std::max({static_cast<double>(plan.texelSizeMetres), fits, 1e-9});
    const double texel = packFrom(layout, wish, out.size);
    out.texelMetres = static_cast<float>(texel);
    if (texel > 0 && (texel <= kWorthDoubling * wish || out.size >= maxAtlasSize)) return;
    if (out.size >= maxAtlasSize) {
      throw core::Error("illumination maps: " + std::to_string(layout.chartCount()) +
                        " charts do not fit an atlas of " + std::to_string(maxAtlasSize) + " x " +
                        std::to_string(maxAtlasSize) +
                        " texels; join vertices of the scene's meshes or allow a larger atlas");
    }
  }
}

}  // namespace

bool showsIrradiance(const core::Material& m) {
  const bool metal = m.metallic >= 1 && !m.metallicRoughnessTexture;
  const bool clear = m.transmission >= 1 && !m.transmissionTexture;
  const bool black = m.baseColor.x <= 0 && m.baseColor.y <= 0 && m.baseColor.z <= 0;
  return !(m.unlit || metal || clear || black);
}

ChartAtlas makeCharts(const core::Scene& scene, const core::Plan& plan, int maxAtlasSize) {
  Layout layout(scene);
  ChartAtlas out;
  out.chartCount = layout.chartCount();
  chooseSize(out, layout, plan, maxAtlasSize);
  out.charts = layout.cut(out.size);
  return out;
}

}  // namespace saccade::raytrace
