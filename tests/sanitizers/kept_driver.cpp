// Keeps Mesa's software driver loaded until the process ends. GLX unloads it with the last window:
// LeakSanitizer cannot name afterwards what it left, and ThreadSanitizer ends a process that unloads a
// library which a suppression names. Part of the programs of sanitizer builds only.
#include <dlfcn.h>

#include <cstdio>

namespace {

bool keepDriver() {
  if (dlopen(SACCADE_MESA_DRIVER, RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE)) return true;
  std::fprintf(stderr, "windows cannot be tested under a sanitizer: %s\n", dlerror());
  return false;
}

[[maybe_unused]] const bool kKept = keepDriver();

}  // namespace
