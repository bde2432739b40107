// SPDX-License-Identifier: GPL-3.0-or-later
// Posing by hand in a page of the browser: a session that steps in real time, a server of the page,
// and what goes between them.
//
//     play(scene, {.folder = "out/fox_play", .port = 0}, [](const std::string& address) { ... });
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <sinew/settings/override.h>
#include <sinew/settings/settings.h>

namespace sinew {

struct PlayOptions {
  std::filesystem::path folder;  ///< folder of recordings
  int port = 0;                  ///< 0: any that is free
  /// The scene with settings in addition, in which the page applies them.
  std::function<Settings(const std::vector<Override>&)> read;

  // What a caller may listen to; each may be empty.
  std::function<void(const std::string& address)> ready = {};
  std::function<void(const std::string& line)> message = {};
  std::function<bool()> stop_requested = {};
};

/// Plays until it is to stop. Throws bad input and not written as Session does, and for a port that
/// is taken. The recording is on disk at every moment, up to the last second.
void play(const PlayOptions& options);

}  // namespace sinew
