// What a bake has found so far, in a file: so that it can be stopped and go on later, on any threads, to the
// same bits.
//
// The file: magic, version, byte order mark, scene key, settings, number of stages; per stage its name,
// units, units done, seconds and results; a checksum of all that. Results are runs of zeros (counted) and of
// other words (as they are): texels without surface and those not yet reached cost nothing. For each texel
// with surface and layer that leaves up to 100 bytes: open area 4, direct light 16, gathered light 16 (not at
// preview), indirect particles 32, caustic ones 32 more (where anything but Lambert reflects). An atlas of
// 1024 x 1024 so takes at most 105 MB a layer, 72 MB without caustics; 16 times that at 4096 x 4096. Edges of
// light add 16 bytes a texel, and 28 bytes a cell and layer: 35 MB a layer at medium, 170 MB at high, at
// most.
#pragma once

#include <cstdint>
#include <filesystem>

#include "raytrace/bake/baker.h"

namespace saccade::raytrace {

/// Old file or new one, never a mixture. `sceneKey` is core::sceneKey of the scene. Throws core::Error.
void writeCheckpoint(const std::filesystem::path& file, std::uint64_t sceneKey, BakeJob& job);

/// Takes over what the file holds; the job must not have begun. Throws core::Error, with the job as it was,
/// when the file is damaged or belongs to another scene, other settings or another version of the baker; its
/// one line ends with `advice`.
void readCheckpoint(const std::filesystem::path& file, std::uint64_t sceneKey, BakeJob& job,
                    const std::string& advice);

}  // namespace saccade::raytrace
