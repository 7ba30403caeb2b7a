// The note that earlier_maps.h keeps, as a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "raytrace/bake/kept_charts.h"

namespace saccade::app {

struct MapsNote {
  std::string maps;         ///< the map file
  std::uint64_t key = 0;    ///< core::sceneKey
  std::uint64_t light = 0;  ///< core::contentHash of the maps: the file may have been written anew since
  raytrace::EarlierScene scene;
};

/// Throw core::Error. What was read is whole (a checksum) and its indices are within their arrays.
MapsNote readNote(const std::filesystem::path& file);
void writeNote(const std::filesystem::path& file, const MapsNote& note);

}  // namespace saccade::app
