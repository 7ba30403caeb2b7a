// The Khronos validator's own test files, with its reports as the truth (../shared/malformed).
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "core/scene/loaders.h"
#include "tests/shared_folder.h"

namespace saccade::core {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  bool loaded = false;
  std::string text;  ///< the refusal, or all warnings
};

/// Gate, parser and conversion. completeScene is left out: it refuses a file without triangles, as most of
/// these are, for a reason of its own.
Outcome load(const fs::path& file) {
  LoadBudget budget({}, file.filename().string());
  try {
    Outcome out{true, ""};
    for (const std::string& warning : loadGltf(file, {}, budget).warnings) out.text += warning + "\n";
    return out;
  } catch (const Error& e) {
    return {false, e.what()};
  }
}

struct Report {
  int errors = 0;
  std::set<std::string> codes;  ///< of severity "error"
};

Report reportOf(const fs::path& file) {
  std::ifstream in(file.string() + ".report.json");
  const nlohmann::json issues = nlohmann::json::parse(in).at("issues");
  Report report{issues.at("numErrors").get<int>(), {}};
  for (const auto& message : issues.at("messages"))
    if (message.at("severity") == 0) report.codes.insert(message.at("code").get<std::string>());
  return report;
}

std::vector<fs::path> validatorFiles(const fs::path& folder) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if ((extension == ".gltf" || extension == ".glb") && fs::exists(entry.path().string() + ".report.json"))
      out.push_back(entry.path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

// Both tables stand in docs/scenes.md, "Untrusted files", with the reasons.

/// Error codes of the validator that say nothing about what is seen.
const std::set<std::string> kTolerated = {
    // Stated bounds are not used: bounds come from the contents.
    "ANIMATION_SAMPLER_INPUT_ACCESSOR_WITHOUT_BOUNDS", "MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS",
    // Skins are not played.
    "ACCESSOR_INVALID_IBM", "ACCESSOR_JOINTS_INDEX_DUPLICATE", "ACCESSOR_JOINTS_INDEX_OOB",
    "ACCESSOR_WEIGHTS_NEGATIVE", "ACCESSOR_WEIGHTS_NON_NORMALIZED"};

/// Rules of ours that refuse files the validator finds valid: part of our message.
const std::vector<std::string> kOwnRules = {"URI has the scheme", "which glTF does not know",
                                            "does not exist beside the scene"};

TEST(Malformed, ValidatorFilesGoAsTheirReportsSay) {
  SACCADE_SHARED_FILE(folder, "malformed/gltf-validator");
  int files = 0;
  for (const fs::path& file : validatorFiles(folder)) {
    ++files;
    const Report report = reportOf(file);
    const Outcome outcome = load(file);
    SCOPED_TRACE(fs::relative(file, folder).string() + " -> " + outcome.text);
    if (report.errors > 0) {
      const bool tolerated =
          std::includes(kTolerated.begin(), kTolerated.end(), report.codes.begin(), report.codes.end());
      EXPECT_TRUE(!outcome.loaded || !outcome.text.empty() || tolerated);
    } else {
      const bool ownRule = std::any_of(kOwnRules.begin(), kOwnRules.end(), [&](const std::string& rule) {
        return outcome.text.find(rule) != std::string::npos;
      });
      EXPECT_TRUE(outcome.loaded || ownRule);
    }
  }
  EXPECT_EQ(files, 192);
}

}  // namespace
}  // namespace saccade::core
