#include "bench/validity/validity.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "bench/validity/judged_samples.h"
#include "bench/validity/walk_error.h"

namespace saccade::bench {
namespace {

constexpr float kDeltas[] = {0.01f, 0.02f, 0.05f, 0.1f, 0.2f, 0.4f};
constexpr int kPlaces = 6;
constexpr double kAgedSamples = 50'000;
constexpr float kTolerance = 0.03f;  ///< 8 of 255
constexpr const char* kScenes[] = {"gallery", "cornell", "table", "ward"};

/// Two ways to read "kept" and "valid" at once.
struct Tally {
  double all = 0, kept = 0, valid = 0, keptValid = 0;
  void count(bool isKept, bool isValid) {
    ++all;
    kept += isKept;
    valid += isValid;
    keptValid += isKept && isValid;
  }
  double precision() const { return kept > 0 ? keptValid / kept : 1; }
  double recall() const { return valid > 0 ? keptValid / valid : 1; }
  double reuse() const { return all > 0 ? kept / all : 0; }
};

/// One test with one delta on one kind of object.
struct Result {
  Tally usual, strict, lax, noiseless;
  double squared = 0;  ///< errors of what is kept
  void count(const JudgedSample& s, bool kept) {
    usual.count(kept, s.error <= kTolerance);
    strict.count(kept, s.error <= kTolerance / 2);
    lax.count(kept, s.error <= kTolerance * 2);
    if (s.noiseless >= 0) noiseless.count(kept, s.noiseless <= kTolerance);
    if (kept) squared += static_cast<double>(s.error) * s.error;
  }
  double error() const { return usual.kept > 0 ? std::sqrt(squared / usual.kept) : 0; }
};
using Results = std::array<Result, std::size(kObjectKinds)>;

struct Variant {
  app::AgingTest test;
  float delta;
  Results results;
  KindErrors walk;
  std::vector<double> agingMs;  ///< by place, for kAgedSamples
};

std::string textOf(float delta) {
  char text[16];
  std::snprintf(text, sizeof text, "%g", static_cast<double>(delta));
  return text;
}

std::string nameOf(app::AgingTest test) { return test == app::AgingTest::haber ? "haber" : "change"; }

void judge(const JudgedPlace& place, Variant& variant) {
  const JudgedPlace::Aged aged = place.aged({.delta = variant.delta, .test = variant.test});
  for (const JudgedSample& s : place.samples())
    variant.results[static_cast<std::size_t>(s.kind)].count(s, aged.kept.contains(s.key));
  variant.agingMs.push_back(1000 * aged.seconds * kAgedSamples / static_cast<double>(place.cached()));
}

Record costOf(const Variant& variant) {
  Record record;
  record.key = "validity/aging/" + nameOf(variant.test) + "@" + textOf(variant.delta);
  record.labels = {{"aging", nameOf(variant.test)}, {"delta", textOf(variant.delta)}};
  record.values = {{"aging", Value::milliseconds(variant.agingMs)}};
  return record;
}

Record recordOf(const Variant& variant, ObjectKind kind) {
  const auto k = static_cast<std::size_t>(kind);
  const Result& r = variant.results[k];
  Record record;
  record.key = "validity/" + nameOf(kind) + "/" + nameOf(variant.test) + "@" + textOf(variant.delta);
  record.labels = {{"kind", nameOf(kind)}, {"aging", nameOf(variant.test)}, {"delta", textOf(variant.delta)}};
  record.at = {{"delta", variant.delta}};
  const auto share = [](double v) { return Value::count(v, Better::higher); };
  record.values = {{"precision", share(r.usual.precision())},
                   {"recall", share(r.usual.recall())},
                   {"reuse", share(r.usual.reuse())},
                   {"error", Value::error(r.error())},
                   {"precision_strict", share(r.strict.precision())},
                   {"recall_strict", share(r.strict.recall())},
                   {"precision_lax", share(r.lax.precision())},
                   {"recall_lax", share(r.lax.recall())},
                   {"precision_noiseless", share(r.noiseless.precision())},
                   {"recall_noiseless", share(r.noiseless.recall())},
                   {"walk_rmse", Value::error(variant.walk[k].rmse())},
                   {"walk_flip", Value::error(variant.walk[k].meanFlip())},
                   {"samples", Value::count(r.usual.all)},
                   {"valid", Value::count(r.usual.valid / std::max(1.0, r.usual.all))}};
  return record;
}

/// What `change` keeps when its own delta is chosen so that its precision is that of `haber`; all of a kind.
Record equalPrecision(const Variant& haber, ObjectKind kind, std::vector<JudgedSample>& sorted) {
  const Tally& theirs = haber.results[static_cast<std::size_t>(kind)].usual;
  Tally best;
  double valid = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    valid += sorted[i].error <= kTolerance;
    if (valid / static_cast<double>(i + 1) >= theirs.precision())
      best = {theirs.all, static_cast<double>(i + 1), theirs.valid, valid};
  }
  Record record;
  record.key = "validity/" + nameOf(kind) + "/as-haber@" + textOf(haber.delta);
  record.labels = {
      {"kind", nameOf(kind)}, {"aging", "change, as precise as haber"}, {"delta", textOf(haber.delta)}};
  record.values = {{"precision", Value::count(theirs.precision())},
                   {"haber_reuse", Value::count(theirs.reuse(), Better::higher)},
                   {"haber_recall", Value::count(theirs.recall(), Better::higher)},
                   {"reuse", Value::count(best.reuse(), Better::higher)},
                   {"recall", Value::count(best.recall(), Better::higher)},
                   {"times_reuse", Value::count(best.reuse() / theirs.reuse(), Better::higher)}};
  return record;
}

}  // namespace

void measureValidity(Session& session) {
  std::vector<Variant> variants;
  for (const auto test : {app::AgingTest::haber, app::AgingTest::change})
    for (const float delta : kDeltas) variants.push_back({test, delta, {}, {}});
  std::array<std::vector<JudgedSample>, std::size(kObjectKinds)> all;
  for (const char* scene : kScenes) {
    session.say(std::string("validity: ") + scene);
    const auto stage = openStage(bundledScene(scene), "preview", session.options().seed, session.stop());
    const auto path = app::CameraPath::read(bundledPath(scene));
    for (int i = 0; i < kPlaces; ++i) {
      session.checkStop();
      const JudgedPlace place(*stage, path, path.lengthSeconds() * (2 * i + 1) / (2 * kPlaces));
      for (Variant& variant : variants) judge(place, variant);
      for (const JudgedSample& s : place.samples()) all[static_cast<std::size_t>(s.kind)].push_back(s);
    }
    const ComparedWalk walk(*stage, path);
    for (Variant& variant : variants) {
      session.checkStop();
      walk.walk(variant.test, variant.delta, variant.walk);
    }
  }
  for (const Variant& variant : variants) session.add(costOf(variant), nullptr);
  for (const ObjectKind kind : kObjectKinds) {
    auto& samples = all[static_cast<std::size_t>(kind)];
    std::sort(samples.begin(), samples.end(),
              [](const JudgedSample& a, const JudgedSample& b) { return a.expected < b.expected; });
    for (const Variant& variant : variants) {
      session.add(recordOf(variant, kind), nullptr);
      if (variant.test == app::AgingTest::haber) session.add(equalPrecision(variant, kind, samples), nullptr);
    }
  }
}

}  // namespace saccade::bench
