// What the window shows where no scene is yet, while one is being opened, and when that failed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/viewer/scene_opener.h"
#include "app/viewer/ui_items.h"
#include "render/window/presenter.h"

namespace saccade::app {

/// What to open of the files that were dropped: the first scene among them, by its extension.
struct DroppedScene {
  std::optional<std::filesystem::path> scene;
  std::string message;  ///< what became of the rest, or what could have been dropped; may be empty
};
DroppedScene chooseDropped(const std::vector<std::filesystem::path>& files);

/// The functions below draw between ImguiLayer::newFrame and render, in the middle of `area` (framebuffer
/// pixels), and note their controls.

/// How to open a scene, and those opened lately. Returns the one that was chosen: item "recent 0", ….
std::optional<std::filesystem::path> drawStartScreen(const std::vector<std::filesystem::path>& recent,
                                                     const render::PixelRect& area, UiItems& items);
/// Progress; true when "cancel" was pressed.
bool drawOpening(const SceneOpener::State& state, const render::PixelRect& area, UiItems& items);
/// Text that waits for "notice ok": true when it was pressed.
bool drawNotice(const std::string& text, const render::PixelRect& area, UiItems& items);

}  // namespace saccade::app
