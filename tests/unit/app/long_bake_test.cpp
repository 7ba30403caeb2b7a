// Bakes stopped, killed and gone on with, through the program itself.
#include "app/session/long_bake.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "app/session/workspace.h"
#include "tests/command_line.h"
#include "tests/unit/app/fixtures.h"

namespace saccade {
namespace {

using tests::Ran;
using tests::saccade;
using tests::slurp;
using namespace std::chrono_literals;

const std::string kScene = tests::bundled("cornell.glb").string();

std::filesystem::path output(const std::string& name) { return tests::temporaryFolder() / name; }

std::vector<std::string> bakeArguments(const std::filesystem::path& maps, int threads) {
  return {"bake",
          kScene,
          "-o",
          maps.string(),
          "--quality",
          "preview",
          "--photons",
          "400000",
          "--threads",
          std::to_string(threads),
          "--checkpoint-seconds",
          "0"};
}

std::string line(const std::vector<std::string>& arguments) {
  std::string out;
  for (const std::string& a : arguments) out += "'" + a + "' ";
  return out;
}

/// A bake in a process of its own, which can be sent signals.
class Child {
 public:
  explicit Child(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), SACCADE_BINARY);
    std::vector<char*> argv;
    for (std::string& a : arguments) argv.push_back(a.data());
    argv.push_back(nullptr);
    const std::string errors = (tests::temporaryFolder() / "child.txt").string();
    std::filesystem::remove(errors);  // an earlier child's words are not this one's
    pid_ = fork();
    if (pid_ == 0) {
      if (!freopen(errors.c_str(), "w", stderr) || !freopen("/dev/null", "w", stdout)) _exit(126);
      execv(argv[0], argv.data());
      _exit(127);
    }
  }
  /// Waits until it has begun to bake (its handlers are installed by then), or ended.
  void waitUntilBaking() {
    while (!ended() && errors().find("baking: ") == std::string::npos) std::this_thread::sleep_for(2ms);
  }
  void send(int signal) const {
    if (!ended_) kill(pid_, signal);
  }
  /// Exit status, or 128 + the signal.
  int wait() {
    if (!ended_) waitpid(pid_, &status_, 0);
    ended_ = true;
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
  }
  static std::string errors() { return slurp(tests::temporaryFolder() / "child.txt"); }

 private:
  bool ended() {
    ended_ = ended_ || waitpid(pid_, &status_, WNOHANG) == pid_;
    return ended_;
  }
  pid_t pid_ = -1;
  int status_ = 0;
  bool ended_ = false;
};

/// The maps of an uninterrupted bake, which was asked to go on from a checkpoint that is not there.
const std::string& wholeBake() {
  static const std::string bytes = [] {
    const Ran ran = saccade(line(bakeArguments(output("whole.maps"), 2)) + "--resume");
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_NE(ran.err.find("no checkpoint"), std::string::npos) << ran.err;
    EXPECT_FALSE(std::filesystem::exists(output("whole.maps.part")));
    return slurp(output("whole.maps"));
  }();
  return bytes;
}

TEST(LongBake, StoppedAndKilledAtSeveralMomentsAndResumedOnAnyThreadsTheFileIsTheSame) {
  const std::filesystem::path maps = output("stopped.maps"), part = output("stopped.maps.part");
  const int signals[] = {SIGTERM, SIGKILL, SIGINT, SIGKILL, SIGTERM, SIGKILL};
  int stops = 0;
  for (int i = 0; i < 6; ++i) {
    std::vector<std::string> arguments = bakeArguments(maps, i % 3);
    if (i > 0) arguments.emplace_back("--resume");
    Child child(arguments);
    child.waitUntilBaking();
    std::this_thread::sleep_for(i * 37ms);
    child.send(signals[i]);
    const int status = child.wait();
    if (status == 0) break;                    // faster than the signal
    if (std::filesystem::exists(maps)) break;  // killed after its work was done
    ++stops;
    if (signals[i] == SIGKILL) {
      // Status 1 would mean that the checkpoint which another left was refused.
      ASSERT_EQ(status, 128 + SIGKILL) << Child::errors();
      continue;
    }
    ASSERT_EQ(status, 1) << Child::errors();
    EXPECT_NE(Child::errors().find("with --resume goes on from " + part.string()), std::string::npos)
        << Child::errors();
    EXPECT_TRUE(std::filesystem::exists(part));
  }
  EXPECT_GT(stops, 0);
  if (std::filesystem::exists(part)) {
    const Ran last = saccade(line(bakeArguments(maps, 1)) + "--resume");
    ASSERT_EQ(last.status, 0) << last.err;
    EXPECT_NE(last.err.find("going on from " + part.string()), std::string::npos) << last.err;
  }
  EXPECT_TRUE(slurp(maps) == wholeBake()) << "the file differs";
  EXPECT_FALSE(std::filesystem::exists(part));
}

TEST(LongBake, DamagedCheckpointIsOneErrorLineThatSaysWhatToDo) {
  const std::filesystem::path maps = output("damaged.maps"), part = output("damaged.maps.part");
  std::ofstream(part) << "SACBAKE\nnonsense";
  const Ran refused = saccade(line(bakeArguments(maps, 1)) + "--resume");
  EXPECT_EQ(refused.status, 1);
  EXPECT_EQ(tests::errorLines(refused.err), 1) << refused.err;
  EXPECT_NE(refused.err.find("bake without --resume to start anew"), std::string::npos) << refused.err;
  EXPECT_TRUE(std::filesystem::exists(part)) << "it may be of use to somebody";
}

TEST(LongBake, CheckpointThatCannotBeWrittenIsAWarningOnce) {
  const std::filesystem::path maps = output("full.maps");
  // A checkpoint of this bake takes more than its maps: a limit between stands in for a full disk. The shell
  // counts in blocks of 512 bytes.
  const std::size_t blocks = wholeBake().size() / 512 + 64;
  const Ran ran =
      saccade(line(bakeArguments(maps, 2)), "trap '' XFSZ; ulimit -f " + std::to_string(blocks) + "; ");
  EXPECT_EQ(ran.status, 0) << ran.err;
  const std::string warning = "baking on without a checkpoint";
  const std::size_t first = ran.err.find(warning);
  ASSERT_NE(first, std::string::npos) << ran.err;
  EXPECT_EQ(ran.err.find(warning, first + 1), std::string::npos) << ran.err;
  EXPECT_TRUE(slurp(maps) == wholeBake()) << "the file differs";
  EXPECT_FALSE(std::filesystem::exists(output("full.maps.part")));
}

TEST(LongBake, StoppedWhereNothingCanBeWrittenSaysThatNothingIsKept) {
  Child child({"render", kScene, "-o", output("x.png").string(), "--quality", "preview", "--maps",
               "/proc/saccade.maps"});  // not even root may make a file there
  child.waitUntilBaking();
  child.send(SIGTERM);
  EXPECT_EQ(child.wait(), 1);
  EXPECT_NE(Child::errors().find("no checkpoint could be written"), std::string::npos) << Child::errors();
}

TEST(LongBake, APlaceThatCannotBeWrittenIsSaidBeforeTheBake) {
  std::filesystem::create_directory(output("folder.maps"));
  for (const std::filesystem::path& maps :
       {std::filesystem::path("/proc/saccade.maps"), output("folder.maps")}) {
    const Ran ran = saccade(line(bakeArguments(maps, 1)));
    EXPECT_EQ(ran.status, 1);
    EXPECT_EQ(tests::errorLines(ran.err), 1) << ran.err;
    EXPECT_EQ(ran.err.find("baking: "), std::string::npos) << ran.err;
  }
}

TEST(LongBake, MapsThatCannotBeWrittenAreAnErrorThatSaysWhereTheCheckpointIs) {
  const std::filesystem::path maps = output("quota.maps");
  std::ofstream(output("quota.maps.part")) << "of some bake";
  const Ran ran = saccade(line(bakeArguments(maps, 1)), "ulimit -f 16; ");
  EXPECT_EQ(ran.status, 1);
  EXPECT_EQ(tests::errorLines(ran.err), 1) << ran.err;
  EXPECT_NE(ran.err.find("quota.maps: cannot be written"), std::string::npos) << ran.err;
  EXPECT_NE(ran.err.find("--resume goes on from"), std::string::npos) << ran.err;
  EXPECT_EQ(ran.out, "") << "no maps are there";
}

TEST(LongBake, BakeThatAnotherCommandNeedsGoesOnByItself) {
  const std::vector<std::string> render = {"render",    kScene,
                                           "-o",        output("x.png").string(),
                                           "--maps",    output("implicit.maps").string(),
                                           "--quality", "preview",
                                           "--size",    "32x32"};
  for (int i = 0; i < 2; ++i) {
    Child child(render);
    child.waitUntilBaking();
    child.send(SIGTERM);
    EXPECT_EQ(child.wait(), 1);
    EXPECT_NE(Child::errors().find("the same command goes on from"), std::string::npos) << Child::errors();
    EXPECT_EQ(Child::errors().find("going on from") != std::string::npos, i == 1) << Child::errors();
  }
}

}  // namespace
}  // namespace saccade
