#include "app/viewer/kept_settings.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "core/atomic_file.h"
#include "core/cache_folder.h"
#include "core/error.h"

namespace saccade::app {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kVersion = 1;
constexpr int kLargestWindow = 32768;

/// The numbers and switches of settings, const or not, as {name, value, least, greatest}.
template <class Settings, class Visit>
void forEachNumber(Settings& s, const Visit& visit) {
  visit("attention", s.attention, 0.0, 1.0);
  visit("fps", s.fps, 0.1, 1000.0);
  visit("exposure", s.exposureEv, -64.0, 64.0);
  visit("delta", s.delta, 0.0, 2.0);
}
template <class Settings, class Visit>
void forEachSwitch(Settings& s, const Visit& visit) {
  visit("fullscreen", s.fullscreen);
  visit("panel", s.panelVisible);
  visit("error_plot", s.errorPlotOpen);
  visit("corrections", s.corrections);
  visit("reuse", s.reuse);
  visit("approximation", s.approximation);
}

/// Reads one value after another and collects the names of those that are wrong.
class Reader {
 public:
  explicit Reader(const Json& root) : root_(root) {}

  KeptSettings read() {
    KeptSettings s;
    forEachNumber(s, [this](const char* name, std::optional<double>& value, double least, double greatest) {
      check(name, [&](const Json& json) {
        if (!json.is_number()) return false;
        const auto number = json.get<double>();
        if (!(number >= least && number <= greatest)) return false;
        value = number;
        return true;
      });
    });
    forEachSwitch(s, [this](const char* name, std::optional<bool>& value) {
      check(name, [&](const Json& json) {
        if (json.is_boolean()) value = json.get<bool>();
        return json.is_boolean();
      });
    });
    check("window", [&](const Json& json) { return readWindow(json, s.window); });
    check("recent", [&](const Json& json) { return readRecent(json, s); });
    return s;
  }
  /// Names of what was wrong, with commas between; empty: nothing.
  const std::string& wrong() const { return wrong_; }

 private:
  template <class Take>
  void check(const char* name, const Take& take) {
    const auto found = root_.find(name);
    if (found == root_.end() || take(*found)) return;
    wrong_ += (wrong_.empty() ? "" : ", ") + std::string(name);
  }

  static bool readWindow(const Json& json, std::optional<ImageSize>& window) {
    const auto side = [](const Json& number) {
      return number.is_number_integer() && number >= 1 && number <= kLargestWindow;
    };
    if (!json.is_array() || json.size() != 2 || !side(json[0]) || !side(json[1])) return false;
    window = ImageSize{json[0].get<int>(), json[1].get<int>()};
    return true;
  }

  /// The good ones, and whether that is all of them.
  static bool readRecent(const Json& json, KeptSettings& s) {
    if (!json.is_array()) return false;
    bool good = true;
    for (auto scene = json.rbegin(); scene != json.rend(); ++scene) {  // each goes to the front
      const std::filesystem::path file = scene->is_string() ? scene->get<std::string>() : "";
      std::error_code unknown;
      if (!file.is_absolute()) {
        good = false;
      } else if (std::filesystem::exists(file, unknown)) {
        addRecent(s, file);
      }
    }
    return good;
  }

  const Json& root_;
  std::string wrong_;
};

Json toJson(const KeptSettings& settings) {
  Json root{{"version", kVersion}};
  if (settings.window) root["window"] = {settings.window->width, settings.window->height};
  forEachNumber(settings, [&](const char* name, const std::optional<double>& value, double, double) {
    if (value) root[name] = *value;
  });
  forEachSwitch(settings, [&](const char* name, const std::optional<bool>& value) {
    if (value) root[name] = *value;
  });
  if (settings.recent.empty()) return root;
  root["recent"] = Json::array();
  for (const std::filesystem::path& scene : settings.recent) root["recent"].push_back(scene.string());
  return root;
}

std::filesystem::path besideIt(const std::filesystem::path& file) { return file.string() + ".broken"; }

/// What the file holds; nothing where it is none of ours or cannot be read, `fault` is why then. Names of
/// values that are wrong are appended to `wrong`.
std::optional<KeptSettings> readSettings(const std::filesystem::path& file, std::string& fault,
                                         std::string& wrong) {
  try {
    if (!std::filesystem::exists(file)) return KeptSettings{};
    const std::vector<std::uint8_t> bytes = core::readWholeFile(file);
    const Json root = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
    if (!root.is_object() || !root.contains("version") || root["version"] != kVersion) {
      fault = file.string() + ": not this program's settings";
      return std::nullopt;
    }
    Reader reader(root);
    KeptSettings settings = reader.read();
    wrong = reader.wrong();
    return settings;
  } catch (const std::exception& e) {  // core::Error; the file system's
    fault = e.what();
    return std::nullopt;
  }
}

/// Throws core::Error: then it is still there.
void putAside(const std::filesystem::path& file) {
  std::error_code failed;
  std::filesystem::rename(file, besideIt(file), failed);
  if (failed)
    throw core::Error(file.string() + ": cannot be moved to " + besideIt(file).string() + " (" +
                      failed.message() + ")");
}

}  // namespace

SettingsFile::SettingsFile() {
  try {
    file_ = core::configFolder() / "settings.json";
  } catch (const core::Error& e) {
    spdlog::warn("{}; the window's settings are not kept", e.what());
  }
}

KeptSettings SettingsFile::load() const {
  if (file_.empty()) return {};
  std::string fault, wrong;
  const std::optional<KeptSettings> settings = readSettings(file_, fault, wrong);
  if (!settings)
    spdlog::warn("{}; starting with the defaults; the first change moves it to {}", fault,
                 besideIt(file_).filename().string());
  if (!wrong.empty())
    spdlog::warn("{}: no usable value of {}; going on with the default", file_.string(), wrong);
  return settings.value_or(KeptSettings{});
}

void SettingsFile::change(const std::function<void(KeptSettings&)>& change) {
  if (file_.empty()) return;
  std::string fault, wrong;
  const std::optional<KeptSettings> kept = readSettings(file_, fault, wrong);
  KeptSettings settings = kept.value_or(KeptSettings{});
  const Json before = toJson(settings);
  change(settings);
  if (toJson(settings) == before) return;
  try {
    if (!kept) putAside(file_);
    write(settings);
  } catch (const core::Error& e) {
    if (!std::exchange(warned_, true))
      spdlog::warn("{}; the window's settings are not kept (XDG_CONFIG_HOME names another folder)", e.what());
  }
}

void SettingsFile::write(const KeptSettings& settings) const {
  std::error_code failed;
  std::filesystem::create_directories(file_.parent_path(), failed);  // else the writing says why
  // File names may be any bytes, JSON is UTF-8: such a name is not found again, which leaves it out.
  const std::string text = toJson(settings).dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
  core::writeFileAtomically(file_, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void addRecent(KeptSettings& settings, const std::filesystem::path& scene) {
  std::error_code failed;
  const std::filesystem::path whole = std::filesystem::absolute(scene, failed).lexically_normal();
  if (failed) return;
  std::erase(settings.recent, whole);
  settings.recent.insert(settings.recent.begin(), whole);
  if (settings.recent.size() > kMostRecent) settings.recent.resize(kMostRecent);
}

}  // namespace saccade::app
