#include "core/scene/load.h"

#include <algorithm>
#include <fstream>
#include <new>

#include "core/scene/loaders.h"

namespace saccade::core {
namespace {

enum class Format { gltf, obj, unknown };

Format formatByName(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  if (extension == ".gltf" || extension == ".glb") return Format::gltf;
  return extension == ".obj" ? Format::obj : Format::unknown;
}

/// By content where it is plain (GLB magic, a JSON object), else by extension.
Format formatOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string head(64, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  const std::size_t text = head.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (head.starts_with("glTF") || (text != std::string::npos && head[text] == '{')) return Format::gltf;
  return formatByName(file);
}

Scene parse(const std::filesystem::path& file, const LoadOptions& options, LoadBudget& budget) {
  switch (formatOf(file)) {
    case Format::gltf:
      return loadGltf(file, options, budget);
    case Format::obj:
      return loadObj(file, options, budget);
    case Format::unknown:
      break;
  }
  throw Error(file.string() + ": not a scene this program reads (.gltf, .glb, .obj)");
}

}  // namespace

bool isNamedAsScene(const std::filesystem::path& file) { return formatByName(file) != Format::unknown; }

Scene loadScene(const std::filesystem::path& file, const LoadOptions& options) {
  std::error_code failed;
  if (!std::filesystem::exists(file, failed)) throw Error(file.string() + ": no such file");
  if (!std::filesystem::is_regular_file(file, failed)) throw Error(file.string() + ": not a regular file");
  if (!(options.unitScale > 0 && options.unitScale < kInfinity))
    throw UsageError("--unit-scale must be a positive number");
  if (!(options.timeSeconds >= 0 && options.timeSeconds < static_cast<double>(kInfinity)))
    throw UsageError("--time must be a number of seconds, 0 or more");
  LoadBudget budget(options.limits, file.filename().string());
  try {
    Scene scene = parse(file, options, budget);
    if (!options.environment.empty()) {
      LoadBudget own(options.limits, options.environment);
      scene.environment = std::make_shared<const Environment>(
          readEnvironment(options.environment, options.environmentOptions, own, scene.warnings));
    }
    completeScene(scene, options, &budget);
    return scene;
  } catch (const std::bad_alloc&) {
    throw Error(file.string() + ": the machine has too little memory for this scene; try --max-memory");
  }
}

}  // namespace saccade::core
