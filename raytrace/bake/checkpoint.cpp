#include "raytrace/bake/checkpoint.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "core/atomic_file.h"
#include "core/byte_reader.h"
#include "core/hashed_file.h"

namespace saccade::raytrace {
namespace {

constexpr std::array<char, 8> kMagic = {'S', 'A', 'C', 'B', 'A', 'K', 'E', '\n'};
/// Also to be raised when a stage's results come to mean something else.
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kByteOrder = 0x01020304;
/// Results are looked at in words of so many bytes; fewer zeros in a row than kShortestRun are kept as they
/// are.
constexpr std::size_t kWord = 4, kShortestRun = 8;

using Bytes = std::span<const std::uint8_t>;

Bytes bytesOf(std::span<const std::byte> values) {
  return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size()};
}

bool isZero(Bytes results, std::size_t word) {
  std::uint32_t value;
  std::memcpy(&value, results.data() + word * kWord, kWord);
  return value == 0;
}

/// (zero words, other words, those words) until the end. The size is a multiple of a word.
void writeResults(core::HashedFile& out, Bytes results) {
  const std::size_t words = results.size() / kWord;
  for (std::size_t at = 0; at < words;) {
    std::size_t first = at;
    while (first < words && isZero(results, first)) ++first;
    std::size_t last = first, zeros = 0;  // [first, last) are kept; `zeros` follow on that
    for (std::size_t i = first; i < words && zeros < kShortestRun; ++i) {
      zeros = isZero(results, i) ? zeros + 1 : 0;
      if (zeros == 0) last = i + 1;
    }
    out.number<std::uint64_t>(first - at);
    out.number<std::uint64_t>(last - first);
    out.raw(results.subspan(first * kWord, (last - first) * kWord));
    at = last;
  }
}

std::vector<std::uint8_t> readResults(core::ByteReader& in, std::size_t size) {
  std::vector<std::uint8_t> results(size);
  std::size_t left = size / kWord;
  while (left > 0) {
    const auto zeros = in.number<std::uint64_t>(), words = in.number<std::uint64_t>();
    if (zeros > left || words > left - zeros || zeros + words == 0)
      in.refuse("holds another number of results than its bake has");
    const Bytes kept = in.bytes(words * kWord);
    std::copy(kept.begin(), kept.end(), results.end() - static_cast<std::ptrdiff_t>((left - zeros) * kWord));
    left -= zeros + words;
  }
  return results;
}

struct StageState {
  std::uint64_t done = 0;
  double seconds = 0;
  std::vector<std::uint8_t> results;
};

StageState readStage(core::ByteReader& in, const BakeStage& stage) {
  const std::vector<char> name = in.array<char>();
  const auto units = in.number<std::uint64_t>();
  StageState state;
  state.done = in.number<std::uint64_t>();
  state.seconds = in.number<double>();
  const bool same = std::equal(name.begin(), name.end(), stage.name.begin(), stage.name.end()) &&
                    units == stage.units && state.done <= units;
  if (!same) in.refuse("belongs to a bake of other stages");
  state.results = readResults(in, stage.results.size());
  return state;
}

void checkHeader(core::ByteReader& in, std::uint64_t sceneKey, BakeJob& job) {
  if (in.number<std::array<char, 8>>() != kMagic) in.refuse("is none (wrong first bytes)");
  const auto version = in.number<std::uint32_t>();
  if (in.number<std::uint32_t>() != kByteOrder) in.refuse("was written on a machine of another byte order");
  if (version != kVersion) in.refuse("was written by another version of the baker");
  if (in.number<std::uint64_t>() != sceneKey) in.refuse("belongs to another scene or another state of it");
  if (in.number<std::uint64_t>() != job.settingsHash())
    in.refuse("belongs to other settings (quality, photons, seed or charts)");
  if (in.number<std::uint64_t>() != job.stages().size()) in.refuse("belongs to a bake of other stages");
}

}  // namespace

void writeCheckpoint(const std::filesystem::path& file, std::uint64_t sceneKey, BakeJob& job) {
  core::HashedFile out(file);
  out.raw({reinterpret_cast<const std::uint8_t*>(kMagic.data()), kMagic.size()});
  out.number(kVersion);
  out.number(kByteOrder);
  out.number(sceneKey);
  out.number(job.settingsHash());
  out.number<std::uint64_t>(job.stages().size());
  for (const BakeStage& stage : job.stages()) {
    out.number<std::uint64_t>(stage.name.size());
    out.raw({reinterpret_cast<const std::uint8_t*>(stage.name.data()), stage.name.size()});
    out.number(stage.units);
    out.number(stage.done);
    out.number(stage.seconds);
    writeResults(out, bytesOf(stage.results));
  }
  out.commit();
}

void readCheckpoint(const std::filesystem::path& file, std::uint64_t sceneKey, BakeJob& job,
                    const std::string& advice) {
  const std::vector<std::uint8_t> bytes = core::readWholeFile(file);
  std::uint64_t stated = 0;
  const std::size_t body = bytes.size() < sizeof stated ? 0 : bytes.size() - sizeof stated;
  const Bytes content(bytes.data(), body);
  core::ByteReader in(content, file.string(), "checkpoint", advice);
  checkHeader(in, sceneKey, job);
  std::memcpy(&stated, bytes.data() + body, sizeof stated);
  if (stated != core::HashedFile::hashOf(content)) in.refuse("is damaged or cut off (checksum)");
  std::vector<StageState> states;
  for (const BakeStage& stage : job.stages()) states.push_back(readStage(in, stage));
  if (!in.atEnd()) in.refuse("has bytes after its end");
  for (std::size_t i = 0; i < states.size(); ++i) {
    BakeStage& stage = job.stages()[i];
    stage.done = states[i].done;
    stage.seconds = states[i].seconds;
    std::memcpy(stage.results.data(), states[i].results.data(), states[i].results.size());
  }
}

}  // namespace saccade::raytrace
