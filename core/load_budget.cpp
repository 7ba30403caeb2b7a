#include "core/load_budget.h"

#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <limits>

#include "core/error.h"

namespace saccade::core {
namespace {

constexpr std::uint64_t kMebi = 1u << 20;
constexpr std::uint64_t kLargestDefault = 8192 * kMebi;

std::string mebibytes(std::uint64_t bytes) {
  return std::to_string(bytes / kMebi + (bytes % kMebi != 0)) + " MiB";
}

}  // namespace

std::uint64_t defaultMaxMemory() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), pageBytes = ::sysconf(_SC_PAGE_SIZE);
  if (pages <= 0 || pageBytes <= 0) return kLargestDefault;
  const std::uint64_t machine = static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(pageBytes);
  return std::min(machine / 2 / kMebi * kMebi, kLargestDefault);
}

LoadBudget::LoadBudget(const LoadLimits& limits, std::string file)
    : limits_(limits), file_(std::move(file)) {}

void LoadBudget::charge(std::uint64_t bytes, const std::string& what) {
  checkTime();
  if (bytes > limits_.memoryBytes - used_) {
    const std::string who = what.starts_with(file_) ? what : what.empty() ? file_ : file_ + ": " + what;
    throw Error(who + ": needs " + mebibytes(bytes) + " besides the " + mebibytes(used_) +
                " in use; --max-memory allows " + mebibytes(limits_.memoryBytes) + " in all");
  }
  used_ += bytes;
}

void LoadBudget::charge(std::uint64_t count, std::uint64_t bytesEach, const std::string& what) {
  constexpr std::uint64_t kAll = std::numeric_limits<std::uint64_t>::max();
  charge(bytesEach > 0 && count > kAll / bytesEach ? kAll : count * bytesEach, what);
}

void LoadBudget::release(std::uint64_t bytes) {
  assert(bytes <= used_);
  used_ -= bytes;
}

bool LoadBudget::timeIsUp() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count() > limits_.seconds;
}

void LoadBudget::checkTime() const {
  if (limits_.stop.stop_requested()) throw Error(file_ + ": stopped on request");
  if (!timeIsUp()) return;
  std::string seconds = std::to_string(limits_.seconds);
  seconds.erase(seconds.find_last_not_of('0') + 1);
  if (seconds.back() == '.') seconds.pop_back();
  throw Error(file_ + ": takes longer than the " + seconds + " s that --max-load-seconds allows");
}

}  // namespace saccade::core
