// `saccade walk` as a process of its own, in a window that somebody uses, ended by signals.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <functional>
#include <thread>

#include "core/image_io.h"
#include "tests/unit/app/driven_viewer.h"
#include "tests/unit/app/fixtures.h"

namespace saccade::tests {
namespace {

using namespace std::chrono_literals;

/// Killed at the end if it runs still.
class Process {
 public:
  explicit Process(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), SACCADE_BINARY);
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (std::string& a : arguments) argv.push_back(a.data());
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ != 0) return;
    execv(argv[0], argv.data());
    _exit(127);
  }
  ~Process() {
    send(SIGKILL);
    if (pid_ > 0) wait();
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  pid_t id() const { return pid_; }
  void send(int signal) const {
    if (pid_ > 0) kill(pid_, signal);
  }
  /// Exit status, or 128 + the signal.
  int wait() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  pid_t pid_ = -1;
};

bool waitFor(const std::function<bool()>& done) {
  const auto end = std::chrono::steady_clock::now() + 60s;
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(20ms);
  }
  return true;
}

TEST(WindowProcess, SignalsEndItAsItsCloseButtonDoes) {
  SACCADE_NEEDS_A_DISPLAY_TO_DRIVE();
  const OwnFolders folders;
  for (const int signal : {SIGTERM, SIGINT}) {
    std::filesystem::remove("ui.png");
    Process walk({"walk", bundled("cornell.glb").string(), "--quality", "preview", "--size", "300x300",
                  "--ui-screenshot", "ui.png"});
    {
      XDriver driver("Saccade", walk.id());
      const render::PixelRect area{0, 0, 300, 300};
      core::ImageRgba8 first;
      ASSERT_TRUE(waitFor([&] {
        first = crop(driver.screen(), area);
        return pixelsOf(first, first.at(150, 150)) < first.pixels().size() / 2;
      })) << "no picture";
      driver.keyDown("d");
      EXPECT_TRUE(waitFor([&] { return pixelsThatDiffer(crop(driver.screen(), area), first) > 1000; }))
          << "nobody walks";
      driver.keyUp("d");
    }
    walk.send(signal);
    EXPECT_EQ(walk.wait(), 0) << strsignal(signal);
    const core::ImageRgba8 last = core::readImage8("ui.png");
    EXPECT_EQ(last.width(), 300 + app::kPanelWidth) << strsignal(signal);
  }
}

}  // namespace
}  // namespace saccade::tests
