// Image files whose kind nobody knows beforehand, told apart by content.
#pragma once

#include <filesystem>
#include <optional>

#include "core/image.h"
#include "core/load_budget.h"

namespace saccade::core {

/// Linear radiance of an OpenEXR or Radiance .hdr file; nothing where it is neither. Throws core::Error: not
/// a file, damaged. The pixels' bytes stay charged to `budget`. Any thread.
std::optional<ImageRgb> readRadiance(const std::filesystem::path& file, LoadBudget& budget);

/// A picture as a display shows it: PNG and JPEG as they are, OpenEXR and Radiance .hdr through the display
/// transform (exposure 0). Throws core::Error: not a file, none of these, damaged. Any thread.
ImageRgba8 readDisplayed(const std::filesystem::path& file);

}  // namespace saccade::core
