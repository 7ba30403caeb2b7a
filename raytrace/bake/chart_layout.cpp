#include "raytrace/bake/chart_layout.h"

#include <stb/stb_rect_pack.h>

#include <algorithm>
#include <cmath>

#include "core/scene/median_edge.h"
#include "raytrace/bake/charts.h"

namespace saccade::raytrace {
namespace {

constexpr int kBorder = 1;        // texels around a chart that are its own: two between charts
constexpr double kOfAtlas = 0.5;  // that meshes with an atlas of their own, or lit by vertex, may take
// Light by vertex, as measured (docs/design.md): on a mesh that is bumpy at the scale of its edges a vertex
// is worth two to four texels, for light turns with the normals; on a smooth one it is worth one.
constexpr double kCrumpled = 1.5;     // texels that charts take, over those that their surface would
constexpr double kVertexWorth = 2;    // texels
constexpr double kMostDoublings = 6;  // of an object's block: its border widens with it
constexpr double kReportStep = 0.02;  // of all triangles

int texelsFor(double metres, double texel) {
  return static_cast<int>(std::clamp(std::round(metres / texel), 1.0, 1e6));
}

double areaOf(const core::Mesh& mesh) {
  double twice = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::dvec3 a = mesh.positions[mesh.indices[i]];
    twice += glm::length(glm::cross(glm::dvec3(mesh.positions[mesh.indices[i + 1]]) - a,
                                    glm::dvec3(mesh.positions[mesh.indices[i + 2]]) - a));
  }
  return 0.5 * twice;
}

/// Cube root of the volume that a unit of the mesh's space takes.
double unitOf(const core::Object& object) {
  return std::cbrt(std::abs(glm::determinant(glm::dmat3(object.meshToWorld))));
}

}  // namespace

ChartLayout::ChartLayout(const core::Scene& scene, double mostTexels, VertexLight vertexLight,
                         double withBlocks, const core::Progress& progress)
    : scene_(scene),
      charts_(scene.meshes.size()),
      chartOfTriangle_(scene.meshes.size()),
      own_(scene.meshes.size()),
      vertices_(scene.meshes.size()),
      mostTexels_(mostTexels),
      withBlocks_(std::max(mostTexels, withBlocks)),
      vertexLight_(vertexLight) {
  shareTexels(mostTexels);
  std::vector<std::size_t> blockOf(scene.meshes.size(), kNone);
  const auto triangles = static_cast<double>(scene.triangleCount());
  double done = 0, reported = 0;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    core::throwIfStopped(progress.stop);
    addObject(o, blockOf, progress.stop);
    done += static_cast<double>(scene.meshOf(scene.objects[o]).triangleCount()) / triangles;
    if (!progress.report || done < reported + kReportStep) continue;
    progress.report(std::min(done, 1.0));
    reported = done;
  }
  if (shared_) sharedPlace_.width = sharedPlace_.height = 1 + 2 * kBorder;
}

void ChartLayout::addObject(std::size_t o, std::vector<std::size_t>& blockOf, const std::stop_token& stop) {
  const core::Object& object = scene_.objects[o];
  firstItem_.push_back(items_.size());
  if (!isLit(object)) {
    shared_ = true;
  } else if (scene_.meshOf(object).instanced) {
    addInstance(o, blockOf[object.mesh], stop);
  } else {
    const std::vector<PlacedChart>& charts = chartsOf(object.mesh, stop);
    order_.push_back(object.mesh);
    orderItem_.push_back(items_.size());
    for (std::size_t c = 0; c < charts.size(); ++c) addItem(charts, c, c + 1, 1);
  }
}

bool ChartLayout::isLit(const core::Object& object) const {
  return showsIrradiance(scene_.materials[static_cast<std::size_t>(object.material)]);
}

void ChartLayout::addInstance(std::size_t o, std::size_t& block, const std::stop_token& stop) {
  const core::Object& object = scene_.objects[o];
  const double unit = unitOf(object);
  if (block == kNone) {
    block = blocks_.size();
    blocks_.push_back({object.mesh, 0, 0});
  }
  instances_.push_back({o, block, unit, 1, {}});
  const std::vector<PlacedChart>& charts = chartsOf(object.mesh, stop);
  addItem(charts, 0, charts.size(), unit);
}

/// By surface in the world; a mesh's objects share what it gets.
void ChartLayout::shareTexels(double mostTexels) {
  std::vector<double> area(scene_.meshes.size(), 0);
  std::vector<double> objects(scene_.meshes.size(), 0);
  double total = 0;
  for (const core::Object& object : scene_.objects) {
    if (!isLit(object)) continue;
    const double unit = unitOf(object), added = unit * unit * areaOf(scene_.meshOf(object));
    ++objects[object.mesh];
    if (!std::isfinite(added)) continue;
    area[object.mesh] += added;
    total += added;
  }
  for (std::size_t m = 0; m < area.size(); ++m)
    shares_.push_back(area[m] > 0 ? kOfAtlas * mostTexels * area[m] / (total * objects[m]) : 0);
}

/// Charts of a mesh, made once.
std::vector<ChartLayout::PlacedChart>& ChartLayout::chartsOf(std::uint32_t mesh,
                                                             const std::stop_token& stop) {
  std::vector<PlacedChart>& charts = charts_[mesh];
  if (!charts.empty()) return charts;
  own_[mesh] = examineAtlas(scene_.meshes[mesh], shares_[mesh]);
  ++ownAtlases_[static_cast<std::size_t>(own_[mesh].fault)];
  std::vector<std::uint32_t>& chartOf = chartOfTriangle_[mesh];
  chartOf.resize(scene_.meshes[mesh].triangleCount());
  if (own_[mesh].fault == AtlasFault::none) {
    keepAtlas(mesh);
    return charts;
  }
  std::vector<Chart> clusters = clusterMesh(scene_.meshes[mesh], stop);
  if (lightByVertex(mesh, clusters)) return charts;
  for (Chart& chart : clusters) {
    for (const std::uint32_t t : chart.triangles) chartOf[t] = static_cast<std::uint32_t>(charts.size());
    charts.push_back({std::move(chart), {}});
  }
  return charts;
}

/// One rectangle that stands for all its charts.
void ChartLayout::keepAtlas(std::uint32_t mesh) {
  PlacedChart whole;
  whole.chart.hi = (own_[mesh].hi - own_[mesh].lo) * own_[mesh].metres;
  whole.coarsestTexel = own_[mesh].coarsestTexel;
  charts_[mesh].push_back(std::move(whole));
}

/// One rectangle of fixed size, where it pays.
bool ChartLayout::lightByVertex(std::uint32_t m, const std::vector<Chart>& clusters) {
  const core::Mesh& mesh = scene_.meshes[m];
  if (vertexLight_ == VertexLight::never || mesh.instanced || !(shares_[m] > 0)) return false;
  if (mesh.positions.size() < core::kDenseVertices) return false;
  const double area = areaOf(mesh);
  const double texel = std::sqrt(kOfAtlas * area / shares_[m] * mostTexels_ / withBlocks_);  // of all, evenly
  if (!(texel > 0)) return false;
  double charts = 0;
  for (const Chart& c : clusters) {
    const glm::dvec2 extent = c.hi - c.lo;
    charts += (texelsFor(extent.x, texel) + 2.0 * kBorder) * (texelsFor(extent.y, texel) + 2.0 * kBorder);
  }
  PlacedChart whole;
  whole.edge = core::medianEdge(mesh);
  if (whole.edge > texel || charts < kCrumpled * area / (texel * texel)) return false;
  VertexTexels vertices = vertexTexels(mesh);
  whole.place.width = vertices.width() + 2 * kBorder;
  whole.place.height = vertices.height() + 2 * kBorder;
  const double own = static_cast<double>(whole.place.width) * whole.place.height;
  if (own > kVertexWorth * charts || vertexTexelCount_ + own > kOfAtlas * mostTexels_) return false;
  ++vertexLitMeshes_;
  vertexTexelCount_ += own;
  vertices_[m] = std::move(vertices);
  charts_[m].push_back(std::move(whole));
  return true;
}

void ChartLayout::addItem(const std::vector<PlacedChart>& charts, std::size_t first, std::size_t last,
                          double unit) {
  LayoutItem item;
  for (std::size_t c = first; c < last; ++c) {
    const glm::dvec2 extent = (charts[c].chart.hi - charts[c].chart.lo) * unit;
    item.rectangle += extent.x * extent.y;
    item.largestExtent = std::max({item.largestExtent, extent.x, extent.y});
    item.edge = charts[c].edge;
  }
  count_ += last - first;
  items_.push_back(item);
}

std::size_t ChartLayout::itemOf(std::size_t object, std::size_t triangle) const {
  const core::Object& o = scene_.objects[object];
  const bool instanced = scene_.meshOf(o).instanced;
  return firstItem_[object] + (instanced ? 0 : chartOfTriangle_[o.mesh][triangle]);
}

/// Widths and heights of all rectangles.
void ChartLayout::size(std::span<const double> texelMetres) {
  const auto sizeCharts = [](PlacedChart& p, double wished) {
    const double texel = std::min(wished, p.coarsestTexel);
    if (p.edge > 0) return;
    const glm::dvec2 extent = p.chart.hi - p.chart.lo;
    p.place.width = texelsFor(extent.x, texel) + 2 * kBorder;
    p.place.height = texelsFor(extent.y, texel) + 2 * kBorder;
  };
  for (std::size_t i = 0; i < order_.size(); ++i) {
    std::size_t item = orderItem_[i];
    for (PlacedChart& p : charts_[order_[i]]) sizeCharts(p, texelMetres[item++]);
  }
  // A block is as coarse as its coarsest object wishes, in units of the mesh; finer ones scale it up.
  std::vector<double> coarsest(blocks_.size(), 0);
  for (const PlacedBlock& b : instances_) {
    coarsest[b.block] = std::max(coarsest[b.block], texelMetres[firstItem_[b.object]] / b.unit);
  }
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    for (PlacedChart& p : charts_[blocks_[b].mesh]) {
      coarsest[b] = std::min(coarsest[b], p.coarsestTexel);
      sizeCharts(p, coarsest[b]);
    }
  }
  for (PlacedBlock& b : instances_) {
    const double ratio = coarsest[b.block] * b.unit / texelMetres[firstItem_[b.object]];
    b.scale = 1 << static_cast<int>(std::clamp(std::round(std::log2(ratio)), 0.0, kMostDoublings));
  }
}

double ChartLayout::texelCount(std::span<const double> texelMetres) {
  size(texelMetres);
  const auto texelsOf = [&](std::uint32_t mesh) {
    double sum = 0;
    for (const PlacedChart& p : charts_[mesh]) sum += static_cast<double>(p.place.width) * p.place.height;
    return sum;
  };
  double sum = static_cast<double>(sharedPlace_.width) * sharedPlace_.height;
  for (const std::uint32_t mesh : order_) sum += texelsOf(mesh);
  std::vector<double> ofBlock;
  for (const Block& b : blocks_) ofBlock.push_back(texelsOf(b.mesh));
  for (const PlacedBlock& b : instances_) sum += ofBlock[b.block] * b.scale * b.scale;
  return sum;
}

bool ChartLayout::pack(std::span<const double> texelMetres, int size) {
  this->size(texelMetres);
  std::vector<Place*> places;
  for (const std::uint32_t mesh : order_) {
    for (PlacedChart& p : charts_[mesh]) places.push_back(&p.place);
  }
  if (shared_) places.push_back(&sharedPlace_);
  for (Block& b : blocks_) {
    if (!packBlock(b, size)) return false;
  }
  for (PlacedBlock& b : instances_) {
    b.place.width = blocks_[b.block].width * b.scale;
    b.place.height = blocks_[b.block].height * b.scale;
    places.push_back(&b.place);
  }
  return packRects(places, size, size);
}

/// Places the rectangles in width x height texels; false when they do not fit.
bool ChartLayout::packRects(const std::vector<Place*>& places, int width, int height) {
  if (places.empty()) return true;  // the packer sorts without looking whether there is anything
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

/// Of charts that have their sizes.
bool ChartLayout::packBlock(Block& block, int size) {
  std::vector<Place*> places;
  double needed = 0;
  int widest = 1;
  for (PlacedChart& p : charts_[block.mesh]) {
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

core::SceneCharts ChartLayout::cut(int size) const {
  core::SceneCharts out;
  const core::Vec2 shared =
      (core::Vec2(static_cast<float>(sharedPlace_.x), static_cast<float>(sharedPlace_.y)) +
       (kBorder + 0.5f)) /
      static_cast<float>(size);
  for (std::size_t m = 0; m < scene_.meshes.size(); ++m) {
    const core::Mesh& mesh = scene_.meshes[m];
    if (charts_[m].empty()) {
      const core::Vec2 point = mesh.instanced ? core::Vec2(0) : shared;
      out.meshes.push_back(wholeMesh(mesh, std::vector<core::Vec2>(mesh.positions.size(), point)));
    } else if (vertices_[m].count > 0) {
      out.meshes.push_back(vertexLitMesh(static_cast<std::uint32_t>(m), size));
    } else if (own_[m].fault == AtlasFault::none) {
      out.meshes.push_back(keptMesh(static_cast<std::uint32_t>(m), size));
    } else {
      out.meshes.push_back(cutMesh(mesh, charts_[m], size));
    }
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

core::Vec2 ChartLayout::atlasUv(const PlacedChart& placed, const glm::dvec2& projected, int size) {
  const Chart& chart = placed.chart;
  const glm::dvec2 extent = chart.hi - chart.lo;
  const glm::dvec2 q = projected - chart.lo;
  const auto texel = [](double at, double whole, int first, int count) {
    const double share = whole > 0 && std::isfinite(at) ? std::clamp(at / whole, 0.0, 1.0) : 0.5;
    return first + kBorder + share * (count - 2 * kBorder);
  };
  return core::Vec2(texel(q.x, extent.x, placed.place.x, placed.place.width) / size,
                    texel(q.y, extent.y, placed.place.y, placed.place.height) / size);
}

/// New vertices, chart by chart.
core::MeshCharts ChartLayout::cutMesh(const core::Mesh& mesh, const std::vector<PlacedChart>& charts,
                                      int size) {
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
          out.uv.push_back(atlasUv(charts[c], charts[c].chart.project(mesh.positions[v]), size));
        }
        out.indices[corner] = newVertex[v];
      }
    }
  }
  return out;
}

/// A mesh that shows no irradiance, or keeps its second UV set, keeps its vertices.
core::MeshCharts ChartLayout::wholeMesh(const core::Mesh& mesh, std::vector<core::Vec2> uv) {
  core::MeshCharts out;
  out.sourceVertex.resize(mesh.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) out.sourceVertex[v] = static_cast<std::uint32_t>(v);
  out.uv = std::move(uv);
  out.indices = mesh.indices;
  return out;
}

core::MeshCharts ChartLayout::vertexLitMesh(std::uint32_t m, int size) const {
  const Place& place = charts_[m].front().place;
  const auto width = static_cast<std::uint32_t>(vertices_[m].width());
  std::vector<core::Vec2> uv;
  uv.reserve(vertices_[m].numberOf.size());
  for (const std::uint32_t n : vertices_[m].numberOf) {
    const std::uint32_t row = n / width, column = n % width;
    const core::Vec2 texel(static_cast<float>(place.x + kBorder) + static_cast<float>(column),
                           static_cast<float>(place.y + kBorder) + static_cast<float>(row));
    uv.push_back((texel + 0.5f) / static_cast<float>(size));
  }
  core::MeshCharts out = wholeMesh(scene_.meshes[m], std::move(uv));
  out.perVertex = true;
  return out;
}

core::MeshCharts ChartLayout::keptMesh(std::uint32_t m, int size) const {
  const core::Mesh& mesh = scene_.meshes[m];
  std::vector<core::Vec2> uv;
  uv.reserve(mesh.uv1.size());
  for (const core::Vec2& uv1 : mesh.uv1)
    uv.push_back(atlasUv(charts_[m].front(), own_[m].project(uv1), size));
  return wholeMesh(mesh, std::move(uv));
}

}  // namespace saccade::raytrace
