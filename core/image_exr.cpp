// OpenEXR. Only what its simple decoders read: flat scanlines, NONE, RLE or ZIP.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/exr_gate.h"
#include "core/image_codecs.h"
#include "core/image_io.h"

namespace saccade::core {
namespace {

namespace fs = std::filesystem;

class MemoryStream : public Imf::OStream {
 public:
  explicit MemoryStream(const std::string& name) : Imf::OStream(name.c_str()) {}
  void write(const char bytes[], int count) override {
    const std::size_t end = position_ + static_cast<std::size_t>(count);
    if (bytes_.size() < end) bytes_.resize(end);
    std::memcpy(bytes_.data() + position_, bytes, static_cast<std::size_t>(count));
    position_ = end;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }
  std::span<const std::uint8_t> bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
  std::size_t position_ = 0;
};

/// A whole file in memory.
class MemoryInput : public Imf::IStream {
 public:
  MemoryInput(const std::string& name, std::span<const std::uint8_t> bytes)
      : Imf::IStream(name.c_str()), bytes_(bytes) {}
  bool read(char to[], int count) override {
    const auto wanted = static_cast<std::size_t>(count);
    if (count < 0 || position_ > bytes_.size() || wanted > bytes_.size() - position_)
      throw Error("the file ends too early");
    std::memcpy(to, bytes_.data() + position_, wanted);
    position_ += wanted;
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::uint64_t position_ = 0;
};

/// Names of the channels that become R, G and B.
std::array<std::string, 3> pickChannels(const Imf::ChannelList& channels, const std::string& name) {
  std::vector<std::string> names;
  for (auto c = channels.begin(); c != channels.end(); ++c) names.emplace_back(c.name());
  if (names.size() == 1) return {names[0], names[0], names[0]};
  if (channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B"))
    return {"R", "G", "B"};
  for (const std::string& red : names) {
    const std::string layer = red.ends_with(".R") ? red.substr(0, red.size() - 1) : "";
    if (!layer.empty() && channels.findChannel(layer + "G") && channels.findChannel(layer + "B"))
      return {red, layer + "G", layer + "B"};
  }
  throw Error(name + ": EXR needs channels R, G, B, a layer of them or exactly one channel");
}

ImageRgb readPixels(Imf::InputFile& in, const std::string& name, LoadBudget& budget) {
  const Imath::Box2i window = in.header().dataWindow();
  const auto names = pickChannels(in.header().channels(), name);
  ImageRgb image(window.max.x - window.min.x + 1, window.max.y - window.min.y + 1);
  const bool grey = names[0] == names[1];
  Imf::FrameBuffer buffer;
  for (int c = 0; c < (grey ? 1 : 3); ++c) {
    // Slice::Make places the first pixel of the data window at the pointer.
    buffer.insert(names[c], Imf::Slice::Make(Imf::FLOAT, &image.pixels()[0][c], window, sizeof(Vec3),
                                             sizeof(Vec3) * static_cast<std::size_t>(image.width())));
  }
  in.setFrameBuffer(buffer);
  for (int row = 0; row < image.height(); row += codecs::kRowsPerLook) {
    budget.checkTime();
    const int rows = std::min(codecs::kRowsPerLook, image.height() - row);
    in.readPixels(window.min.y + row, window.min.y + row + rows - 1);
  }
  if (grey) {
    for (Vec3& p : image.pixels()) p = Vec3(p.x);
  }
  return image;
}

struct ExrChannel {
  std::string name;
  const float* first;
  std::size_t stride;  ///< bytes from pixel to pixel
};

void writeChannels(const fs::path& file, int width, int height, const std::vector<ExrChannel>& channels) {
  MemoryStream stream(file.string());
  try {
    Imf::Header header(width, height);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer buffer;
    for (const ExrChannel& c : channels) {
      header.channels().insert(c.name, Imf::Channel(Imf::FLOAT));
      // OpenEXR's slices are not const, but writing leaves them alone.
      auto* base = const_cast<char*>(reinterpret_cast<const char*>(c.first));
      buffer.insert(c.name,
                    Imf::Slice(Imf::FLOAT, base, c.stride, c.stride * static_cast<std::size_t>(width)));
    }
    Imf::OutputFile out(stream, header);
    out.setFrameBuffer(buffer);
    out.writePixels(height);
  } catch (const std::exception& e) {
    throw Error(file.string() + ": cannot be encoded as EXR: " + e.what());
  }
  // Only now: OpenEXR completes its table of offsets when the OutputFile is destroyed.
  writeFileAtomically(file, stream.bytes());
}

}  // namespace

ImageRgb readExr(const fs::path& file) {
  LoadBudget budget(LoadLimits{}, file.string());
  return readExr(file, budget);
}

ImageRgb readExr(const fs::path& file, LoadBudget& budget) {
  const std::string name = file.string();
  const std::vector<std::uint8_t> bytes = readWholeFile(file, budget);
  const ExrClaims claims = checkExrHeader(bytes, name);
  budget.charge(static_cast<std::uint64_t>(claims.width * claims.height), sizeof(Vec3), name);
  budget.charge(claims.workingBytes, name);
  try {
    MemoryInput stream(name, bytes);
    Imf::InputFile in(stream, 0);
    ImageRgb image = readPixels(in, name, budget);
    budget.release(claims.workingBytes + bytes.size());
    return image;
  } catch (const Error& e) {
    throw Error(std::string(e.what()).starts_with(name) ? e.what() : name + ": damaged EXR: " + e.what());
  } catch (const std::exception& e) {
    throw Error(name + ": damaged EXR: " + e.what());
  }
}

void writeExr(const fs::path& file, const ImageRgb& image) {
  codecs::checkDimensions(image.width(), image.height(), file.string());
  const float* first = &image.pixels()[0].x;
  writeChannels(file, image.width(), image.height(),
                {{"R", first, sizeof(Vec3)}, {"G", first + 1, sizeof(Vec3)}, {"B", first + 2, sizeof(Vec3)}});
}

void writeExrChannels(const fs::path& file,
                      const std::vector<std::pair<std::string, const ImageGray*>>& channels) {
  assert(!channels.empty());
  const ImageGray& first = *channels.front().second;
  codecs::checkDimensions(first.width(), first.height(), file.string());
  std::vector<ExrChannel> list;
  for (const auto& [name, image] : channels) {
    assert(image->width() == first.width() && image->height() == first.height());
    list.push_back({name, image->pixels().data(), sizeof(float)});
  }
  writeChannels(file, first.width(), first.height(), list);
}

}  // namespace saccade::core
