#include "core/metrics/fixation_scores.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace saccade::core {
namespace {

/// Means of a row's values over `out.size()` equal stretches of it.
void averageStretches(std::span<const double> in, std::span<double> out) {
  const double step = static_cast<double>(in.size()) / static_cast<double>(out.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double from = static_cast<double>(i) * step;
    const double to = std::min(from + step, static_cast<double>(in.size()));
    double sum = 0;
    for (auto j = static_cast<std::size_t>(from); j < in.size() && static_cast<double>(j) < to; ++j) {
      const auto left = static_cast<double>(j);
      sum += in[j] * (std::min(to, left + 1) - std::max(from, left));
    }
    out[i] = sum / (to - from);
  }
}

std::vector<float> valuesAt(const ImageGray& scored, int width, int height,
                            std::span<const Fixation> fixations) {
  std::vector<float> values;
  values.reserve(fixations.size());
  for (const Fixation& f : fixations) {
    if (!(f.x >= 0 && f.y >= 0 && f.x < static_cast<float>(width) && f.y < static_cast<float>(height)))
      continue;
    const auto place = [](float at, int side, int scoredSide) {
      return std::min(static_cast<int>(at / static_cast<float>(side) * static_cast<float>(scoredSide)),
                      scoredSide - 1);
    };
    values.push_back(scored.at(place(f.x, width, scored.width()), place(f.y, height, scored.height())));
  }
  return values;
}

double meanZScore(std::span<const float> values, std::span<const float> all) {
  double sum = 0, squares = 0;
  for (const float v : all) sum += v;
  const double mean = sum / static_cast<double>(all.size());
  for (const float v : all) squares += (v - mean) * (v - mean);
  const double deviation = std::sqrt(squares / static_cast<double>(all.size()));
  if (!(deviation > 0)) return 0;
  double total = 0;
  for (const float v : values) total += (v - mean) / deviation;
  return total / static_cast<double>(values.size());
}

}  // namespace

ImageGray resizedByArea(const ImageGray& map, int width, int height) {
  assert(!map.empty() && width > 0 && height > 0);
  std::vector<double> line(map.width()), column(map.height()), shrunk(height);
  std::vector<double> across(static_cast<std::size_t>(width) * map.height());
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) line[x] = map.at(x, y);
    averageStretches(line, {&across[static_cast<std::size_t>(y) * width], static_cast<std::size_t>(width)});
  }
  ImageGray out(width, height);
  for (int x = 0; x < width; ++x) {
    for (int y = 0; y < map.height(); ++y) column[y] = across[static_cast<std::size_t>(y) * width + x];
    averageStretches(column, shrunk);
    for (int y = 0; y < height; ++y) out.at(x, y) = static_cast<float>(shrunk[y]);
  }
  return out;
}

double areaUnderCurve(std::span<const float> positives, std::span<const float> negatives) {
  assert(!positives.empty() && !negatives.empty());
  std::vector<float> sorted(negatives.begin(), negatives.end());
  std::sort(sorted.begin(), sorted.end());
  double wins = 0;
  for (const float v : positives) {
    const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), v);
    wins +=
        static_cast<double>(first - sorted.begin()) + 0.5 * static_cast<double>(last - first);  // ties: half
  }
  return wins / (static_cast<double>(positives.size()) * static_cast<double>(sorted.size()));
}

std::optional<FixationScores> scoreFixations(const ImageGray& map, std::span<const Fixation> own,
                                             std::span<const Fixation> onOthers) {
  const ImageGray scored = resizedByArea(map, kScoredWidth, kScoredHeight);
  const std::vector<float> values = valuesAt(scored, map.width(), map.height(), own);
  if (values.empty()) return std::nullopt;
  FixationScores scores;
  scores.fixations = static_cast<int>(values.size());
  scores.auc = areaUnderCurve(values, scored.pixels());
  scores.nss = meanZScore(values, scored.pixels());
  const std::vector<float> others = valuesAt(scored, map.width(), map.height(), onOthers);
  if (!others.empty()) scores.shuffledAuc = areaUnderCurve(values, others);
  return scores;
}

}  // namespace saccade::core
