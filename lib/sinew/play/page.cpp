// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/play/page.h>

#include <sinew/metrics/markup.h>
#include <sinew/metrics/report/page.h>

namespace sinew {
namespace {

// The browser enforces this: no requests but to the session.
constexpr std::string_view only_the_session =
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; connect-src 'self' "
    "ws://127.0.0.1:* ws://localhost:*; style-src 'unsafe-inline'; script-src 'unsafe-inline'; "
    "base-uri 'none'; form-action 'none'\">\n";

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  const auto at = text.find(what);
  return at == text.npos ? text : text.replace(at, what.size(), by);
}

std::string head() {
  return "<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n" +
         std::string(only_the_session) + element("title", "sinew play") +
         element("style", std::string(page_style()) + std::string(play_style()));
}

std::string body() {
  return replaced(std::string(play_markup()), "{view}", view_section("")) +
         element("script", "{\"worst\":[]}", "type=\"application/json\" id=\"data\"") +
         element("script", std::string(scene_library())) +
         element("script", std::string(view_script()) + std::string(play_script()));
}

}  // namespace

std::string play_page() {
  return "<!DOCTYPE html>\n" +
         element("html", '\n' + element("head", '\n' + head()) + element("body", '\n' + body()),
                 "lang=\"en\"");
}

}  // namespace sinew
