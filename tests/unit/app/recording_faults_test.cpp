// Recordings that are cut off, damaged, foreign, locked or without room: what was committed replays, the walk
// goes on, and one line says what is the matter.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <random>
#include <regex>
#include <thread>
#include <utility>

#include "core/error.h"
#include "core/image_io.h"
#include "tests/command_line.h"
#include "tests/unit/app/recording_fixtures.h"

namespace saccade {
namespace {

using app::FrameBudget;
using app::FrameLoop;
using tests::cameraAt;
using tests::errorLines;
using tests::kSmall;
using tests::Ran;
using tests::saccade;

std::filesystem::path output(const std::string& name) { return tests::temporaryFolder() / name; }
std::string quoted(const std::filesystem::path& file) { return "'" + file.string() + "'"; }

const std::string kWalk = "walk " + quoted(tests::bundled("cornell.glb")) +
                          " --quality preview --size 96x64 --headless --orbit --threads 1 ";

constexpr int kFrames = 10;

/// Ten frames, some of a resting camera, with a change of exposure; recorded once.
const std::filesystem::path& goodSession() {
  static const std::filesystem::path file = [] {
    std::filesystem::path f = output("good.session");
    tests::recordWalk(f, {.threads = 0}, kFrames, [](FrameLoop& loop, int i) {
      if (i == 4) loop.setExposure(0.5f);
      loop.step(cameraAt(0.1 * (i - i % 3)), kSmall, FrameBudget::firstSamples(200));
    });
    return f;
  }();
  return file;
}

/// Scene and context of all replays here.
struct Stage {
  app::SessionReader session{goodSession()};
  std::unique_ptr<app::Workspace> workspace = app::openRecorded(session, "", "");
  app::Headless gl{tests::runOn("osmesa"), *workspace};
};

struct Result {
  std::int64_t frames = 0;
  core::Warnings warnings;
};

Result replay(const std::filesystem::path& file) {
  static Stage stage;
  app::SessionReader session(file);
  app::SessionReplay replay(session, stage.workspace->scene, *stage.gl.renderer);
  while (replay.next()) {
  }
  return {replay.frames(), replay.warnings()};
}

std::filesystem::path copyOfGood(const std::string& name) {
  std::filesystem::copy_file(goodSession(), output(name), std::filesystem::copy_options::overwrite_existing);
  return output(name);
}

std::filesystem::path altered(const std::string& sql) {
  std::filesystem::path file = copyOfGood("altered.session");
  tests::alter(file, sql);
  return file;
}

std::string refusalOf(const std::filesystem::path& file) {
  try {
    const app::SessionReader session(file);
    app::openRecorded(session, "", "");
  } catch (const core::Error& e) {
    return e.what();
  }
  return "";
}

TEST(RecordingFaults, WhatIsNoSessionOfThisSceneIsRefusedInOneLine) {
  EXPECT_EQ(refusalOf(goodSession()), "");
  const std::pair<const char*, const char*> cases[] = {
      {"PRAGMA application_id = 1", "no recorded session"},
      {"PRAGMA user_version = 4", "newer Saccade"},
      {"PRAGMA user_version = 0", "format 0"},
      {"DROP TABLE frames", "no such table"},
      {"DELETE FROM session WHERE name = 'scene'", "has no 'scene'"},
      {"UPDATE session SET value = 'x' WHERE name = 'sample_bytes'", "is no number"},
      {"UPDATE session SET value = '3' WHERE name = 'sample_bytes'", "out of range"},
      {"UPDATE session SET value = '{' WHERE name = 'scene_options'", "cannot be made out"},
      {"UPDATE session SET value = '12' WHERE name = 'scene_hash'", "is not the scene"},
      {"UPDATE session SET value = '/no/where.glb' WHERE name = 'scene'", "--scene-file"},
      {"UPDATE session SET value = '12' WHERE name = 'maps_hash'", "are not the illumination maps"},
      {"UPDATE session SET value = '/no/where.maps' WHERE name = 'maps'", "--maps"}};
  for (const auto& [sql, why] : cases) {
    const std::string refusal = refusalOf(altered(sql));
    EXPECT_NE(refusal.find(why), std::string::npos) << sql << "\n" << refusal;
    EXPECT_EQ(refusal.find('\n'), std::string::npos) << refusal;
  }
  std::ofstream(output("text.session"))
      << "not a database at all, but long enough to hold a header of one.........";
  EXPECT_NE(refusalOf(output("text.session")).find("no recorded session"), std::string::npos);
  std::ofstream(output("empty.session")).close();
  EXPECT_NE(refusalOf(output("empty.session")).find("no recorded session"), std::string::npos);
}

TEST(RecordingFaults, DamageEndsTheReplayAtTheFrameBefore) {
  const char* cases[] = {"DELETE FROM frames WHERE frame = 5",
                         "UPDATE frames SET width = 99999 WHERE frame = 5",
                         "UPDATE frames SET height = 0 WHERE frame = 5",
                         "UPDATE frames SET eye_x = 9e999 WHERE frame = 5",
                         "UPDATE frames SET fov = 'wide' WHERE frame = 5",
                         "UPDATE frames SET at_x = eye_x, at_y = eye_y, at_z = eye_z WHERE frame = 5",
                         "UPDATE frames SET new_view = 7 WHERE frame = 5",
                         "UPDATE frames SET eye_x = eye_x + 1 WHERE frame = 5",  // at rest
                         "UPDATE frames SET epoch = epoch + 1 WHERE frame = 5",
                         "UPDATE frames SET tiles = 3 WHERE frame = 5",
                         "UPDATE settings SET frame = 5, value = 'newest' WHERE name = 'aging'",
                         "INSERT INTO settings VALUES(5, 'delta', 'small')",
                         "UPDATE batches SET samples = 1099511627776 WHERE frame = 5",
                         "UPDATE batches SET samples = -1 WHERE frame = 5",
                         "UPDATE batches SET data = X'00' WHERE frame = 5",
                         "UPDATE batches SET data = 'text' WHERE frame = 5",
                         "UPDATE batches SET epoch = 1000000000000 WHERE frame = 5"};
  for (const char* sql : cases) {
    const Result result = replay(altered(sql));
    EXPECT_EQ(result.frames, 5) << sql;
    ASSERT_EQ(result.warnings.size(), 1u) << sql;
    EXPECT_NE(result.warnings[0].find("cannot be read beyond frame 5"), std::string::npos)
        << result.warnings[0];
  }
}

TEST(RecordingFaults, ImpossibleSamplesAndBackwardTimesAreCountedAndRepaired) {
  const std::int64_t batches = tests::askedOf(goodSession(), "SELECT count(*) FROM batches");
  const std::pair<const char*, std::string> cases[] = {
      {"UPDATE batches SET data = CAST(substr(data,1,12) || X'0000C07F' || substr(data,17) AS BLOB)",
       std::to_string(batches) + " samples"},  // NaN
      {"UPDATE batches SET data = CAST(substr(data,1,48) || X'0000807F' || substr(data,53) AS BLOB)",
       std::to_string(batches) + " samples"},  // infinity
      {"UPDATE batches SET data = CAST(substr(data,1,8) || X'00' || substr(data,10) AS BLOB)",
       std::to_string(batches) + " samples"},  // level
      {"UPDATE batches SET data = CAST(substr(data,1,4) || X'FFFFFFFF' || substr(data,9) AS BLOB)",
       std::to_string(batches) + " samples"},  // object
      {"UPDATE batches SET data = CAST(X'FFFF' || substr(data,3) AS BLOB)",
       std::to_string(batches) + " samples"},  // pixel
      {"UPDATE frames SET seconds = -1 WHERE frame IN (5, 7)", "2 frames are earlier"}};
  for (const auto& [sql, said] : cases) {
    const Result result = replay(altered(sql));
    EXPECT_EQ(result.frames, kFrames) << sql;
    ASSERT_EQ(result.warnings.size(), 1u) << sql;
    EXPECT_NE(result.warnings[0].find(said), std::string::npos) << result.warnings[0];
  }
}

TEST(RecordingFaults, TornTailsAndFlippedBytesEndInAPrefixOrOneError) {
  const std::string good = tests::slurp(goodSession());
  std::mt19937 random(3);
  int replays = 0;
  for (int i = 0; i < 120; ++i) {
    std::string bytes = good;
    if (i < 40) {
      bytes.resize(bytes.size() * static_cast<std::size_t>(i) / 40);
    } else {
      for (int flip = 0; flip < 4; ++flip)
        bytes[random() % bytes.size()] ^= static_cast<char>(1u << (random() % 8));
    }
    std::ofstream(output("torn.session"), std::ios::binary) << bytes;
    try {
      EXPECT_LE(replay(output("torn.session")).frames, kFrames);
      ++replays;
    } catch (const core::Error& e) {
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
    }
  }
  EXPECT_GT(replays, 60);
}

/// What frame `i` of run `run` holds.
app::RecordedFrame numbered(int run, int i) {
  app::RecordedFrame f;
  f.seconds = i;
  f.camera.eye = {static_cast<float>(run), static_cast<float>(i), 0};
  f.size = {8, 8};
  f.epoch = 1 + static_cast<std::uint64_t>(i);
  f.hash = static_cast<std::uint64_t>(run) * 1000003 + static_cast<std::uint64_t>(i);
  f.tiles.assign(192, static_cast<std::uint8_t>(run));
  return f;
}

core::SampleBatch batchOf(int run, int i) {
  core::SampleBatch batch{1 + static_cast<std::uint64_t>(i), 0, std::vector<core::Sample>(100)};
  for (core::Sample& s : batch.samples) s.id = static_cast<std::uint32_t>(run);
  return batch;
}

/// Says through `told` after each commit how many frames are in the file.
[[noreturn]] void writeUntilKilled(const std::filesystem::path& file, const app::SessionInfo& info, int run,
                                   int told) {
  app::SessionWriter writer(file, info, std::chrono::milliseconds(1));
  for (int i = 0;; ++i) {
    writer.write(batchOf(run, i));
    writer.write(numbered(run, i));
    if (!writer.commitIfDue()) continue;
    const int committed = i + 1;
    if (write(told, &committed, sizeof committed) != sizeof committed) _exit(1);
  }
}

/// A run that is killed at any moment after `commits` commits. Returns how many frames it had committed by
/// the last of them.
int runAndKill(const std::filesystem::path& file, const app::SessionInfo& info, int run, int commits,
               std::chrono::microseconds later) {
  std::array<int, 2> told{};
  EXPECT_EQ(pipe(told.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    try {
      writeUntilKilled(file, info, run, told[1]);
    } catch (...) {
      _exit(1);
    }
  }
  EXPECT_GT(child, 0);
  close(told[1]);
  int committed = 0;
  for (int i = 0; i < commits; ++i)
    EXPECT_EQ(read(told[0], &committed, sizeof committed), static_cast<ssize_t>(sizeof committed))
        << "the writer failed by itself in run " << run;
  std::this_thread::sleep_for(later);
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  close(told[0]);
  EXPECT_TRUE(WIFSIGNALED(status)) << "the writer failed by itself in run " << run;
  return committed;
}

/// Reads all of a file that holds whole frames of one run. Returns the run, 0 without frames, and their
/// number.
std::pair<int, int> framesOfOneRun(app::SessionReader& session) {
  int i = 0, run = 0;
  while (const auto frame = session.nextFrame()) {
    if (i == 0) run = static_cast<int>(frame->camera.eye.x);
    EXPECT_EQ(frame->hash, numbered(run, i).hash);
    EXPECT_EQ(frame->tiles, numbered(run, i).tiles);
    const auto batch = session.nextBatch();
    EXPECT_TRUE(batch) << "frame " << i << " of run " << run;
    if (!batch) break;
    EXPECT_EQ(app::encodeSamples(batch->samples), app::encodeSamples(batchOf(run, i).samples));
    ++i;
  }
  EXPECT_EQ(session.damage(), "");
  return {run, i};
}

// One file for all runs: what a killed run left is replaced by the next, or stays, never a mixture. Half of
// the runs are killed while they open the file, the others after a few commits, all of which are there then.
TEST(RecordingFaults, KilledAHundredTimesTheFileHoldsWholeFramesOfOneRun) {
  const std::filesystem::path file = output("killed.session");
  const app::Headless gl(tests::runOn("osmesa"), tests::cornell());
  const app::SessionInfo info = tests::infoOfCornell(gl);
  std::mt19937 random(11);
  bool wasThere = false;
  for (int run = 1; run <= 100 && !HasFailure(); ++run) {
    const int commits = run % 2 == 0 ? 1 + static_cast<int>(random() % 6) : 0;
    const int committed = runAndKill(file, info, run, commits, std::chrono::microseconds(random() % 20000));
    std::optional<app::SessionReader> session;
    try {
      session.emplace(file);
    } catch (const core::Error& e) {
      EXPECT_FALSE(wasThere) << "a session was there before run " << run << ": " << e.what();
      continue;
    }
    wasThere = true;
    const auto [of, frames] = framesOfOneRun(*session);
    if (committed == 0) continue;
    EXPECT_EQ(of, run);
    EXPECT_GE(frames, committed) << "run " << run;
  }
}

TEST(RecordingFaults, AKilledWalkReplaysTheFramesItShowed) {
  const auto file = output("walk.session");
  ASSERT_EQ(saccade(kWalk + "--seconds 0.1").status, 0) << "bakes";
  for (const int frames : {32, 45}) {
    const auto shown = output("shown" + std::to_string(frames)),
               again = output("again" + std::to_string(frames));
    char last[32];
    std::snprintf(last, sizeof last, "frame_%05d.png", frames);
    const std::string command = "XDG_CACHE_HOME=" + quoted(tests::temporaryFolder() / "cache") +
                                " '" SACCADE_BINARY "' " + kWalk + "--seconds 60 --record " + quoted(file) +
                                " --frames " + quoted(shown) +
                                " 2>/dev/null >/dev/null & pid=$!; while [ ! -e " + quoted(shown / last) +
                                " ]; do sleep 0.01; done; kill -9 $pid; wait $pid 2>/dev/null";
    static_cast<void>(std::system(command.c_str()));
    const Ran ran = saccade("replay " + quoted(file) + " --verify --frames " + quoted(again));
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.err, "");
    int same = 0;
    for (const auto& entry : std::filesystem::directory_iterator(again)) {
      const auto original = shown / entry.path().filename();
      if (!std::filesystem::exists(original)) continue;  // recorded, and killed before its PNG was written
      EXPECT_EQ(core::readImage8(entry.path()).pixels(), core::readImage8(original).pixels()) << original;
      ++same;
    }
    EXPECT_GT(same, 0);
  }
}

TEST(RecordingFaults, WithoutRoomTheWalkGoesOnAndTheRestReplays) {
  const auto file = output("full.session");
  ASSERT_EQ(saccade(kWalk + "--seconds 0.1").status, 0) << "bakes";
  // Blocks of 512 bytes.
  const Ran ran = saccade(kWalk + "--seconds 4 --record " + quoted(file), "trap '' XFSZ; ulimit -f 3200; ");
  EXPECT_EQ(ran.status, 1) << ran.err;
  EXPECT_EQ(errorLines(ran.err), 1) << ran.err;
  EXPECT_NE(ran.err.find("the walk goes on"), std::string::npos) << ran.err;
  EXPECT_NE(ran.out.find("100 frames"), std::string::npos) << ran.out;
  const Ran replayed = saccade("replay " + quoted(file) + " --verify");
  EXPECT_EQ(replayed.status, 0) << replayed.err;
}

TEST(RecordingFaults, ASecondWriterIsTurnedAwayAndTheFirstIsNotDisturbed) {
  const auto file = output("two.session");
  const app::Headless gl(tests::runOn("osmesa"), tests::cornell());
  std::optional<app::SessionWriter> first(std::in_place, file, tests::infoOfCornell(gl));
  first->write(numbered(1, 0));
  const Ran second = saccade(kWalk + "--seconds 0.4 --record " + quoted(file));
  EXPECT_EQ(second.status, 1);
  EXPECT_EQ(errorLines(second.err), 1) << second.err;
  EXPECT_NE(second.err.find("another program is using it"), std::string::npos) << second.err;
  EXPECT_NE(second.out.find("10 frames"), std::string::npos) << "the walk goes on: " << second.out;
  const Ran reader = saccade("replay " + quoted(file) + " --verify");
  EXPECT_EQ(reader.status, 1);
  EXPECT_NE(reader.err.find("once the walk that records it has ended"), std::string::npos) << reader.err;
  first->write(numbered(1, 1));
  first->finish();
  first.reset();
  EXPECT_EQ(tests::askedOf(file, "SELECT count(*) FROM frames"), 2);
}

TEST(RecordingFaults, OnlyRecordingsAreReplaced) {
  const auto foreign = output("picture.png");
  std::ofstream(foreign) << "precious";
  const Ran refused = saccade(kWalk + "--seconds 0.1 --record " + quoted(foreign));
  EXPECT_EQ(refused.status, 1);
  EXPECT_EQ(errorLines(refused.err), 1) << refused.err;
  EXPECT_EQ(tests::slurp(foreign), "precious");
  const auto file = output("again.session");
  for (const int frames : {6, 3}) {
    const Ran ran = saccade(kWalk + "--samples 200 --seconds " + std::to_string(frames * 0.04) +
                            " --record " + quoted(file));
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(tests::askedOf(file, "SELECT count(*) FROM frames"), frames);
  }
  const Ran nowhere = saccade(kWalk + "--seconds 0.2 --record /no/such/folder/x.session");
  EXPECT_EQ(nowhere.status, 1);
  EXPECT_EQ(errorLines(nowhere.err), 1) << nowhere.err;
}

TEST(ReplayCommand, VerifiesNamesComparesAndWrites) {
  const auto file = output("command.session"), other = output("other.session");
  const auto shown = output("frames"), again = output("frames again");
  ASSERT_EQ(saccade(kWalk + "--seconds 0.4 --record " + quoted(file) + " --frames " + quoted(shown)).status,
            0);
  ASSERT_EQ(saccade(kWalk + "--seconds 0.4 --samples 50 --record " + quoted(other)).status, 0);
  EXPECT_EQ(saccade("replay " + quoted(file) + " --verify").status, 0);
  ASSERT_EQ(saccade("replay " + quoted(file) + " --from 0.2 --frames " + quoted(again)).status, 0);
  EXPECT_FALSE(std::filesystem::exists(again / "frame_00004.png"));
  for (int i = 5; i < 10; ++i) {
    const std::string name = "frame_0000" + std::to_string(i) + ".png";
    EXPECT_EQ(tests::slurp(again / name), tests::slurp(shown / name));
  }
  const std::regex zero(R"("rmse": 0\.0[,\n\r ])");
  EXPECT_TRUE(std::regex_search(
      saccade("replay " + quoted(file) + " --compare " + quoted(shown) + " --json").out, zero));
  const Ran compared = saccade("replay " + quoted(file) + " --compare " + quoted(other));
  EXPECT_EQ(compared.status, 0) << compared.err;
  EXPECT_NE(compared.out.find("worst by FLIP"), std::string::npos) << compared.out;
  tests::alter(file, "UPDATE frames SET hash = hash + 1 WHERE frame IN (3, 6)");
  const Ran differs = saccade("replay " + quoted(file) + " --verify");
  EXPECT_EQ(differs.status, 1);
  EXPECT_NE(differs.err.find("frame 3"), std::string::npos) << differs.err;
  tests::alter(file, "UPDATE session SET value = 'another' WHERE name = 'cpu'");
  const Ran elsewhere = saccade("replay " + quoted(file) + " --verify");
  EXPECT_EQ(elsewhere.status, 0) << elsewhere.err;
  EXPECT_NE(elsewhere.err.find("another renderer, context, CPU or version"), std::string::npos)
      << elsewhere.err;
}

TEST(SessionFormat, TheDocumentedQueriesRun) {
  const std::string page =
      tests::slurp(std::filesystem::path(SACCADE_SOURCE_DIR) / "docs" / "session-format.md");
  const std::regex block("```sql\n([^`]*)```");
  int queries = 0;
  for (std::sregex_iterator it(page.begin(), page.end(), block), end; it != end; ++it) {
    SQLite::Database db(goodSession().string());
    SQLite::Statement query(db, (*it)[1].str());
    EXPECT_TRUE(query.executeStep()) << (*it)[1].str();
    ++queries;
  }
  EXPECT_EQ(queries, 3);
}

}  // namespace
}  // namespace saccade
