#include "raytrace/bake/scene_match.h"

#include <algorithm>
#include <set>
#include <unordered_map>

namespace saccade::raytrace {
namespace {

/// Earlier objects by a key, taken one after another.
class Waiting {
 public:
  explicit Waiting(std::size_t count) : taken_(count, 0) {}

  void add(std::uint64_t key, std::size_t object) { byKey_[key].objects.push_back(object); }
  std::int32_t take(std::uint64_t key) {
    const auto found = byKey_.find(key);
    if (found == byKey_.end()) return SceneMatch::kNone;
    List& list = found->second;
    while (list.next < list.objects.size() && taken_[list.objects[list.next]]) ++list.next;
    if (list.next == list.objects.size()) return SceneMatch::kNone;
    taken_[list.objects[list.next]] = 1;
    return static_cast<std::int32_t>(list.objects[list.next]);
  }
  void clear() { byKey_.clear(); }
  bool taken(std::size_t object) const { return taken_[object] != 0; }

 private:
  struct List {
    std::vector<std::size_t> objects;
    std::size_t next = 0;
  };
  std::unordered_map<std::uint64_t, List> byKey_;
  std::vector<char> taken_;
};

constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15ull;
std::uint64_t both(const core::ObjectState& o) { return o.shape * kOdd ^ o.look; }

std::string called(const std::string& name) { return name.empty() ? "(unnamed)" : name; }

}  // namespace

bool SceneMatch::sameObjects() const {
  for (std::size_t o = 0; o < before.size(); ++o) {
    if (before[o] != static_cast<std::int32_t>(o) || !sameLook[o]) return false;
  }
  return gone.empty();
}

SceneMatch matchScenes(const core::SceneState& now, const core::SceneState& before) {
  SceneMatch match;
  match.before.assign(now.objects.size(), SceneMatch::kNone);
  match.sameLook.assign(now.objects.size(), 0);
  Waiting waiting(before.objects.size());
  for (std::size_t b = 0; b < before.objects.size(); ++b) waiting.add(both(before.objects[b]), b);
  for (std::size_t o = 0; o < now.objects.size(); ++o) {
    match.before[o] = waiting.take(both(now.objects[o]));
    match.sameLook[o] = match.before[o] != SceneMatch::kNone;
  }
  waiting.clear();
  for (std::size_t b = 0; b < before.objects.size(); ++b) waiting.add(before.objects[b].shape, b);
  for (std::size_t o = 0; o < now.objects.size(); ++o) {
    if (match.before[o] == SceneMatch::kNone) match.before[o] = waiting.take(now.objects[o].shape);
  }
  for (std::size_t b = 0; b < before.objects.size(); ++b) {
    if (!waiting.taken(b)) match.gone.push_back(static_cast<std::uint32_t>(b));
  }
  return match;
}

std::vector<std::string> namesOfChanges(const SceneMatch& match, const core::SceneState& now,
                                        const core::SceneState& before) {
  std::multiset<std::string> gone;
  for (const std::uint32_t b : match.gone) gone.insert(called(before.plain.objects[b].name));
  std::vector<std::string> names;
  for (std::size_t o = 0; o < match.before.size(); ++o) {
    if (match.sameLook[o]) continue;
    const std::string name = called(now.plain.objects[o].name);
    const auto moved = gone.find(name);
    if (match.before[o] != SceneMatch::kNone) {
      names.push_back(name + " (material)");
    } else if (moved != gone.end()) {
      gone.erase(moved);
      names.push_back(name + " (moved)");
    } else {
      names.push_back(name + " (new)");
    }
  }
  for (const std::string& name : gone) names.push_back(name + " (gone)");
  return names;
}

}  // namespace saccade::raytrace
