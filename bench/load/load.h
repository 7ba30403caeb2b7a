// From file to first frame: seconds and bytes by stage, beside the bare parse of the same file.
#pragma once

#include "bench/harness/child.h"
#include "bench/harness/experiment.h"

namespace saccade::bench {

/// One record a scene, "load/SCENE". Every measurement runs in a process of its own; maps (preview) are baked
/// before anything is measured, and read from the cache.
void measureLoad(Session& session);

/// Child job. FILE IMAGES: tinygltf's or tinyobjloader's bare parse (bench/load/bare_parse.h), images decoded
/// where IMAGES is "images". Figures: seconds, bytes (peak beyond the empty program).
Figures parseFile(const Arguments& arguments, const std::stop_token& stop);

/// Child job. FILE UNIT_SCALE: what stands between the file and the first base frame of 512 x 512. Figures:
/// seconds by stage (load, maps, world, upload, frame) and in all (total); load_bytes and bytes, peaks beyond
/// the empty program; triangles.
Figures loadAndDraw(const Arguments& arguments, const std::stop_token& stop);

}  // namespace saccade::bench
