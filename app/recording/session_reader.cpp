#include "app/recording/session_reader.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <type_traits>

#include "app/recording/session_format.h"
#include "core/error.h"
#include "render/context/gl_context.h"

namespace saccade::app {

namespace {

/// What ends the readable part of a recording.
struct Damage {
  std::string what;
};

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
  throw core::Error(file.string() + ": " + why);
}

[[noreturn]] void refuse(const std::filesystem::path& file, const SQLite::Exception& e) {
  switch (e.getErrorCode()) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      refuse(file,
             "another program is using it; a session can be read once the walk that records it has ended");
    case SQLITE_NOTADB:
      refuse(file, "is no recorded session; make one with 'saccade walk --record'");
    case SQLITE_CANTOPEN:
    case SQLITE_READONLY:
      refuse(file,
             "cannot be opened; a session whose walk was killed needs a folder that can be written: copy it "
             "there together with its -wal file");
    default:
      refuse(file, std::string("cannot be read (") + e.what() + "); record the session again");
  }
}

SQLite::Database openFile(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) refuse(file, "there is no such file");
  try {
    // Not read-only: what a killed walk left in the log is moved into the file. SQLite falls back by itself.
    return SQLite::Database(file.string(), SQLite::OPEN_READWRITE);
  } catch (const SQLite::Exception& e) {
    refuse(file, e);
  }
}

float real(const SQLite::Column& column) {
  const auto value = static_cast<float>(column.getDouble());
  if ((!column.isFloat() && !column.isInteger()) || !std::isfinite(value)) throw Damage{"a number is none"};
  return value;
}

std::int64_t integer(const SQLite::Column& column, std::int64_t least, std::int64_t most) {
  const std::int64_t value = column.getInt64();
  if (!column.isInteger() || value < least || value > most) throw Damage{"a number is out of range"};
  return value;
}

std::vector<std::uint8_t> bytes(const SQLite::Column& column) {
  if (!column.isBlob()) throw Damage{"bytes are missing"};
  const auto* data = static_cast<const std::uint8_t*>(column.getBlob());
  return {data, data + column.getBytes()};
}

constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();

}  // namespace

struct SessionReader::State {
  std::filesystem::path file;
  SQLite::Database db;
  SessionInfo info;
  std::size_t sampleBytes = kSampleBytes;
  std::optional<SQLite::Statement> frames, batches, settings;
  bool settingsLeft = false, batchesLeft = false;  ///< the statement stands on a row
  FrameSettings current;                           ///< of the frame read last
  std::optional<RecordedFrame> next;
  std::int64_t framesRead = 0, backwardTimes = 0;
  int version = 0;                       ///< of the format
  double seconds = 0;                    ///< of the frame read last
  std::string frameDamage, batchDamage;  ///< of what comes after the frame read last; within it

  explicit State(const std::filesystem::path& f) : file(f), db(openFile(f)) {}

  void checkVersion() {
    db.exec("PRAGMA trusted_schema = OFF");
    const auto id = static_cast<std::uint32_t>(db.execAndGet("PRAGMA application_id").getInt64());
    if (id != kSessionApplicationId)
      refuse(file,
             "is no recorded session, or its walk was stopped before it began; make one with 'saccade walk "
             "--record'");
    version = db.execAndGet("PRAGMA user_version").getInt();
    if (version > kSessionVersion)
      refuse(file, "was recorded by a newer Saccade (format " + std::to_string(version) +
                       ", this one reads " + std::to_string(kSessionVersion) + "); replay it with that one");
    if (version < 1)
      refuse(file, "has format " + std::to_string(version) +
                       ", which no version of Saccade writes; record the "
                       "session again");
  }

  void readInfo() {
    std::map<std::string, std::string> values;
    SQLite::Statement rows(db, "SELECT name, value FROM session");
    while (rows.executeStep()) values[rows.getColumn(0).getText()] = rows.getColumn(1).getText();
    const auto text = [&](const char* name) {
      const auto found = values.find(name);
      if (found == values.end())
        refuse(file, std::string("its table 'session' has no '") + name + "'; record the session again");
      return found->second;
    };
    const auto number = [&](const char* name, int base) {
      const std::string digits = text(name);
      std::uint64_t value = 0;
      const char* end = digits.data() + digits.size();
      if (const auto parsed = std::from_chars(digits.data(), end, value, base);
          parsed.ec != std::errc() || parsed.ptr != end)
        refuse(file,
               std::string("'") + name + "' in its table 'session' is no number; record the session again");
      return value;
    };
    info.scene.path = text("scene");
    info.sceneHash = number("scene_hash", 16);
    try {
      info.scene.load = parseLoadOptions(text("scene_options"));
    } catch (const core::Error& e) {
      refuse(file, e.what());
    }
    info.maps = text("maps");
    info.mapsHash = number("maps_hash", 16);
    info.on = {text("context"), text("renderer"), text("cpu"), version};
    sampleBytes = static_cast<std::size_t>(number("sample_bytes", 10));
    if (sampleBytes < kSmallestSampleBytes || sampleBytes > 4096)
      refuse(file, "'sample_bytes' in its table 'session' is out of range; record the session again");
  }

  void begin() {
    frames.emplace(
        db,
        "SELECT frame, seconds, new_view, eye_x, eye_y, eye_z, at_x, at_y, at_z, up_x, up_y, up_z, fov, "
        "width, height, epoch, hash, tiles FROM frames ORDER BY frame");
    batches.emplace(db, "SELECT frame, epoch, samples, data FROM batches ORDER BY batch");
    settings.emplace(db, "SELECT frame, name, value FROM settings ORDER BY frame");
    settingsLeft = settings->executeStep();
    batchesLeft = batches->executeStep();
    fetch();
  }

  /// Runs `read`, unless there is damage; what goes wrong in it is damage.
  template <class Read>
  static auto guarded(std::string& damage, Read&& read) -> decltype(read()) {
    if (!damage.empty()) return {};
    try {
      return read();
    } catch (const Damage& d) {
      damage = d.what;
    } catch (const SQLite::Exception& e) {
      damage = e.what();
    }
    return {};
  }

  void fetch() {
    next = guarded(frameDamage, [this]() -> std::optional<RecordedFrame> {
      if (!frames->executeStep()) return {};
      return readFrame();
    });
  }

  RecordedFrame readFrame() {
    SQLite::Statement& row = *frames;
    int column = 0;
    const auto nextColumn = [&] { return row.getColumn(column++); };
    if (integer(nextColumn(), 0, kMost) != framesRead) throw Damage{"frames are missing"};
    RecordedFrame f;
    f.seconds = row.getColumn(column).getDouble();
    real(nextColumn());
    f.newView = integer(nextColumn(), 0, 1) != 0;
    for (core::Vec3* v : {&f.camera.eye, &f.camera.at, &f.camera.up}) {
      for (int i = 0; i < 3; ++i) (*v)[i] = real(nextColumn());
    }
    f.camera.fovYDegrees = real(nextColumn());
    f.size.width = static_cast<int>(integer(nextColumn(), 1, render::kMaxImageSide));
    f.size.height = static_cast<int>(integer(nextColumn(), 1, render::kMaxImageSide));
    f.epoch = static_cast<std::uint64_t>(integer(nextColumn(), 1, kMost));
    f.hash =
        std::bit_cast<std::uint64_t>(integer(nextColumn(), std::numeric_limits<std::int64_t>::min(), kMost));
    f.tiles = bytes(nextColumn());
    if (framesRead == 0 && !f.newView) throw Damage{"the first frame has no view"};
    if (f.seconds < seconds) ++backwardTimes;
    f.seconds = seconds = std::max(seconds, f.seconds);
    readSettings();
    f.settings = current;
    return f;
  }

  void readSettings() {
    for (; settingsLeft && settings->getColumn(0).getInt64() <= framesRead;
         settingsLeft = settings->executeStep()) {
      const std::string name = settings->getColumn(1).getText();
      if (name == "aging") {
        const auto test = agingTests().find(settings->getColumn(2).getText());
        if (test == agingTests().end()) throw Damage{"an aging test is unknown to this version"};
        current.picture.aging = test->second;
      }
      forEachNumber(current, [&](const char* known, auto& value) {
        using T = std::remove_reference_t<decltype(value)>;
        if (name != known) return;
        if constexpr (std::is_same_v<T, float>) {
          value = real(settings->getColumn(2));
        } else {
          value = static_cast<T>(integer(settings->getColumn(2), 0, std::is_same_v<T, bool> ? 1 : 1000000));
        }
      });
    }
  }

  core::SampleBatch readBatch() {
    core::SampleBatch batch;
    batch.epoch = static_cast<std::uint64_t>(integer(batches->getColumn(1), 1, kMost));
    const auto count = static_cast<std::uint64_t>(integer(batches->getColumn(2), 0, kMost));
    const std::vector<std::uint8_t> data = bytes(batches->getColumn(3));
    if (data.size() % sampleBytes != 0 || data.size() / sampleBytes != count)
      throw Damage{"a batch has not the bytes of its samples"};
    batch.samples = decodeSamples(data, sampleBytes);
    batchesLeft = batches->executeStep();
    return batch;
  }
};

SessionReader::SessionReader(const std::filesystem::path& file) : state_(std::make_unique<State>(file)) {
  try {
    state_->checkVersion();
    state_->readInfo();
    state_->begin();
  } catch (const SQLite::Exception& e) {
    refuse(file, e);
  }
}

SessionReader::~SessionReader() = default;

const std::filesystem::path& SessionReader::file() const { return state_->file; }
const SessionInfo& SessionReader::info() const { return state_->info; }
const RecordedFrame* SessionReader::peek() const { return state_->next ? &*state_->next : nullptr; }
std::int64_t SessionReader::framesRead() const { return state_->framesRead; }
std::int64_t SessionReader::backwardTimes() const { return state_->backwardTimes; }
const std::string& SessionReader::damage() const {
  return state_->batchDamage.empty() ? state_->frameDamage : state_->batchDamage;
}
bool SessionReader::frameIsWhole() const { return state_->batchDamage.empty(); }

std::optional<RecordedFrame> SessionReader::nextFrame() {
  State& s = *state_;
  if (!s.next || !s.batchDamage.empty()) return {};
  std::optional<RecordedFrame> frame = std::move(s.next);
  s.next.reset();
  ++s.framesRead;
  s.fetch();
  return frame;
}

std::optional<core::SampleBatch> SessionReader::nextBatch() {
  State& s = *state_;
  const std::int64_t frame = s.framesRead - 1;
  if (!s.batchesLeft || s.batches->getColumn(0).getInt64() > frame) return {};
  return s.guarded(s.batchDamage, [&]() -> std::optional<core::SampleBatch> {
    if (integer(s.batches->getColumn(0), 0, kMost) != frame) throw Damage{"batches are out of order"};
    return s.readBatch();
  });
}

}  // namespace saccade::app
