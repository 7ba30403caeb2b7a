#include "attention/analyzer.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <utility>

namespace saccade::attention {
namespace {

// NaN counts as 0.
float clampWeight(float weight) { return weight >= 0 ? std::min(weight, 1.0f) : 0.0f; }

}  // namespace

double Analyzer::steadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Analyzer::Analyzer(const AttentionOptions& options, std::function<double()> seconds)
    : options_(options),
      seconds_(std::move(seconds)),
      attention_(clampWeight(options.attention)),
      model_(options.saliency) {}

void Analyzer::start(core::SnapshotMailbox& mailbox, core::RegionQueue& queue) {
  assert(!thread_.joinable());
  mailbox_ = &mailbox;
  thread_ = std::jthread([this, &mailbox, &queue] { run(mailbox, queue); });
}

void Analyzer::stop() {
  if (!thread_.joinable()) return;
  mailbox_->close();
  thread_.join();
}

std::vector<float> Analyzer::analyzeNow(const core::AnalysisInput& input) {
  assert(!thread_.joinable());
  return analyze(input)->importance.priority;
}

void Analyzer::setAttention(float weight) {
  attention_.store(clampWeight(weight), std::memory_order_relaxed);
}

void Analyzer::attend(std::uint32_t id) {
  const double now = seconds_();
  const std::lock_guard lock(mutex_);
  attended_.attend(id, now);
}

std::vector<float> Analyzer::attendedNow(std::size_t entries) {
  const double now = seconds_();
  const std::lock_guard lock(mutex_);
  return attended_.at(now, entries);
}

std::shared_ptr<const AttentionSnapshot> Analyzer::latest() const {
  const std::lock_guard lock(mutex_);
  return latest_;
}

AnalyzerTimes Analyzer::times() const {
  const std::lock_guard lock(mutex_);
  return times_;
}

void Analyzer::check() const {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

std::shared_ptr<const AttentionSnapshot> Analyzer::analyze(const core::AnalysisInput& input) {
  const auto begin = std::chrono::steady_clock::now();
  AttentionOptions options = options_;
  options.attention = attention();
  auto result = std::make_shared<AttentionSnapshot>();
  result->epoch = input.frame->epoch;
  if (needsSaliency(options.order)) result->saliency = model_.compute(*input.display);
  result->importance =
      importanceOf(*input.frame, result->saliency, options, attendedNow(input.frame->extents.size()));
  result->milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  const std::lock_guard lock(mutex_);
  latest_ = result;
  ++times_.analyses;
  times_.totalMilliseconds += result->milliseconds;
  return result;
}

void Analyzer::run(core::SnapshotMailbox& mailbox, core::RegionQueue& queue) {
  try {
    while (const auto input = mailbox.take()) queue.setPriorities(analyze(*input)->importance.priority);
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
  }
}

}  // namespace saccade::attention
