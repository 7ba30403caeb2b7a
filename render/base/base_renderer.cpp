#include "render/base/base_renderer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/scene/texture_transform.h"
#include "render/base/background.h"
#include "render/base/features.h"
#include "render/base/frustum.h"
#include "render/base/geometry.h"
#include "render/base/portions.h"
#include "render/base/snapshot_pool.h"
#include "render/base/target.h"
#include "render/base/textures.h"

namespace saccade::render {

namespace {

struct Program {
  GlProgram program;
  GLint meshToClip = -1;
  GLint lightmapPlace = -1;
  GLint surface = -1;
  std::array<GLint, kTextureUses.size()> uvMatrix{};
};

Program makeProgram(const Gl& gl, Features features) {
  Program p;
  p.program = GlProgram(gl, buildProgram(gl, "base layer, features " + std::to_string(features),
                                         vertexShader(features), fragmentShader(features)));
  const GLuint name = p.program.name();
  p.meshToClip = gl.GetUniformLocation(name, "meshToClip");
  p.lightmapPlace = gl.GetUniformLocation(name, "lightmapPlace");
  p.surface = gl.GetUniformLocation(name, "surface");
  gl.UseProgram(name);
  // A uniform that the features leave out has location -1, which GL ignores.
  gl.Uniform1i(gl.GetUniformLocation(name, "maps"), kMapsUnit);
  gl.Uniform1i(gl.GetUniformLocation(name, "mapBlocks"), kMapBlocksUnit);
  for (std::size_t i = 0; i < kTextureUses.size(); ++i) {
    gl.Uniform1i(gl.GetUniformLocation(name, kTextureUses[i].sampler), kTextureUses[i].unit);
    p.uvMatrix[i] = gl.GetUniformLocation(name, kTextureUses[i].uvMatrix);
  }
  return p;
}

class Stopwatch {
 public:
  /// Seconds since the last lap.
  double lap() {
    const Clock::time_point from = std::exchange(last_, Clock::now());
    return std::chrono::duration<double>(last_ - from).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

struct Visible {
  float distanceSquared;  ///< eye to the object's bounds; infinite for bounds around the eye
  const DrawItem* item;
};

}  // namespace

struct BaseRenderer::State {
  State(GlContext& glContext, const core::Scene& drawnScene, DrawList drawList)
      : context(glContext),
        gl(glContext.gl()),
        scene(drawnScene),
        list(std::move(drawList)),
        target(gl, glContext.maxSize()),
        idCount(drawnScene.idCount()) {}

  GlContext& context;
  const Gl& gl;
  const core::Scene& scene;
  const DrawList list;
  Portions uploads;  ///< left to do
  Geometry geometry;
  std::vector<GlTexture> textures;  ///< by the scene's index; empty ones are not drawn
  MapTextures maps;
  std::map<Features, Program> programs;
  std::optional<Background> background;  ///< where the scene has an environment
  Target target;
  SnapshotPool pool;
  std::vector<char> visible;  ///< by object
  std::vector<Visible> order;
  DrawStats stats;
  std::uint32_t idCount;
  std::uint64_t mapsNumber = 0;

  // What GL has bound now, while drawing.
  const Program* boundProgram = nullptr;
  std::uint32_t boundAttributes = 0;
  std::array<int, kUnitCount> boundTextures{};
  bool culling = false;
  bool inWorldSpace = false;  ///< the program's uniforms are those of meshes in world space
  bool mirrored = false;

  void addUploads();
  void addTextures();
  void addMaps(const core::IlluminationMaps& shownMaps);
  void addFirstDraws();
  Features shown(Features features) const;
  const Program& program(Features features);
  void draw(const core::View& view, std::span<const char> hidden);
  void drawItem(const DrawItem& item, const core::View& view, bool cull, std::uint32_t indexCount);
  void beginDraw(const core::View& view);
  void useState(const DrawItem& item, const core::View& view);
  void placeMesh(const DrawItem& item, const core::View& view);
  void bindTexture(TextureUnit unit, const core::TextureSlot& slot);
  void cullBackFaces(bool cull);
  void sortVisible(const core::View& view, std::span<const char> hidden);
};

/// All but the maps.
void BaseRenderer::State::addUploads() {
  geometry.addUpload(gl, scene, list.parts, uploads);
  addTextures();
  if (scene.environment) background.emplace(gl, *scene.environment, context.maxSize(), uploads);
}

void BaseRenderer::State::addTextures() {
  textures.resize(scene.textures.size());
  std::vector<char> added(scene.textures.size(), 0);
  for (const DrawItem& item : list.items) {
    const core::Material& m = scene.materials[scene.objects[item.object].material];
    for (const TextureUse& use : kTextureUses) {
      if (!(item.features & use.texture)) continue;
      const auto index = static_cast<std::size_t>((m.*use.slot).texture);
      if (!std::exchange(added[index], 1))
        addUpload(gl, scene.textures[index], context.maxSize(), textures[index], uploads);
    }
  }
  uploads.add([this] { checkGl(gl, "uploading the textures"); });
}

void BaseRenderer::State::addMaps(const core::IlluminationMaps& shownMaps) {
  addUpload(gl, shownMaps, context.maxSize(), maps, uploads);
}

/// One triangle with every program and each set of textures that it reads, into a small target: GL compiles
/// what it needs at a first draw, which a software rasteriser takes tens of milliseconds for.
void BaseRenderer::State::addFirstDraws() {
  const auto view = std::make_shared<const core::View>(core::Camera{}, 8, 8, scene.bounds);
  std::set<std::vector<int>> drawn;
  for (const DrawItem& item : list.items) {
    const core::Material& m = scene.materials[scene.objects[item.object].material];
    std::vector<int> kind{static_cast<int>(item.features)};
    for (const TextureUse& use : kTextureUses)
      if (item.features & use.texture) kind.push_back((m.*use.slot).texture);
    if (!drawn.insert(std::move(kind)).second) continue;
    uploads.add([this, &item] { program(shown(item.features)); });
    uploads.add([this, &item, view] {
      beginDraw(*view);
      drawItem(item, *view, false, 3);
      gl.BindVertexArray(0);
      gl.Finish();
    });
  }
  uploads.add([this, view] {
    draw(*view, std::vector<char>(scene.objects.size(), 1));  // the background alone
    gl.Finish();
    checkGl(gl, "drawing for the first time");
  });
}

/// What is drawn with the maps at hand.
Features BaseRenderer::State::shown(Features features) const {
  if (maps.layers == 0) return withoutMaps(features);
  if (maps.layers == 1) features = withoutBackLayer(features);
  return maps.blocks.name() == 0 ? features : withMapDetail(features);
}

const Program& BaseRenderer::State::program(Features features) {
  const auto found = programs.find(features);
  if (found != programs.end()) return found->second;
  return programs.emplace(features, makeProgram(gl, features)).first->second;
}

void BaseRenderer::State::bindTexture(TextureUnit unit, const core::TextureSlot& slot) {
  if (boundTextures[unit] == slot.texture) return;
  boundTextures[unit] = slot.texture;
  gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  gl.BindTexture(GL_TEXTURE_2D, textures[static_cast<std::size_t>(slot.texture)].name());
}

void BaseRenderer::State::beginDraw(const core::View& view) {
  target.begin(view.width(), view.height());
  gl.Disable(GL_BLEND);
  gl.Disable(GL_SCISSOR_TEST);
  gl.Disable(GL_CULL_FACE);
  gl.CullFace(GL_BACK);
  gl.Enable(GL_DEPTH_TEST);
  gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  gl.DepthFunc(GL_GREATER);  // 1 is near
  gl.DepthMask(GL_TRUE);
  gl.FrontFace(GL_CW);  // View's clip space points down
  constexpr float kNothing[4] = {0, 0, 0, 0};
  constexpr float kFar = 0;
  gl.ClearBufferfv(GL_COLOR, 0, kNothing);
  gl.ClearBufferfv(GL_DEPTH, 0, &kFar);
  gl.ActiveTexture(GL_TEXTURE0 + kMapsUnit);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, maps.texels.name());
  gl.ActiveTexture(GL_TEXTURE0 + kMapBlocksUnit);
  gl.BindTexture(GL_TEXTURE_2D, maps.blocks.name());
  boundProgram = nullptr;
  boundAttributes = 0;
  culling = false;
  mirrored = false;
  boundTextures.fill(-1);
  stats = {};
}

void BaseRenderer::State::cullBackFaces(bool cull) {
  if (cull == culling) return;
  culling = cull;
  if (cull) {
    gl.Enable(GL_CULL_FACE);
  } else {
    gl.Disable(GL_CULL_FACE);
  }
}

void BaseRenderer::State::useState(const DrawItem& item, const core::View& view) {
  const Features features = shown(item.features);
  const Program& wanted = program(features);
  if (&wanted != boundProgram) {
    boundProgram = &wanted;
    gl.UseProgram(wanted.program.name());
    inWorldSpace = false;
  }
  placeMesh(item, view);
  if (item.attributes != boundAttributes) {
    boundAttributes = item.attributes;
    gl.BindVertexArray(geometry.vertexArray(item.attributes));
  }
  const core::Material& m = scene.materials[scene.objects[item.object].material];
  for (std::size_t i = 0; i < kTextureUses.size(); ++i) {
    const TextureUse& use = kTextureUses[i];
    if (features & use.texture) bindTexture(use.unit, m.*use.slot);
    if (features & use.transform)
      gl.UniformMatrix3x2fv(wanted.uvMatrix[i], 1, GL_FALSE, &core::uvMatrix(m.*use.slot)[0][0]);
  }
  SurfaceConstants c = list.constants[item.object];
  // Without maps the irradiance is pi, which the division by pi takes away.
  if (features & kLightmap) c.diffuse /= core::kPi;
  gl.Uniform4fv(wanted.surface, 3, &c.diffuse.x);
}

/// The position is one product for all programs: the same depth whatever the features.
void BaseRenderer::State::placeMesh(const DrawItem& item, const core::View& view) {
  if (item.mirrored != mirrored) {
    mirrored = item.mirrored;
    gl.FrontFace(mirrored ? GL_CCW : GL_CW);
  }
  if (!item.instanced && inWorldSpace) return;
  inWorldSpace = !item.instanced;
  const core::Object& object = scene.objects[item.object];
  core::Mat4 meshToClip = view.viewProjection();
  if (item.instanced) meshToClip = meshToClip * object.meshToWorld;
  gl.UniformMatrix4fv(boundProgram->meshToClip, 1, GL_FALSE, &meshToClip[0][0]);
  gl.Uniform4fv(boundProgram->lightmapPlace, 1, &object.lightmapScaleOffset.x);
}

/// Near objects first, so that what they hide is not shaded; objects around the camera (rooms) last. Ties
/// keep the order of `items`. A function of the view alone: so is the image, coplanar surfaces included.
void BaseRenderer::State::sortVisible(const core::View& view, std::span<const char> hidden) {
  findVisible(scene, view, visible);
  order.clear();
  const core::Vec3 eye = view.camera().eye;
  for (const DrawItem& item : list.items) {
    if (!visible[item.object] || (!hidden.empty() && hidden[item.object])) continue;
    const core::Bounds& bounds = scene.objects[item.object].bounds;
    const core::Vec3 nearest = glm::clamp(eye, bounds.lo, bounds.hi) - eye;
    const float squared = glm::dot(nearest, nearest);
    order.push_back({squared > 0 ? squared : core::kInfinity, &item});
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const Visible& a, const Visible& b) { return a.distanceSquared < b.distanceSquared; });
}

void BaseRenderer::State::drawItem(const DrawItem& item, const core::View& view, bool cull,
                                   std::uint32_t indexCount) {
  useState(item, view);
  cullBackFaces(cull);
  gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(indexCount), GL_UNSIGNED_INT,
                  reinterpret_cast<const void*>(std::size_t{item.firstIndex} * sizeof(std::uint32_t)));
}

void BaseRenderer::State::draw(const core::View& view, std::span<const char> hidden) {
  beginDraw(view);
  sortVisible(view, hidden);
  // A solid that the near plane cuts shows its inside.
  const float nearCorner = view.zNear() * glm::length(view.direction({0, 0}));
  for (const Visible& v : order) {
    const DrawItem& item = *v.item;
    const bool outside = v.distanceSquared > nearCorner * nearCorner && v.distanceSquared < core::kInfinity;
    drawItem(item, view, item.oneSided || (item.solid && outside), item.indexCount);
    stats.triangles += item.indexCount / 3;
  }
  stats.objectsDrawn = order.size();
  stats.objectsCulled = list.items.size() - order.size();
  if (background) background->draw(view);
  gl.BindVertexArray(0);
}

BaseRenderer::BaseRenderer(GlContext& context, const core::Scene& scene) {
  context.makeCurrent();
  state_ = std::make_unique<State>(context, scene, makeDrawList(scene));
  state_->addUploads();
  state_->uploads.finish();
}

BaseRenderer::BaseRenderer(std::unique_ptr<State> state) : state_(std::move(state)) {}

BaseRenderer::~BaseRenderer() { state_->context.makeCurrent(); }

void BaseRenderer::setMaps(const core::IlluminationMaps* maps) {
  state_->context.makeCurrent();
  state_->maps = MapTextures();
  state_->uploads = {};  // of maps that were refused half-way
  ++state_->mapsNumber;
  if (!maps) return;
  state_->addMaps(*maps);
  state_->uploads.finish();
}

std::shared_ptr<core::FrameSnapshot> BaseRenderer::render(const core::View& view, std::uint64_t epoch,
                                                          int nMin) {
  state_->context.makeCurrent();
  std::shared_ptr<core::FrameSnapshot> frame = state_->pool.take();
  Stopwatch watch;
  state_->draw(view, {});
  state_->gl.Finish();  // reading back would wait for it anyway
  state_->stats.drawSeconds = watch.lap();
  state_->target.read(*frame);
  checkGl(state_->gl, "drawing the base layer");
  state_->stats.readSeconds = watch.lap();
  frame->epoch = epoch;
  frame->view = view;
  core::measureExtents(*frame, state_->idCount, nMin);
  state_->stats.measureSeconds = watch.lap();
  return frame;
}

core::FramePtr BaseRenderer::renderWithout(const core::View& view, std::span<const char> hidden) {
  state_->context.makeCurrent();
  const DrawStats before = state_->stats;
  auto frame = std::make_shared<core::FrameSnapshot>();  // not the pool's: those are of the picture's size
  state_->draw(view, hidden);
  state_->target.read(*frame);
  checkGl(state_->gl, "drawing a light probe");
  state_->stats = before;
  frame->view = view;
  return frame;
}

std::uint64_t BaseRenderer::mapsNumber() const { return state_->mapsNumber; }

const DrawStats& BaseRenderer::lastDraw() const { return state_->stats; }

BaseUpload::BaseUpload(GlContext& context, const core::Scene& scene, DrawList list,
                       const core::IlluminationMaps* maps) {
  context.makeCurrent();
  state_ = std::make_unique<BaseRenderer::State>(context, scene, std::move(list));
  state_->addUploads();
  if (maps) state_->addMaps(*maps);
  state_->addFirstDraws();
}

BaseUpload::~BaseUpload() {
  if (state_) state_->context.makeCurrent();
}

bool BaseUpload::goOn(std::chrono::steady_clock::time_point until) {
  state_->context.makeCurrent();
  return state_->uploads.goOn(until);
}

std::unique_ptr<BaseRenderer> BaseUpload::take() {
  return std::unique_ptr<BaseRenderer>(new BaseRenderer(std::move(state_)));
}

}  // namespace saccade::render
