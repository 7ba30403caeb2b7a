#include "app/session/overlays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_set>

#include "core/error.h"
#include "core/metrics/colormap.h"

namespace saccade::app {

const std::vector<std::string>& aovNames() {
  static const std::vector<std::string> names{"id",       "saliency",  "level",      "thread", "age",
                                              "validity", "footprint", "importance", "rank"};
  return names;
}

std::string aovList() {
  std::string list;
  for (const std::string& name : aovNames()) list += (list.empty() ? "" : ", ") + name;
  return list;
}

Aov aovByName(const std::string& name) {
  const auto& names = aovNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<Aov>(found - names.begin());
  throw core::UsageError("no overlay '" + name + "'; there are: " + aovList());
}

namespace {

using Splat = render::CorrectionLayer::Splat;

core::ImageGray saliencyValues(const FrameLoop& loop) {
  const auto analysis = loop.analyzer().latest();
  const core::FrameSnapshot& frame = loop.frame();
  // The analyzer may not have seen a frame of this size yet.
  if (!analysis || analysis->saliency.width() != frame.view.width() ||
      analysis->saliency.height() != frame.view.height()) {
    return {frame.view.width(), frame.view.height()};
  }
  return analysis->saliency;
}

/// Cached samples that would fail the aging test if they were judged alone.
class StaleSamples {
 public:
  explicit StaleSamples(const FrameLoop& loop) {
    const core::FrameSnapshot& frame = loop.frame();
    const PictureSettings& settings = loop.settings();
    const core::Vec3& eye = frame.view.camera().eye;
    loop.cache().forEach([&](const core::Sample& s, std::uint64_t age) {
      if (age >= frame.epoch) return;
      if (!(render::agedChange(settings.aging, s, eye) <= settings.delta))
        keys_.insert(key(frame.epoch - age, s.x, s.y));
    });
  }
  bool contains(const Splat& s) const { return keys_.count(key(s.ageFrames, s.x, s.y)) > 0; }

 private:
  /// A pixel is traced once for a camera.
  static std::uint64_t key(std::uint64_t ageFrames, std::int32_t x, std::int32_t y) {
    return ageFrames << 32 | static_cast<std::uint64_t>(y) << 16 | static_cast<std::uint64_t>(x);
  }
  std::unordered_set<std::uint64_t> keys_;
};

template <class ValueAt>
core::ImageGray valuesBy(const core::FrameSnapshot& frame, ValueAt&& valueAt) {
  core::ImageGray values(frame.view.width(), frame.view.height());
  for (int y = 0; y < values.height(); ++y) {
    for (int x = 0; x < values.width(); ++x) values.at(x, y) = valueAt(x, y);
  }
  return values;
}

/// of(splat) where a sample is shown, else `none`.
template <class Of>
core::ImageGray splatValues(const FrameLoop& loop, float none, Of&& of) {
  return valuesBy(loop.frame(), [&](int x, int y) {
    const Splat* splat = loop.layer().shownAt(x, y);
    return splat ? of(*splat) : none;
  });
}

core::ImageGray validityValues(const FrameLoop& loop) {
  const StaleSamples stale(loop);
  const auto validity = [&](int x, int y) {
    const Splat* splat = loop.layer().shownAt(x, y);
    if (!splat) return Validity::none;
    if (loop.layer().isExact(x, y)) return Validity::exact;
    if (splat->ageFrames == 0) return Validity::coarse;
    return stale.contains(*splat) ? Validity::stale : Validity::valid;
  };
  return valuesBy(loop.frame(), [&](int x, int y) { return static_cast<float>(validity(x, y)); });
}

core::ImageGray byObject(const core::FrameSnapshot& frame, const std::vector<float>& byId) {
  return valuesBy(frame, [&](int x, int y) {
    const std::uint32_t id = frame.idAt(x, y);
    return id > 0 && id < byId.size() ? byId[id] : 0;
  });
}

core::ImageGray importanceValues(const FrameLoop& loop) {
  const auto analysis = loop.analyzer().latest();
  return byObject(loop.frame(), analysis ? analysis->importance.priority : std::vector<float>{});
}

core::ImageGray values(Aov aov, const FrameLoop& loop) {
  switch (aov) {
    case Aov::id:
      return valuesBy(loop.frame(),
                      [&](int x, int y) { return static_cast<float>(loop.frame().idAt(x, y)); });
    case Aov::saliency:
      return saliencyValues(loop);
    case Aov::level:
      return splatValues(loop, 0, [](const Splat& s) { return static_cast<float>(s.level); });
    case Aov::thread:
      return splatValues(loop, 0, [](const Splat& s) { return static_cast<float>(s.thread + 1); });
    case Aov::age:
      return splatValues(loop, -1, [](const Splat& s) { return static_cast<float>(s.ageFrames); });
    case Aov::validity:
      return validityValues(loop);
    case Aov::footprint:
      return splatValues(loop, 0, [](const Splat& s) { return static_cast<float>(s.footprint); });
    case Aov::importance:
      return importanceValues(loop);
    case Aov::rank: {
      const std::vector<std::uint32_t> ranks = loop.ranks();
      return byObject(loop.frame(), {ranks.begin(), ranks.end()});
    }
  }
  return {};
}

std::vector<std::uint8_t> splatEdges(const render::CorrectionLayer& layer) {
  const int width = layer.width(), height = layer.height();
  std::vector<std::uint8_t> edges;
  edges.reserve(static_cast<std::size_t>(width) * height);
  // Each pixel is looked up once; the last column and row have no neighbour but themselves.
  std::vector<const Splat*> row, below(static_cast<std::size_t>(width) + 1);
  const auto look = [&](int y) {
    for (int x = 0; x < width; ++x) below[static_cast<std::size_t>(x)] = layer.shownAt(x, y);
    below.back() = width > 0 ? below[static_cast<std::size_t>(width) - 1] : nullptr;
  };
  if (height > 0) look(0);
  for (int y = 0; y < height; ++y) {
    row = below;
    if (y + 1 < height) look(y + 1);
    for (std::size_t x = 0; x + 1 < row.size(); ++x)
      edges.push_back(row[x] != nullptr && (row[x + 1] != row[x] || below[x] != row[x]));
  }
  return edges;
}

struct ValidityLook {
  core::Rgba8 color;
  const char* label;
};
constexpr std::array<ValidityLook, 5> kValidity{{{{0, 0, 0, 255}, "no sample"},
                                                 {{70, 190, 90, 255}, "exact: traced for this pixel"},
                                                 {{70, 140, 255, 255}, "coarse: traced beside it"},
                                                 {{255, 205, 70, 255}, "older camera, within delta"},
                                                 {{225, 60, 50, 255}, "older camera, beyond delta"}}};

std::string number(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", static_cast<double>(value));
  return text;
}

const char* meaningOf(Aov aov) {
  switch (aov) {
    case Aov::id:
      return "Non-diffuse objects: what is corrected";
    case Aov::saliency:
      return "Saliency: where the eye is drawn";
    case Aov::level:
      return "Lattice level of the sample shown";
    case Aov::thread:
      return "Tracer that made the sample shown";
    case Aov::age:
      return "Camera changes since the sample was traced";
    case Aov::validity:
      return "What the sample shown is worth";
    case Aov::footprint:
      return "Side of the sample's splat; lines part the splats";
    case Aov::importance:
      return "Importance: saliency and task as the slider mixes them";
    case Aov::rank:
      return "Place in the queue";
  }
  return "";
}

std::string labelOf(Aov aov, std::uint32_t value, const core::Scene& scene) {
  if (aov == Aov::validity) return kValidity[value].label;
  if (aov == Aov::thread) return "tracer " + std::to_string(value);
  if (aov == Aov::level)
    return "level " + std::to_string(value) + ": one pixel in " +
           std::to_string(core::Lattice::step(static_cast<int>(value)));
  const auto object = std::find_if(scene.objects.begin(), scene.objects.end(),
                                   [&](const core::Object& o) { return o.id == value; });
  const std::string name = object == scene.objects.end() ? "" : object->name;
  return std::to_string(value) + (name.empty() ? "" : " " + name);
}

/// Categories that are always explained, 1 to this, so that a legend does not change its length; 0: those
/// that occur.
std::uint32_t fixedCategories(Aov aov) {
  if (aov == Aov::validity) return static_cast<std::uint32_t>(kValidity.size()) - 1;
  return aov == Aov::level ? core::Lattice::kMaxLevel : 0;
}

/// Pixels by value, [0] left out.
std::vector<std::uint32_t> countsOf(const core::ImageGray& values) {
  std::vector<std::uint32_t> counts(1);
  for (const float value : values.pixels()) {
    const auto index = static_cast<std::size_t>(std::max(value, 0.0f));
    if (index >= counts.size()) counts.resize(index + 1);
    ++counts[index];
  }
  counts[0] = 0;
  return counts;
}

/// Whole numbers: all but saliency and importance.
bool isCounted(Aov aov) { return aov != Aov::saliency && aov != Aov::importance; }

/// scale.color of every value, looked up: of whole numbers there are few, and of a ramp a screen shows fewer
/// colours than kRampColors.
void paint(const core::ImageGray& values, const AovScale& scale, core::ImageRgba8& picture) {
  constexpr int kRampColors = 1024;
  const auto& from = values.pixels();
  if (from.empty()) return;
  const auto [least, most] = std::minmax_element(from.begin(), from.end());
  const float first = *least, span = *most - first;
  const float each = isCounted(scale.aov()) || span == 0 ? 1 : span / (kRampColors - 1);
  std::vector<core::Rgba8> colors;
  for (int i = 0; i <= std::lround(span / each); ++i)
    colors.push_back(scale.color(first + each * static_cast<float>(i)));
  const float perValue = 1 / each;
  std::transform(from.begin(), from.end(), picture.pixels().begin(), [&](float value) {
    return colors[static_cast<std::size_t>((value - first) * perValue + 0.5f)];
  });
}

}  // namespace

AovImage aovImage(Aov aov, const FrameLoop& loop) {
  AovImage image{values(aov, loop), {}};
  if (aov == Aov::footprint) image.edges = splatEdges(loop.layer());
  return image;
}

AovScale::AovScale(Aov aov, const core::ImageGray& values, int maxAge) : aov_(aov) {
  const auto largest = [&] {
    const auto found = std::max_element(values.pixels().begin(), values.pixels().end());
    return found == values.pixels().end() ? 0.0f : *found;
  };
  constexpr float kLeast = 1e-12f;
  if (aov == Aov::saliency) ramp_ = {0, 1, "0", "1", false, 0, 1, 0};
  if (aov == Aov::age) {
    const float oldest = static_cast<float>(std::max(1, maxAge));
    ramp_ = {oldest, 0, number(oldest), "0: this camera"};
  }
  if (aov == Aov::footprint) {
    const auto side = static_cast<float>(render::CorrectionLayer::kMaxFootprint);
    ramp_ = {side, 1, number(side) + " px", "1 px", true, kVisible, 1, kLeast};
  }
  if (aov == Aov::importance) {
    const float high = std::max(1.0f, largest());
    ramp_ = {0, high, "0", number(high), false, kVisible, 1, kLeast};
  }
  if (aov == Aov::rank) {
    const float last = std::max(2.0f, largest());
    ramp_ = {last, 1, number(last), "1: next", false, kVisible, 1, 1};
  }
}

core::Rgba8 AovScale::color(float value) const {
  if (aov_ == Aov::validity) return kValidity[static_cast<std::size_t>(value)].color;
  if (!ramp_) return value <= 0 ? core::Rgba8{} : core::paletteColor(static_cast<std::uint32_t>(value));
  if (!(value >= ramp_->leastValue)) return {};
  const auto scaled = [this](float v) { return ramp_->logarithmic ? std::log(v) : v; };
  const float low = scaled(ramp_->low), place = (scaled(value) - low) / (scaled(ramp_->high) - low);
  const float inside = std::clamp(place, 0.0f, 1.0f);
  return core::rampColor(ramp_->firstColor + (ramp_->lastColor - ramp_->firstColor) * inside);
}

core::ImageRgba8 aovPicture(const AovImage& image, const AovScale& scale) {
  core::ImageRgba8 picture(image.values.width(), image.values.height());
  paint(image.values, scale, picture);
  for (std::size_t i = 0; i < image.edges.size(); ++i) {
    if (image.edges[i] == 0) continue;
    core::Rgba8& p = picture.pixels()[i];
    p = {static_cast<std::uint8_t>(p.r / 2), static_cast<std::uint8_t>(p.g / 2),
         static_cast<std::uint8_t>(p.b / 2), p.a};
  }
  return picture;
}

void layOver(const core::ImageRgba8& overlay, float strength, core::ImageRgba8& picture) {
  const int weight = static_cast<int>(std::lround(256 * strength));
  const auto mix = [weight](std::uint8_t over, std::uint8_t under) {
    return static_cast<std::uint8_t>((weight * over + (256 - weight) * under + 128) / 256);
  };
  for (std::size_t i = 0; i < picture.pixels().size(); ++i) {
    const core::Rgba8& o = overlay.pixels()[i];
    core::Rgba8& p = picture.pixels()[i];
    p = {mix(o.r, p.r), mix(o.g, p.g), mix(o.b, p.b), p.a};
  }
}

AovLegend aovLegend(const AovScale& scale, const core::ImageGray& values, const core::Scene& scene) {
  AovLegend legend{meaningOf(scale.aov()), "diffuse, or no sample", scale.ramp(), {}, 0};
  if (scale.aov() == Aov::saliency) legend.black = "";
  if (scale.aov() == Aov::id || scale.aov() == Aov::importance) legend.black = "diffuse";
  if (scale.aov() == Aov::rank) legend.black = "diffuse, or all handed out";
  if (scale.ramp()) return legend;
  const std::vector<std::uint32_t> counts = countsOf(values);
  std::vector<std::uint32_t> present;
  const std::uint32_t fixed = fixedCategories(scale.aov());
  for (std::uint32_t value = 1; value < counts.size() || value <= fixed; ++value) {
    if (value <= fixed || counts[value] > 0) present.push_back(value);
  }
  if (present.size() > AovLegend::kMostSwatches) {
    legend.leftOut = present.size() - AovLegend::kMostSwatches;
    std::stable_sort(present.begin(), present.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return counts[a] > counts[b]; });
    present.resize(AovLegend::kMostSwatches);
    std::sort(present.begin(), present.end());
  }
  for (const std::uint32_t value : present) {
    const auto exact = static_cast<float>(value);
    legend.swatches.push_back({exact, scale.color(exact), labelOf(scale.aov(), value, scene)});
  }
  return legend;
}

}  // namespace saccade::app
