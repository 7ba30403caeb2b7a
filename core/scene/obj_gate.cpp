#include "core/scene/obj_gate.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/scene/confined_file.h"

namespace saccade::core {
namespace {

using Text = std::string_view;

constexpr std::uint64_t kLinesPerLook = 4096;
/// What tinyobjloader and our conversion take, in bytes, measured from above.
constexpr std::uint64_t kBytesPerElement = 40, kBytesPerCorner = 320, kBytesPerShape = 2048,
                        kBytesPerMaterial = 4096, kBytesPerMtlLine = 512;

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\0'; }

/// The next word of a line, which loses it; empty at the end.
Text nextWord(Text& line) {
  std::size_t from = 0;
  while (from < line.size() && isBlank(line[from])) ++from;
  std::size_t to = from;
  while (to < line.size() && !isBlank(line[to])) ++to;
  const Text word = line.substr(from, to - from);
  line.remove_prefix(to);
  return word;
}

/// Lines end in LF, CR or both. Calls visit(line, number from 1).
template <class Visit>
void forEachLine(Text text, const std::string& who, const LoadBudget& budget, Visit&& visit) {
  std::uint64_t number = 1;
  while (!text.empty()) {
    // find_first_of calls memchr for every character.
    const auto isEnd = [](char c) { return c == '\n' || c == '\r'; };
    const auto end = static_cast<std::size_t>(std::find_if(text.begin(), text.end(), isEnd) - text.begin());
    if (end > kMaxObjLine)
      throw Error(who + ": line " + std::to_string(number) + ": longer than " + std::to_string(kMaxObjLine) +
                  " bytes");
    if (number % kLinesPerLook == 0) budget.checkTime();
    if (end > 0) visit(text.substr(0, end), number);
    const bool pair = text.substr(end).starts_with("\r\n");
    text.remove_prefix(std::min(text.size(), end + (pair ? 2 : 1)));
    ++number;
  }
}

/// Any finite single-precision number, as OBJ files write it.
bool isNumber(Text word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  float value = 0;
  const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return false;
  // Too small for single precision is as good as 0.
  if (failed == std::errc::result_out_of_range)
    return word.find("e-") < word.size() || word.find("E-") < word.size();
  return failed == std::errc() && std::isfinite(value);
}

class ObjGate {
 public:
  ObjGate(std::string who, Repairs& repairs, LoadBudget& budget)
      : who_(std::move(who)), repairs_(repairs), budget_(budget) {}

  std::string run(Text text) {
    count(text);
    out_.reserve(text.size());
    forEachLine(text, who_, budget_, [&](Text line, std::uint64_t number) {
      number_ = number;
      statement(line);
    });
    return std::move(out_);
  }

 private:
  /// Elements by kind, for indices may point forwards; and what tinyobjloader will need for them.
  void count(Text text) {
    std::uint64_t corners = 0, shapes = 0;
    forEachLine(text, who_, budget_, [&](Text line, std::uint64_t) {
      const Text keyword = nextWord(line);
      if (keyword == "v") ++total_[0];
      if (keyword == "vt") ++total_[1];
      if (keyword == "vn") ++total_[2];
      shapes += keyword == "o" || keyword == "g" || keyword == "usemtl";
      if (keyword != "f") return;
      while (!nextWord(line).empty()) ++corners;
    });
    budget_.charge(total_[0] + total_[1] + total_[2], kBytesPerElement, "");
    budget_.charge(corners, kBytesPerCorner, "");
    budget_.charge(shapes, kBytesPerShape, "");
    budget_.charge(text.size(), "");
    badVertex_.assign(total_[0], false);
  }

  std::string here() const { return who_ + ": line " + std::to_string(number_); }

  void statement(Text line) {
    Text rest = line;
    const Text keyword = nextWord(rest);
    if (keyword == "v" || keyword == "vt" || keyword == "vn") return element(keyword, rest);
    if (keyword == "f") return face(rest);
    constexpr std::array kPassed = {"o", "g", "s", "usemtl", "mtllib"};
    if (std::find(kPassed.begin(), kPassed.end(), keyword) != kPassed.end()) append(line);
    if (keyword == "p" || keyword == "l") repairs_.add("points and lines are left out", here());
  }

  void append(Text line) {
    out_.append(line);
    out_.push_back('\n');
  }

  void element(Text keyword, Text rest) {
    const std::size_t kind = keyword == "v" ? 0 : keyword == "vt" ? 1 : 2, needed = kind == 1 ? 1 : 3;
    ++seen_[kind];
    std::array<Text, 3> words;
    std::size_t given = 0;
    bool good = true;
    while (given < words.size()) {
      const Text word = nextWord(rest);
      if (word.empty()) break;
      good = good && isNumber(word);
      words[given++] = word;
    }
    if (!good || given < needed) {
      if (kind == 0) badVertex_[seen_[0] - 1] = true;
      repairs_.add(kind == 0   ? "vertices lack a coordinate or hold one that is no number"
                   : kind == 1 ? "texture coordinates that are no numbers were taken as 0"
                               : "normals that are no numbers were taken as 0",
                   here());
      words.fill("0");
      given = needed;
    }
    out_.append(keyword);
    for (std::size_t i = 0; i < given; ++i) out_.append(" ").append(words[i]);
    out_.push_back('\n');
  }

  /// Into [1, total], counted back from the last element if negative; 0 where there is no such element.
  std::uint64_t resolve(Text word, std::size_t kind) const {
    std::int64_t value = 0;
    const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (failed != std::errc() || end != word.data() + word.size()) return 0;
    if (value < 0 && value >= -static_cast<std::int64_t>(seen_[kind]))
      return seen_[kind] - static_cast<std::uint64_t>(-(value + 1));
    return value > 0 && static_cast<std::uint64_t>(value) <= total_[kind] ? static_cast<std::uint64_t>(value)
                                                                          : 0;
  }

  /// v, v/t, v//n or v/t/n, rewritten at the end of out_; false when the vertex is not there.
  bool corner(Text word) {
    std::array<Text, 3> parts;
    for (Text& part : parts) {
      const std::size_t slash = std::min(word.find('/'), word.size());
      part = word.substr(0, slash);
      word.remove_prefix(std::min(word.size(), slash + 1));
    }
    const std::uint64_t vertex = resolve(parts[0], 0);
    if (vertex == 0 || badVertex_[vertex - 1]) return false;
    std::array<std::uint64_t, 3> index{vertex, 0, 0};
    for (const std::size_t k : {std::size_t{1}, std::size_t{2}}) {
      if (parts[k].empty()) continue;
      index[k] = resolve(parts[k], k);
      if (index[k] == 0)
        repairs_.add(k == 1 ? "texture coordinate indices out of range were taken away"
                            : "normal indices out of range were taken away",
                     here());
    }
    out_.append(" ").append(std::to_string(index[0]));
    if (index[1] == 0 && index[2] == 0) return true;
    out_.push_back('/');
    if (index[1] != 0) out_.append(std::to_string(index[1]));
    if (index[2] != 0) out_.append("/").append(std::to_string(index[2]));
    return true;
  }

  void face(Text rest) {
    const std::size_t before = out_.size();
    out_.push_back('f');
    std::uint64_t corners = 0;
    bool good = true;
    for (Text word = nextWord(rest); !word.empty() && good; word = nextWord(rest)) {
      if (word.starts_with('#')) break;
      if (++corners > kMaxPolygonCorners)
        throw Error(here() + ": a polygon of more than " + std::to_string(kMaxPolygonCorners) + " corners");
      good = corner(word);
    }
    out_.push_back('\n');
    if (!good || corners < 3) {
      out_.resize(before);
      repairs_.add(good ? "faces of fewer than three corners were dropped"
                        : "faces with an index out of range or a vertex that is no number were dropped",
                   here());
      return;
    }
    chargeGrowth();
    if (corners > 4) work_ += corners * corners;
    if (work_ > kMaxPolygonWork)
      throw Error(here() + ": more large polygons than this program triangulates; triangulate them before");
  }

  /// Resolved indices can be longer than relative ones.
  void chargeGrowth() {
    if (out_.size() <= charged_ || out_.size() < out_.capacity() / 2) return;
    budget_.charge(out_.size() - charged_, "");
    charged_ = out_.size();
  }

  std::string who_;
  Repairs& repairs_;
  LoadBudget& budget_;
  std::array<std::uint64_t, 3> total_{}, seen_{};  // v, vt, vn
  std::vector<bool> badVertex_;
  std::string out_;
  std::uint64_t number_ = 0, work_ = 0, charged_ = 0;
};

}  // namespace

std::string readGatedObj(const std::filesystem::path& file, Repairs& repairs, LoadBudget& budget) {
  const auto bytes = readSceneFile(file, budget);
  std::string out = ObjGate(file.filename().string(), repairs, budget)
                        .run({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  budget.release(bytes.size());
  return out;
}

std::string readGatedMtl(const std::filesystem::path& file, LoadBudget& budget) {
  const auto bytes = readSceneFile(file, budget);
  const Text text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::string who = file.filename().string();
  std::uint64_t materials = 0, lines = 0;
  forEachLine(text, who, budget, [&](Text line, std::uint64_t) {
    ++lines;
    materials += nextWord(line) == "newmtl";
  });
  budget.charge(materials, kBytesPerMaterial, who);
  budget.charge(lines, kBytesPerMtlLine, who);
  return std::string(text);
}

}  // namespace saccade::core
