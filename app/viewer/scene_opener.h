// Opens scenes on a thread of its own, so that the window stays alive while a scene is read and its light
// computed.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "app/cli/walk_options.h"
#include "app/session/workspace.h"
#include "render/base/draw_list.h"

namespace saccade::app {

/// One scene at a time; the last one asked for counts. The owner's thread only, unless a line says otherwise.
class SceneOpener {
 public:
  /// To be called with what readWorkspace returned, and what of it is to be drawn.
  using Drawable = std::function<void(std::shared_ptr<const Workspace>, render::DrawList)>;
  /// Opens a scene: openWorkspace with what belongs to it. Called on the opener's thread.
  using Open =
      std::function<std::shared_ptr<const Workspace>(const WalkOptions& visit, const std::stop_token& stop,
                                                     const OpeningReport& report, const Drawable& drawable)>;

  /// What is under way.
  struct State {
    std::string scene;  ///< path
    OpeningStep step;
    bool cancelled = false;  ///< it ends as soon as it can
  };
  /// A scene whose base layer can be drawn: scene and maps are there.
  struct Reading {
    WalkOptions visit;
    std::shared_ptr<const Workspace> workspace;
    std::shared_ptr<const render::DrawList> drawList;
  };
  /// What became of a scene: one of the two.
  struct Outcome {
    WalkOptions visit;
    std::shared_ptr<const Workspace> workspace;
    std::string error;       ///< one line
    bool cancelled = false;  ///< `error` says how to go on, no more
  };

  explicit SceneOpener(Open open);
  /// Cancels and waits: a stop is looked at in every stage.
  ~SceneOpener();

  /// Cancels what is under way, and opens this next.
  void open(const WalkOptions& visit);
  /// What is under way ends with an outcome that says so; a bake keeps what it has. Nothing waits.
  void cancel();
  /// Of what is under way, or open and not yet taken. Nothing: idle. Any thread.
  std::optional<State> state() const;
  /// What is under way, or not yet taken, where it has come so far. Any thread.
  std::optional<Reading> drawable() const;
  /// There is something to take; a scene that is open is drawable() until then.
  bool hasOutcome() const;
  /// Each outcome once, in the order of the calls of open; one that was overtaken by a later call has none.
  std::optional<Outcome> take();
  /// Waits so long at most, less where something becomes drawable or has an outcome meanwhile.
  void awaitNews(std::chrono::milliseconds atMost);
  /// Cancels, waits, and returns what was not taken. Nothing can be opened afterwards.
  std::optional<Outcome> end();

 private:
  void work(const std::stop_token& end);
  Outcome openNow(const WalkOptions& visit, const std::stop_token& stop);

  const Open open_;
  mutable std::mutex mutex_;  ///< of what follows
  std::condition_variable_any asked_;
  std::condition_variable news_;
  std::optional<WalkOptions> next_;
  std::optional<State> current_;
  std::optional<Reading> drawable_;
  std::stop_source cancel_;  ///< of the current one
  std::optional<Outcome> outcome_;
  std::jthread thread_;  ///< last: joined before anything it uses goes
};

}  // namespace saccade::app
