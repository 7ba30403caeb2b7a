#include "app/cli/attention_outputs.h"

#include <map>

#include "core/error.h"

namespace saccade::app {

namespace fs = std::filesystem;

namespace {

bool namesAMap(const fs::path& file) { return file.extension() == ".png" || file.extension() == ".exr"; }

void refuseDuplicates(const std::vector<std::string>& images, const std::vector<fs::path>& maps) {
  std::map<fs::path, std::string> takenBy;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const auto [other, isNew] = takenBy.emplace(maps[i], images[i]);
    if (!isNew) {
      throw core::Error(maps[i].string() + ": would be the map of " + other->second + " and of " + images[i] +
                        "; write one of them by a call of its own");
    }
  }
}

void refuseToReplaceImages(const std::vector<std::string>& images, const std::vector<fs::path>& maps) {
  for (const fs::path& map : maps) {
    for (const std::string& image : images) {
      std::error_code absent;
      if (fs::equivalent(map, image, absent))
        throw core::Error(map.string() + ": the map would replace the image; choose another name (-o)");
    }
  }
}

}  // namespace

std::vector<fs::path> attentionOutputs(const std::vector<std::string>& images, const std::string& output) {
  if (output.empty()) return {};
  const fs::path target = output;
  const bool isFolder = fs::is_directory(target);
  std::vector<fs::path> maps;
  if (namesAMap(target) && !isFolder) {
    if (images.size() > 1)
      throw core::UsageError("-o " + output + ": several images need a folder for their maps");
    const fs::path folder = fs::absolute(target).parent_path();
    if (!fs::is_directory(folder))
      throw core::Error(folder.string() + ": no such folder; make it first (-o)");
    maps.push_back(target);
  } else {
    if (target.has_extension() && images.size() == 1 && !isFolder)
      throw core::UsageError("-o " + output + ": the map's name must end in .png or .exr");
    if (fs::exists(target) && !isFolder)
      throw core::Error(output + ": a file, where a folder for the maps is wanted (-o)");
    for (const std::string& image : images)
      maps.push_back(target / (fs::path(image).stem().string() + ".png"));
  }
  refuseDuplicates(images, maps);
  refuseToReplaceImages(images, maps);
  return maps;
}

}  // namespace saccade::app
