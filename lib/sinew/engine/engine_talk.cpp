// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/engine/engine_talk.h>

#include <charconv>

namespace sinew {
namespace {

constexpr std::string_view state = "sinew-engine: state ", unstable = "sinew-engine: unstable ";

}  // namespace

std::string text_of(const EngineStatus& news) {
  return std::string(news.unstable ? unstable : state) + std::to_string(news.steps);
}

std::optional<EngineStatus> news_of(std::string_view line) {
  EngineStatus news;
  news.unstable = line.starts_with(unstable);
  if (!news.unstable && !line.starts_with(state)) return std::nullopt;
  line.remove_prefix(news.unstable ? unstable.size() : state.size());
  const auto [end, wrong] = std::from_chars(line.data(), line.data() + line.size(), news.steps);
  if (wrong != std::errc() || end != line.data() + line.size()) return std::nullopt;
  return news;
}

}  // namespace sinew
