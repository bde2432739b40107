// SPDX-License-Identifier: GPL-3.0-or-later
// What an engine in another program says while it steps, a line each, and what it is asked for.
//
//     print(text_of(EngineStatus{1200, false}));  // "sinew-engine: state 1200"
//     if (const auto news = news_of(line)) read_engine_state(folder, news->steps, like, ids);
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace sinew {

/// What ends a stretch of steps before its end; of all ranks the largest.
enum class Interruption {
  none,
  state,    ///< one is requested: SIGUSR2
  stop,     ///< after the step: SIGUSR1
  unstable  ///< the next step fails
};

/// A state is complete.
struct EngineStatus {
  std::int64_t steps = 0;
  bool unstable = false;  ///< the step after it failed: it is the last
};

/// Said once all ranks listen to signals.
inline constexpr std::string_view engine_begins = "sinew-engine: begins";

std::string text_of(const EngineStatus& news);
/// None for lines that say something else.
std::optional<EngineStatus> news_of(std::string_view line);

}  // namespace sinew
