// A bounded series over time, thinned so that it stays even on a logarithmic axis.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace saccade::app {

/// Items at growing times. Each is at least `step()` times as late as the one before; where the series is
/// full, every second item goes and the step is squared. One thread.
template <class T>
class LogSeries {
 public:
  static constexpr double kFirstStep = 1.1;

  struct Entry {
    double seconds;
    T item;
  };

  /// At most `capacity` items, at least 2.
  explicit LogSeries(std::size_t capacity) : capacity_(std::max<std::size_t>(2, capacity)) {}

  /// Whether an item of this time belongs into the series. The first always does.
  bool wants(double seconds) const { return entries_.empty() || seconds >= entries_.back().seconds * step_; }
  /// `seconds` later than the last. What the series does not want may be added too: an end that counts.
  void add(double seconds, T item) {
    if (entries_.size() >= capacity_) thin();
    entries_.push_back({seconds, std::move(item)});
  }
  const std::vector<Entry>& entries() const { return entries_; }
  double step() const { return step_; }

 private:
  void thin() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < entries_.size(); i += 2) entries_[kept++] = std::move(entries_[i]);
    entries_.erase(entries_.begin() + static_cast<std::ptrdiff_t>(kept), entries_.end());
    step_ *= step_;
  }

  std::size_t capacity_;
  double step_ = kFirstStep;
  std::vector<Entry> entries_;
};

}  // namespace saccade::app
