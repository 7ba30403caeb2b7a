// The objects of glTF 2.0 (Khronos, section 5), property by property.
#include <array>

#include "core/scene/gltf_gate.h"
#include "core/scene/gltf_rule_makers.h"

namespace saccade::core {
namespace {

using namespace rules;

constexpr double kLargestByte = 9007199254740992.0;  // 2^53: what JSON numbers hold exactly
constexpr const char* kCameraValues = "camera values out of range were dropped";

// ---- asset, buffers, accessors

constexpr std::array kAssetProperties = {text("version").must(), text("minVersion"), text("generator"),
                                         text("copyright")};
constexpr ObjectRule kAsset{kAssetProperties};

constexpr std::array kBufferProperties = {text("uri"), integer("byteLength").in(1, kLargestByte).must(),
                                          text("name")};
constexpr ObjectRule kBuffer{kBufferProperties};

constexpr std::array<std::uint64_t, 2> kViewTargets = {34962, 34963};
constexpr std::array kViewProperties = {
    index("buffer", "buffers").must(),
    integer("byteOffset").in(0, kLargestByte),
    integer("byteLength").in(1, kLargestByte).must(),
    integer("byteStride").in(4, 252),
    oneOf("target", kViewTargets).mend("bufferView targets that glTF does not know were dropped"),
    text("name")};
constexpr ObjectRule kView{kViewProperties};

constexpr std::array<std::uint64_t, 6> kComponentTypes = {5120, 5121, 5122, 5123, 5125, 5126};
constexpr std::array<std::uint64_t, 3> kIndexTypes = {5121, 5123, 5125};
constexpr std::array kAccessorTypes = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
constexpr std::array kSparseIndexProperties = {index("bufferView", "bufferViews").must(),
                                               integer("byteOffset").in(0, kLargestByte),
                                               oneOf("componentType", kIndexTypes).must()};
constexpr ObjectRule kSparseIndices{kSparseIndexProperties};
constexpr std::array kSparseValueProperties = {index("bufferView", "bufferViews").must(),
                                               integer("byteOffset").in(0, kLargestByte)};
constexpr ObjectRule kSparseValues{kSparseValueProperties};
constexpr std::array kSparseProperties = {integer("count").in(1, kMaxAccessorElements).must(),
                                          object("indices", kSparseIndices).must(),
                                          object("values", kSparseValues).must()};
constexpr ObjectRule kSparse{kSparseProperties};
constexpr std::array kAccessorProperties = {index("bufferView", "bufferViews"),
                                            integer("byteOffset").in(0, kLargestByte),
                                            oneOf("componentType", kComponentTypes).must(),
                                            flag("normalized"),
                                            integer("count").in(1, kMaxAccessorElements).must(),
                                            oneOf("type", kAccessorTypes).must(),
                                            numbers("max", 0),
                                            numbers("min", 0),
                                            object("sparse", kSparse),
                                            text("name")};
constexpr ObjectRule kAccessor{kAccessorProperties};

// ---- images, samplers, textures, materials

constexpr std::array kImageProperties = {text("uri"), text("mimeType"), index("bufferView", "bufferViews"),
                                         text("name")};
constexpr ObjectRule kImage{kImageProperties};

constexpr const char* kSamplerModes = "sampler modes that glTF does not know were left at their default";
constexpr std::array<std::uint64_t, 2> kMagFilters = {9728, 9729};
constexpr std::array<std::uint64_t, 6> kMinFilters = {9728, 9729, 9984, 9985, 9986, 9987};
constexpr std::array<std::uint64_t, 3> kWraps = {33071, 33648, 10497};
constexpr std::array kSamplerProperties = {
    oneOf("magFilter", kMagFilters).mend(kSamplerModes), oneOf("minFilter", kMinFilters).mend(kSamplerModes),
    oneOf("wrapS", kWraps).mend(kSamplerModes), oneOf("wrapT", kWraps).mend(kSamplerModes), text("name")};
constexpr ObjectRule kSampler{kSamplerProperties};

constexpr std::array kTextureProperties = {index("sampler", "samplers"), index("source", "images"),
                                           text("name")};
constexpr ObjectRule kTexture{kTextureProperties, Place::texture};

constexpr std::array kTextureInfoProperties = {index("index", "textures").must(), kTexCoord};
constexpr std::array kNormalTextureProperties = {index("index", "textures").must(), kTexCoord,
                                                 number("scale").mend(kMaterialFactors)};
constexpr std::array kOcclusionTextureProperties = {index("index", "textures").must(), kTexCoord,
                                                    number("strength").in(0, 1).mend(kMaterialFactors)};
constexpr ObjectRule kOcclusionTexture{kOcclusionTextureProperties, Place::textureInfo};

constexpr std::array kPbrProperties = {
    numbers("baseColorFactor", 4).in(0, 1).mend(kMaterialFactors), texture("baseColorTexture"),
    number("metallicFactor").in(0, 1).mend(kMaterialFactors),
    number("roughnessFactor").in(0, 1).mend(kMaterialFactors), texture("metallicRoughnessTexture")};
constexpr ObjectRule kPbr{kPbrProperties};
constexpr std::array kAlphaModes = {"OPAQUE", "MASK", "BLEND"};
constexpr std::array kMaterialProperties = {
    object("pbrMetallicRoughness", kPbr),
    object("normalTexture", kNormalTextureInfo),
    object("occlusionTexture", kOcclusionTexture),
    texture("emissiveTexture"),
    numbers("emissiveFactor", 3).in(0, 1).mend(kMaterialFactors),
    oneOf("alphaMode", kAlphaModes).mend("alpha modes that glTF does not know were taken as OPAQUE"),
    number("alphaCutoff").atLeast(0).mend(kMaterialFactors),
    flag("doubleSided"),
    text("name")};
constexpr ObjectRule kMaterial{kMaterialProperties, Place::material};

// ---- meshes, cameras, nodes, scenes

constexpr std::array kPrimitiveProperties = {indexMap("attributes", "accessors").must(),
                                             index("indices", "accessors"), index("material", "materials"),
                                             integer("mode").in(0, 6)};
constexpr ObjectRule kPrimitive{kPrimitiveProperties, Place::primitive};
constexpr std::array kMeshProperties = {objects("primitives", kPrimitive).must(), numbers("weights", 0),
                                        text("name")};
constexpr ObjectRule kMesh{kMeshProperties};

constexpr std::array kPerspectiveProperties = {
    number("aspectRatio").above(0).mend(kCameraValues), number("yfov").must(),
    number("zfar").above(0).mend(kCameraValues), number("znear").must()};
constexpr ObjectRule kPerspective{kPerspectiveProperties};
constexpr std::array kOrthographicProperties = {number("xmag").must(), number("ymag").must(),
                                                number("zfar").must(), number("znear").must()};
constexpr ObjectRule kOrthographic{kOrthographicProperties};
constexpr std::array kCameraProperties = {text("type").must(), object("perspective", kPerspective),
                                          object("orthographic", kOrthographic), text("name")};
constexpr ObjectRule kCamera{kCameraProperties};

constexpr std::array kNodeProperties = {index("camera", "cameras"), indices("children", "nodes"),
                                        index("skin", "skins"),     numbers("matrix", 16),
                                        index("mesh", "meshes"),    numbers("rotation", 4),
                                        numbers("scale", 3),        numbers("translation", 3),
                                        numbers("weights", 0),      text("name")};
constexpr ObjectRule kNode{kNodeProperties, Place::node};

constexpr std::array kSceneProperties = {indices("nodes", "nodes"), text("name")};
constexpr ObjectRule kScene{kSceneProperties};

// ---- skins, animations

constexpr std::array kSkinProperties = {index("inverseBindMatrices", "accessors"), index("skeleton", "nodes"),
                                        indices("joints", "nodes").must(), text("name")};
constexpr ObjectRule kSkin{kSkinProperties};

constexpr std::array kTargetProperties = {index("node", "nodes"), text("path").must()};
constexpr ObjectRule kTarget{kTargetProperties, Place::channelTarget};
constexpr std::array kChannelProperties = {integer("sampler").in(0, kLargestByte).must(),
                                           object("target", kTarget).must()};
constexpr ObjectRule kChannel{kChannelProperties};
constexpr std::array kInterpolations = {"LINEAR", "STEP", "CUBICSPLINE"};
constexpr std::array kAnimationSamplerProperties = {
    index("input", "accessors").must(),
    oneOf("interpolation", kInterpolations)
        .mend("animation interpolations that glTF does not know were taken as LINEAR"),
    index("output", "accessors").must()};
constexpr ObjectRule kAnimationSampler{kAnimationSamplerProperties};
constexpr std::array kAnimationProperties = {objects("channels", kChannel).must(),
                                             objects("samplers", kAnimationSampler).must(), text("name")};
constexpr ObjectRule kAnimation{kAnimationProperties};

constexpr std::array kRootProperties = {
    texts("extensionsUsed"),         texts("extensionsRequired"),       object("asset", kAsset).must(),
    objects("accessors", kAccessor), objects("animations", kAnimation), objects("buffers", kBuffer),
    objects("bufferViews", kView),   objects("cameras", kCamera),       objects("images", kImage),
    objects("materials", kMaterial), objects("meshes", kMesh),          objects("nodes", kNode),
    objects("samplers", kSampler),   index("scene", "scenes"),          objects("scenes", kScene),
    objects("skins", kSkin),         objects("textures", kTexture)};

}  // namespace

constinit const ObjectRule kTextureInfo{kTextureInfoProperties, Place::textureInfo};
constinit const ObjectRule kNormalTextureInfo{kNormalTextureProperties, Place::textureInfo};
constinit const ObjectRule kGltfRoot{kRootProperties, Place::root};

}  // namespace saccade::core
