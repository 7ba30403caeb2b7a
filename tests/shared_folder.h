// Where tests find real data that is not part of the project: SACCADE_SHARED, default ../shared beside the
// checkout.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace saccade::tests {

inline std::filesystem::path sharedFolder() {
  const char* named = std::getenv("SACCADE_SHARED");
  return named ? std::filesystem::path(named) : std::filesystem::path(SACCADE_SOURCE_DIR) / ".." / "shared";
}

}  // namespace saccade::tests

/// Skips the test, saying so, when a file under the shared folder is absent; else defines `variable`.
#define SACCADE_SHARED_FILE(variable, relative)                                       \
  const std::filesystem::path variable = saccade::tests::sharedFolder() / (relative); \
  if (!std::filesystem::exists(variable)) GTEST_SKIP() << "no " << variable << " (set SACCADE_SHARED)"
