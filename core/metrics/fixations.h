// Where people looked at pictures: tables of recorded fixations.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace saccade::core {

/// In pixels of its picture from the top left corner; finite, perhaps outside the picture.
struct Fixation {
  float x = 0, y = 0;
};

/// By the picture's file name, at least one each.
using FixationTable = std::map<std::string, std::vector<Fixation>>;

/// A CSV file whose first line names the columns, `image`, `x_px` and `y_px` among them. Throws core::Error
/// that names file, line and what is wanted: not a file, another heading, too few or too many columns, no
/// number, no row. Any thread.
FixationTable readFixations(const std::filesystem::path& file);

/// Up to `count` fixations on other pictures than this one, drawn without replacement; the same for the same
/// table, picture, count and seed. Any thread.
std::vector<Fixation> fixationsOnOthers(const FixationTable& table, const std::string& picture,
                                        std::size_t count, std::uint32_t seed);

}  // namespace saccade::core
