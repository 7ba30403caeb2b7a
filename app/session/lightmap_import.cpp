#include "app/session/lightmap_import.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/hdr_file.h"
#include "core/image_io.h"
#include "raytrace/bake/charts.h"

namespace saccade::app {
namespace {

std::string objectCount(std::size_t n) { return std::to_string(n) + (n == 1 ? " object" : " objects"); }

namespace fs = std::filesystem;

constexpr std::size_t kStrangersNamed = 5;

std::string lowerExtension(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return extension;
}

bool isImage(const fs::path& file) {
  constexpr std::array kExtensions = {".jpg", ".jpeg", ".png", ".hdr", ".exr"};
  const std::string extension = lowerExtension(file);
  return std::any_of(kExtensions.begin(), kExtensions.end(),
                     [&](const char* known) { return extension == known; });
}

/// "cornellBox.000.lightmap.jpg" is of the node "cornellBox.000".
std::string nodeNameOf(const fs::path& file) {
  constexpr std::string_view kSuffix = ".lightmap";
  std::string name = file.stem().string();
  if (name.size() > kSuffix.size() && name.ends_with(kSuffix)) name.resize(name.size() - kSuffix.size());
  return name;
}

std::map<std::string, std::vector<fs::path>> imagesByNode(const fs::path& folder) {
  std::error_code failed;
  std::map<std::string, std::vector<fs::path>> out;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
    if (isImage(at->path()) && at->is_regular_file()) out[nodeNameOf(at->path())].push_back(at->path());
  if (failed)
    throw core::Error(folder.string() + ": " + failed.message() +
                      "; --import takes a folder of images, or one image");
  return out;
}

/// Linear values of an 8-bit image.
core::ImageRgb decoded(const core::ImageRgba8& encoded) {
  std::array<float, 256> linear;
  for (std::size_t i = 0; i < linear.size(); ++i)
    linear[i] = core::decodeSrgb(static_cast<float>(i) / 255.0f);
  core::ImageRgb out(encoded.width(), encoded.height());
  std::transform(encoded.pixels().begin(), encoded.pixels().end(), out.pixels().begin(),
                 [&](const core::Rgba8& p) { return core::Vec3(linear[p.r], linear[p.g], linear[p.b]); });
  return out;
}

core::ImageRgb readLinear(const fs::path& file, core::LoadBudget& budget) {
  if (lowerExtension(file) == ".exr") return core::readExr(file, budget);
  const std::vector<std::uint8_t> bytes = core::readWholeFile(file, budget);
  if (lowerExtension(file) == ".hdr") return core::decodeHdr(bytes, file.string(), budget);
  const core::ImageRgba8 encoded = core::decodeImage(bytes, file.string(), budget);
  budget.charge(encoded.pixels().size(), sizeof(core::Vec3), file.string());
  return decoded(encoded);
}

core::ImageRgb readIrradiance(const fs::path& file, float scale, core::LoadBudget& budget) {
  core::ImageRgb out = readLinear(file, budget);
  const float factor = std::numbers::pi_v<float> * scale;
  for (core::Vec3& pixel : out.pixels()) {
    for (int c = 0; c < 3; ++c) {
      const float value = pixel[c] * factor;
      pixel[c] = std::isfinite(value) ? std::max(value, 0.0f) : 0.0f;
    }
  }
  return out;
}

/// Objects that show light, by whether their meshes have a place for it: of the nodes called `name`, or all.
struct Takers {
  bool named = false;
  std::vector<std::size_t> able, unable;
};
Takers takersOf(const core::Scene& scene, const std::optional<std::string>& name) {
  Takers out;
  for (const core::Node& node : scene.nodes) out.named = out.named || node.name == name;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const core::Object& object = scene.objects[o];
    const bool ofNode = object.node >= 0 && scene.nodes[static_cast<std::size_t>(object.node)].name == name;
    if (name && !ofNode) continue;
    if (!raytrace::showsIrradiance(scene.materials[static_cast<std::size_t>(object.material)])) continue;
    (raytrace::hasLightmapUv(scene.meshOf(object)) ? out.able : out.unable).push_back(o);
  }
  return out;
}

void reportBaked(const core::Scene& scene, const raytrace::ImportedLight& imported, LightmapReport& report) {
  std::set<std::string> names;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const core::Object& object = scene.objects[o];
    if (imported.imageOfObject[o] >= 0 || object.node < 0) continue;
    if (!raytrace::showsIrradiance(scene.materials[static_cast<std::size_t>(object.material)])) continue;
    names.insert(scene.nodes[static_cast<std::size_t>(object.node)].name);
  }
  report.baked.assign(names.begin(), names.end());
}

/// One image for all of the scene.
void readAtlas(const fs::path& file, const core::Scene& scene, float scale, core::LoadBudget& budget,
               raytrace::ImportedLight& out, LightmapReport& report) {
  const Takers takers = takersOf(scene, std::nullopt);
  if (takers.able.empty())
    throw core::Error(file.string() + ": no node of the scene has a second UV set to place it by");
  if (!takers.unable.empty())
    report.warnings.push_back(
        fmt::format("{} without a second UV set: baked", objectCount(takers.unable.size())));
  out.images.push_back(readIrradiance(file, scale, budget));
  for (const std::size_t o : takers.able) out.imageOfObject[o] = 0;
  report.taken.push_back(fmt::format("{} ({}x{}): {}", file.filename().string(), out.images[0].width(),
                                     out.images[0].height(), objectCount(takers.able.size())));
}

}  // namespace

raytrace::ImportedLight readLightmaps(const fs::path& folder, const core::Scene& scene, float scale,
                                      const core::LoadLimits& limits, LightmapReport& report) {
  core::LoadBudget budget(limits, folder.string());
  if (!(scale > 0 && scale < core::kInfinity))
    throw core::UsageError("--import-scale must be a positive number");
  raytrace::ImportedLight out;
  out.imageOfObject.assign(scene.objects.size(), -1);
  if (std::error_code ignored; isImage(folder) && fs::is_regular_file(folder, ignored)) {
    readAtlas(folder, scene, scale, budget, out, report);
    reportBaked(scene, out, report);
    return out;
  }
  std::size_t strangers = 0;
  for (const auto& [name, files] : imagesByNode(folder)) {
    const Takers takers = takersOf(scene, name);
    const std::string shown = files[0].filename().string();
    if (!takers.named) {
      if (strangers++ < kStrangersNamed)
        report.warnings.push_back("'" + shown + "' matches no node of the scene");
      continue;
    }
    if (files.size() > 1)
      throw core::Error(folder.string() + ": '" + shown + "' and '" + files[1].filename().string() +
                        "' are for the same node; keep one of them");
    if (!takers.unable.empty())
      report.warnings.push_back(
          fmt::format("node '{}' has parts without a second UV set; '{}' does not light them, they are baked",
                      name, shown));
    if (takers.able.empty()) continue;
    out.images.push_back(readIrradiance(files[0], scale, budget));
    for (const std::size_t o : takers.able) out.imageOfObject[o] = static_cast<int>(out.images.size()) - 1;
    report.taken.push_back(fmt::format("{} ({}x{}): node '{}', {}", shown, out.images.back().width(),
                                       out.images.back().height(), name, objectCount(takers.able.size())));
  }
  if (strangers > kStrangersNamed)
    report.warnings.push_back("and " + std::to_string(strangers - kStrangersNamed) +
                              " more images match no node");
  if (out.images.empty())
    throw core::Error(
        folder.string() +
        ": no image there fits a node of the scene; name them NODE.lightmap.png (or .jpg, .hdr, .exr) "
        "after nodes whose meshes have a second UV set");
  reportBaked(scene, out, report);
  return out;
}

}  // namespace saccade::app
