#include "app/recording/session_writer.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <array>
#include <bit>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <optional>
#include <string>
#include <type_traits>

#include "app/recording/session_format.h"
#include "core/error.h"

namespace saccade::app {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kPageBytes = 16384;  ///< a batch of 64 samples and more to a page

[[noreturn]] void fail(const std::filesystem::path& file, const SQLite::Exception& e) {
  std::string why = e.what();
  if (e.getErrorCode() == SQLITE_BUSY || e.getErrorCode() == SQLITE_LOCKED)
    why = "another program is using it";
  if (e.getErrorCode() == SQLITE_FULL) why = "the disk is full";
  if (e.getErrorCode() == SQLITE_CANTOPEN)
    why = "it cannot be opened for writing; check folder and permissions";
  throw core::Error(file.string() + ": " + why);
}

std::string hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

std::string utcNow() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

std::string agingName(AgingTest test) {
  for (const auto& [name, value] : agingTests()) {
    if (value == test) return name;
  }
  return "";
}

}  // namespace

void refuseForeignFile(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  constexpr std::size_t kIdAt = 68;  // the database header's application id, big-endian
  std::array<unsigned char, kIdAt + 4> header{};
  stream.read(reinterpret_cast<char*>(header.data()), header.size());
  if (stream.gcount() == 0 && !std::filesystem::is_directory(file)) return;  // none, or empty
  std::uint32_t id = 0;
  for (std::size_t i = 0; i < 4; ++i) id = id << 8 | header[kIdAt + i];
  const bool database = std::string(header.begin(), header.begin() + 15) == "SQLite format 3";
  if (!database || id != kSessionApplicationId)
    throw core::Error(file.string() +
                      ": exists and is no recorded session, so it is not overwritten; give "
                      "--record another name");
}

struct SessionWriter::State {
  std::filesystem::path file;
  std::chrono::milliseconds commitEvery;
  SQLite::Database db;
  std::optional<SQLite::Statement> insertBatch, insertFrame, insertSetting;
  std::optional<FrameSettings> settings;  ///< of the last frame
  std::int64_t frames = 0;
  std::uint64_t samples = 0;
  bool open = false;  ///< a transaction is
  Clock::time_point begun;

  State(const std::filesystem::path& f, std::chrono::milliseconds every)
      : file(f), commitEvery(every), db(f.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE) {}

  void prepareFile(const SessionInfo& info) {
    db.exec("PRAGMA locking_mode = EXCLUSIVE");
    db.exec("PRAGMA page_size = " + std::to_string(kPageBytes));
    db.exec("BEGIN EXCLUSIVE");
    dropTables();
    db.exec("PRAGMA application_id = " + std::to_string(kSessionApplicationId));
    db.exec("PRAGMA user_version = " + std::to_string(kSessionVersion));
    db.exec(kSessionTables);
    describe(info);
    db.exec("COMMIT");
    // After the first commit, so that the file itself says what it is even if the log is lost. Before, the
    // pages of an earlier recording are given back.
    db.exec("VACUUM");
    db.exec("PRAGMA journal_mode = WAL");
    db.exec("PRAGMA synchronous = NORMAL");
    insertBatch.emplace(db, "INSERT INTO batches(frame, epoch, samples, data) VALUES(?, ?, ?, ?)");
    insertFrame.emplace(db, "INSERT INTO frames VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)");
    insertSetting.emplace(db, "INSERT INTO settings VALUES(?, ?, ?)");
  }

  void dropTables() {
    std::vector<std::string> names;
    SQLite::Statement tables(db, "SELECT name FROM sqlite_master WHERE type = 'table'");
    while (tables.executeStep()) names.emplace_back(tables.getColumn(0).getText());
    tables.reset();
    for (const std::string& name : names) db.exec("DROP TABLE \"" + name + "\"");
  }

  template <class T>
  void describe(const char* name, const T& value) {
    SQLite::Statement insert(db, "INSERT INTO session VALUES(?, ?)");
    insert.bind(1, name);
    insert.bind(2, value);
    insert.exec();
  }

  void describe(const SessionInfo& info) {
    describe("program", std::string("saccade 0.1"));
    describe("started", utcNow());
    describe("scene", info.scene.path);
    describe("scene_hash", hex(info.sceneHash));
    describe("scene_options", loadOptionsText(info.scene.load));
    describe("maps", info.maps.string());
    describe("maps_hash", hex(info.mapsHash));
    describe("context", info.on.context);
    describe("renderer", info.on.renderer);
    describe("cpu", info.on.cpu);
    describe("sample_bytes", static_cast<std::int64_t>(kSampleBytes));
    describe("seed", static_cast<std::int64_t>(info.seed));
    describe("threads", info.threads);
    describe("spp", info.corrective.samplesPerPixel);
    describe("job_size", info.corrective.jobSize);
  }

  void begin() {
    if (open) return;
    db.exec("BEGIN");
    open = true;
    begun = Clock::now();
  }

  void commit() {
    if (!open) return;
    db.exec("COMMIT");
    open = false;
  }

  static void run(SQLite::Statement& statement) {
    statement.exec();
    statement.reset();
  }

  void writeBatch(const core::SampleBatch& batch) {
    if (batch.samples.empty()) return;  // a job whose lattice points all missed the mask
    begin();
    const std::vector<std::uint8_t> data = encodeSamples(batch.samples);
    insertBatch->bind(1, frames);
    insertBatch->bind(2, static_cast<std::int64_t>(batch.epoch));
    insertBatch->bind(3, static_cast<std::int64_t>(batch.samples.size()));
    insertBatch->bindNoCopy(4, data.data(), static_cast<int>(data.size()));
    run(*insertBatch);
    samples += batch.samples.size();
  }

  template <class T>
  void writeSetting(const char* name, const T& value) {
    insertSetting->bind(1, frames);
    insertSetting->bind(2, name);
    if constexpr (std::is_same_v<T, float>) {
      insertSetting->bind(3, static_cast<double>(value));
    } else if constexpr (std::is_same_v<T, std::string>) {
      insertSetting->bind(3, value);
    } else {
      insertSetting->bind(3, static_cast<std::int64_t>(value));
    }
    run(*insertSetting);
  }

  /// Those that differ from the last frame's; all at first.
  void writeSettings(const FrameSettings& now) {
    if (settings == now) return;
    std::vector<double> before;
    if (settings)
      forEachNumber(*settings,
                    [&](const char*, const auto& value) { before.push_back(static_cast<double>(value)); });
    std::size_t i = 0;
    forEachNumber(now, [&](const char* name, const auto& value) {
      if (before.empty() || before[i] != static_cast<double>(value)) writeSetting(name, value);
      ++i;
    });
    if (!settings || settings->picture.aging != now.picture.aging)
      writeSetting("aging", agingName(now.picture.aging));
    settings = now;
  }

  void writeFrame(const RecordedFrame& f) {
    begin();
    writeSettings(f.settings);
    SQLite::Statement& insert = *insertFrame;
    int column = 0;
    const auto integer = [&](auto value) { insert.bind(++column, static_cast<std::int64_t>(value)); };
    const auto real = [&](double value) { insert.bind(++column, value); };
    integer(frames);
    real(f.seconds);
    integer(f.newView);
    for (const core::Vec3& v : {f.camera.eye, f.camera.at, f.camera.up}) real(v.x), real(v.y), real(v.z);
    real(f.camera.fovYDegrees);
    integer(f.size.width);
    integer(f.size.height);
    integer(f.epoch);
    integer(std::bit_cast<std::int64_t>(f.hash));
    insert.bindNoCopy(++column, f.tiles.data(), static_cast<int>(f.tiles.size()));
    run(insert);
    ++frames;
  }

  void finish() {
    commit();
    insertBatch.reset(), insertFrame.reset(), insertSetting.reset();
    db.exec("PRAGMA journal_mode = DELETE");
  }
};

SessionWriter::SessionWriter(const std::filesystem::path& file, const SessionInfo& info,
                             std::chrono::milliseconds commitEvery) {
  try {
    state_ = std::make_unique<State>(file, commitEvery);
    state_->prepareFile(info);
  } catch (const SQLite::Exception& e) {
    fail(file, e);
  }
}

SessionWriter::~SessionWriter() = default;

void SessionWriter::write(const core::SampleBatch& batch) {
  try {
    state_->writeBatch(batch);
  } catch (const SQLite::Exception& e) {
    fail(state_->file, e);
  }
}

void SessionWriter::write(const RecordedFrame& frame) {
  try {
    state_->writeFrame(frame);
  } catch (const SQLite::Exception& e) {
    fail(state_->file, e);
  }
}

bool SessionWriter::commitIfDue() {
  if (!state_->open || Clock::now() - state_->begun < state_->commitEvery) return false;
  try {
    state_->commit();
    return true;
  } catch (const SQLite::Exception& e) {
    fail(state_->file, e);
  }
}

void SessionWriter::finish() {
  try {
    state_->finish();
  } catch (const SQLite::Exception& e) {
    fail(state_->file, e);
  }
}

std::int64_t SessionWriter::frames() const { return state_->frames; }
std::uint64_t SessionWriter::samples() const { return state_->samples; }

}  // namespace saccade::app
