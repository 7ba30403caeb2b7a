// A cache folder of a test's own, removed at its end.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

#include "tests/unit/core/temporary_folder.h"

namespace saccade::tests {

/// One at a time: the environment is the process's.
class OwnCacheFolder {
 public:
  OwnCacheFolder() {
    if (const char* before = std::getenv("XDG_CACHE_HOME")) before_ = before;
    ::setenv("XDG_CACHE_HOME", folder_.path().c_str(), 1);
  }
  OwnCacheFolder(const OwnCacheFolder&) = delete;
  OwnCacheFolder& operator=(const OwnCacheFolder&) = delete;
  ~OwnCacheFolder() {
    if (before_) {
      ::setenv("XDG_CACHE_HOME", before_->c_str(), 1);
    } else {
      ::unsetenv("XDG_CACHE_HOME");
    }
  }
  const TemporaryFolder& folder() const { return folder_; }

 private:
  TemporaryFolder folder_;
  std::optional<std::string> before_;
};

}  // namespace saccade::tests
