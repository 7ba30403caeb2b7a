// The file of kept samples: what `walk --keep-cache` leaves for the next visit.
//
// Little-endian, nothing between the fields. All integers are unsigned unless a line says otherwise.
//   magic "SACSAMPL", version u32, bytes of a sample u32
//   origin: scene u64, maps u64, settings u64, program u64, machine u64 (SampleOrigin)
//   end: eye 3 f32, at 3 f32, up 3 f32, field of view f32 (degrees), width i32, height i32, aging u64, mask
//   u64 number of ages u64 per age, oldest first, the camera's own last: age u64, pixels a radian f32,
//   samples u64, and each of them:
//     x u16, y u16, id u32, level u8, thread u8, from depth u8 (0 or 1), 0 u8,
//     correction 3 f32, position 3 f32, normal 3 f32, <n, v> f32, view depth f32,
//     direction to the eye 3 f32, rate of change f32
//   hash u64 of all before it (core::ContentHash, in pieces of 1 MiB)
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "app/session/visit_end.h"
#include "core/load_budget.h"
#include "render/splat/sample_cache.h"

namespace saccade::app {

/// To be raised with every change of the file or of what its numbers mean.
inline constexpr std::uint32_t kKeptVersion = 2;

/// Hashes of what a sample depends on beside its frame.
struct SampleOrigin {
  std::uint64_t scene = 0;     ///< core::sceneKey
  std::uint64_t maps = 0;      ///< their content
  std::uint64_t settings = 0;  ///< sub-samples a pixel and seed
  std::uint64_t program = 0;   ///< the executable
  std::uint64_t machine = 0;   ///< processor and libraries: they may round otherwise
};

struct KeptVisit {
  SampleOrigin origin;
  VisitEnd end;
};

/// A file that was read whole and is not damaged.
class KeptFile {
 public:
  /// Throws core::Error where it is damaged, cut off, or of another version or kind.
  KeptFile(const std::filesystem::path& file, const core::LoadLimits& limits);

  const KeptVisit& visit() const { return visit_; }
  /// Fills an empty cache that was never aged, up to its bound. Throws core::Error, with the cache empty,
  /// where the file holds samples that no walk makes; ids must be at most `idCount`.
  void samples(std::uint32_t idCount, render::SampleCache& cache) const;

 private:
  std::filesystem::path file_;
  std::vector<std::uint8_t> bytes_;
  KeptVisit visit_;
  std::size_t samplesAt_ = 0;  ///< where the ages begin in bytes_
};

/// At most `maxBytes`: of what does not fit, the oldest samples are left out. Old file or new one, never a
/// mixture. Returns how many samples were written. Throws core::Error.
std::size_t writeKept(const std::filesystem::path& file, const KeptVisit& visit,
                      const render::SampleCache& cache, std::size_t maxBytes);

}  // namespace saccade::app
