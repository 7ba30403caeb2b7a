// The house's rules on who may include whom, checked on the sources themselves.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace {

const std::filesystem::path kRoot = SACCADE_SOURCE_DIR;

template <class Visit>
void forEachInclude(const std::string& room, Visit visit) {
  static const std::regex include(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kRoot / room)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".h" && extension != ".cpp") continue;
    std::ifstream stream(entry.path());
    std::smatch match;
    for (std::string line; std::getline(stream, line);) {
      if (std::regex_search(line, match, include)) visit(entry.path().string(), match[1].str());
    }
  }
}

TEST(Structure, RoomsIncludeOnlyWhatStandsBelowThem) {
  const std::map<std::string, std::set<std::string>> allowed = {
      {"core", {"core"}},
      {"render", {"core", "render"}},
      {"attention", {"core", "attention"}},
      {"raytrace", {"core", "raytrace"}},
      {"app", {"core", "render", "attention", "raytrace", "app"}},
      {"bench", {"core", "render", "attention", "raytrace", "app", "bench"}}};
  const std::set<std::string> rooms = {"core", "render", "attention", "raytrace",
                                       "app",  "bench",  "tests",     "data"};
  int seen = 0;
  for (const auto& [room, below] : allowed) {
    forEachInclude(room, [&](const std::string& file, const std::string& included) {
      const std::string target = included.substr(0, included.find('/'));
      if (rooms.count(target) == 0 || included.find('/') == std::string::npos) return;
      if (file == kRoot / "app" / "main.cpp") return;  // joins the rooms
      ++seen;
      EXPECT_EQ(below.count(target), 1u) << file << " includes " << included;
    });
  }
  EXPECT_GT(seen, 100);
}

TEST(Structure, OneRoomOneEngine) {
  const std::map<std::string, std::regex> engines = {{"attention", std::regex("^opencv2/")},
                                                     {"raytrace", std::regex("^embree3/")},
                                                     {"render", std::regex("^(GL|GLFW|EGL)/")}};
  for (const std::string room : {"core", "render", "attention", "raytrace", "app", "bench"}) {
    forEachInclude(room, [&](const std::string& file, const std::string& included) {
      for (const auto& [owner, engine] : engines) {
        EXPECT_FALSE(owner != room && std::regex_search(included, engine))
            << file << " includes " << included;
      }
    });
  }
}

}  // namespace
