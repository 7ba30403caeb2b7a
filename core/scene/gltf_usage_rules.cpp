// glTF 2.0, 3.6.2: an accessor and a bufferView serve one purpose, and only vertex data has a stride.
#include <set>

#include "core/scene/gltf_rules.h"

namespace saccade::core {
namespace {

enum class Use { vertices, indices, matrices, animationInput, animationOutput, other };

class Usage {
 public:
  explicit Usage(const Element& root)
      : accessors_(root.array("accessors")),
        views_(root.array("bufferViews")),
        accessorUses_(accessors_.size()),
        viewUses_(views_.size()),
        vertexAccessors_(views_.size()) {}

  void accessor(const Json& index, Use use) {
    const std::size_t i = index.get<std::size_t>();
    const Json& json = accessors_[i].json();
    accessorUses_[i].insert(use);
    if (!json.contains("bufferView")) return;
    const std::size_t at = json["bufferView"].get<std::size_t>();
    viewUses_[at].insert(use == Use::vertices || use == Use::indices ? use : Use::other);
    if (use == Use::vertices) vertexAccessors_[at].insert(i);
  }
  void view(const Json& index) { viewUses_[index.get<std::size_t>()].insert(Use::other); }

  void report(Repairs& repairs) const {
    for (std::size_t i = 0; i < accessors_.size(); ++i) {
      if (accessorUses_[i].size() > 1) repairs.add("accessors serve several purposes", accessors_[i].path());
    }
    for (std::size_t i = 0; i < views_.size(); ++i) reportView(i, repairs);
  }

 private:
  void reportView(std::size_t i, Repairs& repairs) const {
    const Element& view = views_[i];
    std::set<Use> uses = viewUses_[i];
    const bool stride = view.has("byteStride");
    if (view.has("target")) uses.insert(view.json()["target"] == kArrayBuffer ? Use::vertices : Use::indices);
    if (uses.size() > 1) repairs.add("bufferViews serve several purposes", view.path());
    if (stride && !uses.empty() && uses != std::set{Use::vertices})
      repairs.add("bufferViews have a byteStride though they hold no vertex data", view.path());
    if (!stride && vertexAccessors_[i].size() > 1)
      repairs.add("bufferViews of several vertex arrays lack a byteStride and were taken as packed",
                  view.path());
  }

  static constexpr int kArrayBuffer = 34962;
  std::vector<Element> accessors_, views_;
  std::vector<std::set<Use>> accessorUses_, viewUses_;
  std::vector<std::set<std::size_t>> vertexAccessors_;
};

}  // namespace

void checkUsage(const Element& root, Repairs& repairs) {
  Usage usage(root);
  for (const Element& mesh : root.array("meshes"))
    for (const Element& primitive : mesh.array("primitives")) {
      for (const Json& index : primitive.json()["attributes"]) usage.accessor(index, Use::vertices);
      if (primitive.has("indices")) usage.accessor(primitive.json()["indices"], Use::indices);
    }
  for (const Element& skin : root.array("skins"))
    if (skin.has("inverseBindMatrices")) usage.accessor(skin.json()["inverseBindMatrices"], Use::matrices);
  for (const Element& animation : root.array("animations"))
    for (const Element& sampler : animation.array("samplers")) {
      usage.accessor(sampler.json()["input"], Use::animationInput);
      usage.accessor(sampler.json()["output"], Use::animationOutput);
    }
  for (const Element& accessor : root.array("accessors")) {
    if (!accessor.has("sparse")) continue;
    for (const char* part : {"indices", "values"}) usage.view(accessor.json()["sparse"][part]["bufferView"]);
  }
  for (const Element& image : root.array("images"))
    if (image.has("bufferView")) usage.view(image.json()["bufferView"]);
  usage.report(repairs);
}

}  // namespace saccade::core
