#include "core/exr_gate.h"

#include <ImfVersion.h>

#include <cstring>

#include "core/error.h"
#include "core/image_codecs.h"

namespace saccade::core {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint64_t kMaxChannels = 64;
/// Compression codes of the format, with the lines they pack together and how far they can shrink.
enum : std::uint8_t { kNone = 0, kRle = 1, kZips = 2, kZip = 3 };
constexpr std::uint64_t kZipLines = 16, kDeflateGain = 1040, kRleGain = 64;

class HeaderWalk {
 public:
  HeaderWalk(Bytes bytes, const std::string& name) : rest_(bytes), name_(name) {}

  ExrClaims run() {
    checkKind();
    const std::size_t fileBytes = rest_.size() + 8;
    while (!rest_.empty() && rest_[0] != 0) attribute();
    if (rest_.empty()) refuse("the header is cut off");
    if (!seenChannels_ || !seenWindow_ || !seenCompression_)
      refuse("the header lacks 'channels', 'dataWindow' or 'compression'");
    codecs::checkDimensions(claims_.width, claims_.height, name_);
    checkAgainst(fileBytes);
    return claims_;
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const { throw Error(name_ + ": damaged EXR: " + why); }

  void checkKind() {
    if (rest_.size() < 8 || word(rest_, 0) != Imf::MAGIC) throw Error(name_ + ": not an OpenEXR image");
    constexpr int kKinds = Imf::TILED_FLAG | Imf::NON_IMAGE_FLAG | Imf::MULTI_PART_FILE_FLAG;
    if ((word(rest_, 4) & kKinds) != 0)
      throw Error(name_ + ": tiled, deep and multi-part EXR are not read; save flat scanlines");
    rest_ = rest_.subspan(8);
  }

  static std::int32_t word(Bytes from, std::size_t at) {
    std::uint32_t w = 0;
    for (std::size_t i = 4; i-- > 0;) w = w << 8 | from[at + i];
    return static_cast<std::int32_t>(w);
  }

  std::string string(Bytes& from) const {
    const auto* end = static_cast<const std::uint8_t*>(std::memchr(from.data(), 0, from.size()));
    if (!end) refuse("the header is cut off");
    std::string out(from.data(), end);
    from = from.subspan(out.size() + 1);
    return out;
  }

  void attribute() {
    const std::string what = string(rest_), type = string(rest_);
    if (rest_.size() < 4) refuse("the header is cut off");
    const std::int32_t size = word(rest_, 0);
    rest_ = rest_.subspan(4);
    if (size < 0 || static_cast<std::size_t>(size) > rest_.size())
      refuse("attribute '" + what + "' reaches beyond the file");
    const Bytes value = rest_.first(static_cast<std::size_t>(size));
    rest_ = rest_.subspan(value.size());
    if (what == "channels" && type == "chlist") channels(value);
    if (what == "compression" && type == "compression" && size == 1) compression(value[0]);
    if (what == "dataWindow" && type == "box2i" && size == 16) {
      seenWindow_ = true;
      claims_.width = std::int64_t{word(value, 8)} - word(value, 0) + 1;
      claims_.height = std::int64_t{word(value, 12)} - word(value, 4) + 1;
    }
  }

  void compression(std::uint8_t code) {
    seenCompression_ = true;
    if (code > kZip)
      throw Error(name_ + ": EXR compression other than NONE, RLE, ZIP is not read; save it with ZIP");
    compression_ = code;
  }

  void channels(Bytes value) {
    seenChannels_ = true;
    while (!value.empty() && value[0] != 0) {
      const std::string channel = string(value);
      if (value.size() < 16) refuse("the list of channels is cut off");
      const std::int32_t type = word(value, 0);
      if (type < 0 || type > 2) refuse("channel '" + channel + "' has an unknown pixel type");
      if (word(value, 8) != 1 || word(value, 12) != 1)
        throw Error(name_ + ": EXR channel " + channel + " is subsampled");
      claims_.bytesPerPixel += type == 1 ? 2 : 4;
      value = value.subspan(16);
      if (++channels_ > kMaxChannels)
        throw Error(name_ + ": EXR with more than " + std::to_string(kMaxChannels) + " channels is not read");
    }
  }

  void checkAgainst(std::size_t fileBytes) {
    const std::uint64_t line = static_cast<std::uint64_t>(claims_.width) * claims_.bytesPerPixel;
    const std::uint64_t gain = compression_ == kNone ? 1 : compression_ == kRle ? kRleGain : kDeflateGain;
    if (line * static_cast<std::uint64_t>(claims_.height) / gain > fileBytes)
      refuse(std::to_string(fileBytes) + " bytes cannot hold " + std::to_string(claims_.width) + " x " +
             std::to_string(claims_.height) + " pixels");
    claims_.workingBytes = line * (compression_ == kZip ? kZipLines : 1) * 4;
  }

  Bytes rest_;
  const std::string& name_;
  ExrClaims claims_;
  std::uint64_t channels_ = 0;  // of all lists: OpenEXR joins them
  std::uint8_t compression_ = kNone;
  bool seenChannels_ = false, seenWindow_ = false, seenCompression_ = false;
};

}  // namespace

ExrClaims checkExrHeader(Bytes bytes, const std::string& name) { return HeaderWalk(bytes, name).run(); }

}  // namespace saccade::core
