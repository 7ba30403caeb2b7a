#include "core/metrics/fixations.h"

#define CSV_IO_NO_THREAD
#include <libfccp/csv.h>

#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

#include "core/error.h"
#include "core/math/random.h"

namespace saccade::core {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWanted = "; wanted: columns image, x_px, y_px, named by the first line";

float pixels(const char* text, const fs::path& file, unsigned line) {
  float value = 0;
  const char* end = text + std::strlen(text);
  const auto [stopped, failed] = std::from_chars(text, end, value);
  if (failed != std::errc{} || stopped != end || !std::isfinite(value)) {
    throw Error(file.string() + ": line " + std::to_string(line) + ": '" +
                std::string(std::string_view(text).substr(0, 40)) + "' is no position in pixels");
  }
  return value;
}

FixationTable readRows(const fs::path& file) {
  io::CSVReader<3, io::trim_chars<' ', '\t'>, io::double_quote_escape<',', '"'>> rows(file.string());
  rows.read_header(io::ignore_extra_column, "image", "x_px", "y_px");
  FixationTable table;
  char *image = nullptr, *x = nullptr, *y = nullptr;
  while (rows.read_row(image, x, y)) {
    table[image].push_back({pixels(x, file, rows.get_file_line()), pixels(y, file, rows.get_file_line())});
  }
  return table;
}

}  // namespace

FixationTable readFixations(const fs::path& file) {
  std::error_code failed;
  if (!fs::exists(file, failed)) throw Error(file.string() + ": no such file");
  if (!fs::is_regular_file(file, failed)) throw Error(file.string() + ": not a file" + kWanted);
  FixationTable table;
  try {
    table = readRows(file);
  } catch (const io::error::base& e) {
    throw Error(file.string() + ": " + e.what() + kWanted);
  }
  if (table.empty()) throw Error(file.string() + ": no fixations" + kWanted);
  return table;
}

std::vector<Fixation> fixationsOnOthers(const FixationTable& table, const std::string& picture,
                                        std::size_t count, std::uint32_t seed) {
  std::vector<Fixation> pool;
  for (const auto& [name, fixations] : table) {
    if (name != picture) pool.insert(pool.end(), fixations.begin(), fixations.end());
  }
  count = std::min(count, pool.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t random = hashKey(static_cast<std::uint32_t>(i), seed, 0, 0);
    std::swap(pool[i], pool[i + random % (pool.size() - i)]);
  }
  pool.resize(count);
  return pool;
}

}  // namespace saccade::core
