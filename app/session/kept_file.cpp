#include "app/session/kept_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>
#include <vector>

#include "core/atomic_file.h"
#include "core/byte_reader.h"
#include "core/hashed_file.h"

namespace saccade::app {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

constexpr std::array<char, 8> kMagic = {'S', 'A', 'C', 'S', 'A', 'M', 'P', 'L'};
/// Camera changes that no walk reaches.
constexpr std::uint64_t kMostAges = std::uint64_t{1} << 48;
/// Largest image side.
constexpr int kMostPixels = 16384;
constexpr const char* kAdvice = "it will be written anew";

using Bytes = std::span<const std::uint8_t>;

struct Writer {
  core::HashedFile file;
  template <class T>
  void operator()(const T& value) {
    file.number(value);
  }
};

/// Counts what a Writer would write.
struct Counter {
  template <class T>
  void operator()(const T&) {
    bytes += sizeof(T);
  }
  std::size_t bytes = 0;
};

/// Fills what it is given.
struct Reader {
  core::ByteReader& in;
  template <class T>
  void operator()(T& value) const {
    value = in.number<T>();
  }
};

// Each of the following reads or writes by `field`, in the order of the file.

template <class Field, class Vector>
void vectorField(Field&& field, Vector& v) {
  for (int c = 0; c < 3; ++c) field(v[c]);
}

template <class Field, class Visit>
void headFields(Field&& field, Visit& visit) {
  auto& o = visit.origin;
  for (auto* hash : {&o.scene, &o.maps, &o.settings, &o.program, &o.machine}) field(*hash);
  auto& e = visit.end;
  for (auto* v : {&e.camera.eye, &e.camera.at, &e.camera.up}) vectorField(field, *v);
  field(e.camera.fovYDegrees);
  field(e.size.width);
  field(e.size.height);
  field(e.aging);
  field(e.mask);
}

/// A sample's fields that lie in the file as they do in memory.
template <class Field, class Sample>
void sampleFields(Field&& field, Sample& s) {
  for (auto* v : {&s.correction, &s.position, &s.normal}) vectorField(field, *v);
  field(s.cosView);
  field(s.viewDepth);
  vectorField(field, s.toEye);
  field(s.changeRate);
}

template <class Out>
void writeSample(Out& out, const core::Sample& s) {
  out(static_cast<std::uint16_t>(s.x));
  out(static_cast<std::uint16_t>(s.y));
  out(s.id);
  out(s.level);
  out(s.thread);
  out(static_cast<std::uint8_t>(s.fromDepth));
  out(std::uint8_t{0});
  sampleFields(out, s);
}

core::Sample readSample(core::ByteReader& in) {
  core::Sample s;
  s.x = in.number<std::uint16_t>();
  s.y = in.number<std::uint16_t>();
  s.id = in.number<std::uint32_t>();
  s.level = in.number<std::uint8_t>();
  s.thread = in.number<std::uint8_t>();
  s.fromDepth = in.number<std::uint8_t>() != 0;
  in.number<std::uint8_t>();
  sampleFields(Reader{in}, s);
  return s;
}

std::size_t sampleBytes() {
  Counter counter;
  writeSample(counter, {});
  return counter.bytes;
}

/// Of everything but the samples.
std::size_t otherBytes(std::size_t ages) {
  Counter counter;
  const KeptVisit visit;
  headFields(counter, visit);
  constexpr std::size_t kAge = 8 + 4 + 8;
  return kMagic.size() + 4 + 4 + counter.bytes + 8 + ages * kAge + 8;
}

bool plausible(const core::Sample& s, std::uint32_t idCount) {
  return core::isFinite(s) && s.id >= 1 && s.id <= idCount && s.level >= 1 &&
         s.level <= core::Lattice::kMaxLevel;
}

core::ByteReader readerOf(Bytes bytes, const std::filesystem::path& file) {
  return {bytes, file.string(), "file of kept samples", kAdvice};
}

KeptVisit readHead(core::ByteReader& in) {
  const auto version = in.number<std::uint32_t>();
  const auto size = in.number<std::uint32_t>();
  if (version != kKeptVersion || size != sampleBytes())
    in.refuse("was written by another version of saccade");
  KeptVisit visit;
  headFields(Reader{in}, visit);
  const ImageSize& image = visit.end.size;
  if (image.width < 1 || image.height < 1 || image.width > kMostPixels || image.height > kMostPixels)
    in.refuse("holds an image size that no walk has");
  return visit;
}

/// One age's samples into the cache; the age.
std::uint64_t readAge(core::ByteReader& in, std::uint64_t before, std::uint32_t idCount,
                      render::SampleCache& cache) {
  const auto age = in.number<std::uint64_t>();
  const auto pixelsPerRadian = in.number<float>();
  const auto samples = in.number<std::uint64_t>();
  if (age <= before || age > kMostAges || !(pixelsPerRadian > 0) || !std::isfinite(pixelsPerRadian))
    in.refuse("holds ages that no walk has");
  core::SampleBatch batch;
  for (std::uint64_t i = 0; i < samples; ++i) {
    batch.samples.push_back(readSample(in));
    if (!plausible(batch.samples.back(), idCount)) in.refuse("holds samples that no walk makes");
  }
  cache.restore(batch, age, pixelsPerRadian);
  return age;
}

}  // namespace

KeptFile::KeptFile(const std::filesystem::path& file, const core::LoadLimits& limits) : file_(file) {
  core::LoadBudget budget(limits, file.string());
  bytes_ = core::readWholeFile(file, budget);
  core::ByteReader in = readerOf(bytes_, file_);
  if (in.number<std::array<char, 8>>() != kMagic) in.refuse("is none (wrong first bytes)");
  std::uint64_t sum = 0;
  if (bytes_.size() < kMagic.size() + sizeof sum) in.refuse("is cut off");
  const std::size_t content = bytes_.size() - sizeof sum;
  std::memcpy(&sum, bytes_.data() + content, sizeof sum);
  bytes_.resize(content);
  if (core::HashedFile::hashOf(bytes_) != sum) in.refuse("is damaged or cut off");
  in = readerOf(Bytes(bytes_).subspan(kMagic.size()), file_);
  visit_ = readHead(in);
  samplesAt_ = otherBytes(0) - sizeof(std::uint64_t) - sizeof sum;
}

void KeptFile::samples(std::uint32_t idCount, render::SampleCache& cache) const {
  core::ByteReader in = readerOf(Bytes(bytes_).subspan(samplesAt_), file_);
  try {
    std::uint64_t age = 0;
    for (auto ages = in.number<std::uint64_t>(); ages > 0; --ages) age = readAge(in, age, idCount, cache);
    if (age == 0 || !in.atEnd()) in.refuse("holds another number of samples than it says");
  } catch (...) {
    cache.clear();
    throw;
  }
}

std::size_t writeKept(const std::filesystem::path& file, const KeptVisit& visit,
                      const render::SampleCache& cache, std::size_t maxBytes) {
  struct Age {
    std::uint64_t age;
    float pixelsPerRadian;
    std::size_t samples;
  };
  std::vector<Age> ages;
  cache.forEachAge([&](std::uint64_t age, float ppr, std::size_t n) { ages.push_back({age, ppr, n}); });
  const std::size_t other = otherBytes(ages.size());
  const std::size_t room = maxBytes > other ? (maxBytes - other) / sampleBytes() : 0;
  std::size_t leftOut = cache.size() - std::min(cache.size(), room);
  const std::size_t written = cache.size() - leftOut;

  Writer out{core::HashedFile(file)};
  out(kMagic);
  out(kKeptVersion);
  out(static_cast<std::uint32_t>(sampleBytes()));
  headFields(out, visit);
  out(static_cast<std::uint64_t>(ages.size()));
  const auto begin = [&](const Age& a) {
    out(a.age);
    out(a.pixelsPerRadian);
    out(static_cast<std::uint64_t>(a.samples - std::min(a.samples, leftOut)));
  };
  std::size_t next = 0, left = 0;  // index into ages; samples left of the one before
  cache.forEach([&](const core::Sample& s, std::uint64_t) {
    while (left == 0) {
      begin(ages[next]);
      left = ages[next++].samples;
    }
    --left;
    if (leftOut > 0) {
      --leftOut;
    } else {
      writeSample(out, s);
    }
  });
  for (; next < ages.size(); ++next) begin(ages[next]);
  out.file.commit();
  return written;
}

}  // namespace saccade::app
