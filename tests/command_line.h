// The program as a stranger and a script run it.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/temporary_folder.h"

namespace saccade::tests {

struct Ran {
  int status = -1;
  std::string out, err;
};

inline std::string slurp(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Runs `saccade ARGUMENTS` through the shell, with its own cache folder.
inline Ran saccade(const std::string& arguments, const std::string& environment = "") {
  const std::filesystem::path errors = temporaryFolder() / "stderr.txt";
  const std::string command = environment + "XDG_CACHE_HOME='" + (temporaryFolder() / "cache").string() +
                              "' '" SACCADE_BINARY "' " + arguments + " 2>'" + errors.string() + "'";
  Ran ran;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    ran.out.append(buffer.data(), n);
  const int status = pclose(pipe);
  ran.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  ran.err = slurp(errors);
  return ran;
}

/// Lines that begin as errors do.
inline int errorLines(const std::string& err) {
  int n = 0;
  for (std::size_t at = err.find("saccade: error: "); at != std::string::npos;
       at = err.find("saccade: error: ", at + 1))
    ++n;
  return n;
}

}  // namespace saccade::tests
