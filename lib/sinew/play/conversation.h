// SPDX-License-Identifier: GPL-3.0-or-later
// What pages ask of a session, and what they are told: messages of JSON, and frames of it. Without
// threads and without a network, so that tests can say anything to it.
//
//     Conversation talk(options, [&](const std::string& text) { server.send(text); });
//     talk.take(R"({"do": "turn", "bone": "arm", "axis": [0, 1, 0], "degrees": 30})");
//     if (talk.is_due()) talk.advance();
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <sinew/play/play.h>
#include <sinew/play/session.h>

namespace sinew {

class Conversation {
 public:
  /// `options` must outlive it; `send` tells the page, if there is one.
  Conversation(const PlayOptions& options, std::function<void(const std::string& text)> send);
  ~Conversation();

  /// Does what a message asks for; one that cannot be done is answered with the reason. Throws what
  /// is wrong with the recording alone.
  void take(const std::string& message);

  // Time: of the clock, at the pace that the page has chosen.

  bool is_due() const;  ///< whether a step is to be made now
  void advance();
  /// The wait until something is due, s at most; none where a frame is `wanted` and there is one.
  std::chrono::steady_clock::duration until_due(bool wanted) const;

  /// Answers those who wait for bones that have come to where they were to go.
  void answer_turns();
  /// A frame for the page, where it would be another one than the last.
  std::optional<std::string> frame();
  /// Writes the recording, once in a while or `now`. Throws not written for the latter alone.
  void keep(bool now);

  Session& session();

 private:
  struct Impl;
  std::unique_ptr<Impl> its_;
};

}  // namespace sinew
