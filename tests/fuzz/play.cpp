// SPDX-License-Identifier: GPL-3.0-or-later
// What pages say to a session: each line is a message to a body of a few particles, which steps in
// between.
#include <cstdlib>
#include <nlohmann/json.hpp>

#include <sinew/core/json.h>
#include <sinew/core/parallel.h>
#include <sinew/play/conversation.h>
#include <sinew/settings/read_scene.h>
#include "targets.h"

namespace sinew::fuzz {
namespace {

constexpr std::string_view box =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 2\nv 1 0 2\nv 0 1 2\nv 1 1 2\n"
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 2 4 8 6\nf 4 3 7 8\nf 3 1 5 7\n";
constexpr std::string_view text = R"(
body: {mesh: box.obj, radius: 0.2}
material: {model: bonded}
skeleton: {bones: [{name: a, head: [0.5, 0.5, 0], tail: [0.5, 0.5, 1]},
                   {name: b, parent: a, tail: [0.5, 0.5, 2]}]}
loads: [{name: tip, force: [1, 0, 0], keys: [{time: 0, factor: 0}]}]
world:
  obstacles: [{name: floor, shape: plane, friction: 0.5}]
  muscles: [{name: m, bone: b, strength: 500, keys: [{time: 0, activation: 0}]}]
)";

/// Answers are JSON, and refusals one line with a cure.
void check_answer(const std::string& answer) {
  const auto json = parsed_json<nlohmann::json>(answer);
  require(json.is_object());
  if (!json.contains("failed")) return;
  require(is_one_line(json["failed"].get<std::string>()));
}

}  // namespace

void play(std::string_view bytes) {
  constexpr std::size_t max_messages = 32, max_message = 16 << 10;
  file_of(box, "box.obj");
  const auto path = file_of(text, "played.yaml");
  PlayOptions options;
  options.folder = path.parent_path() / "played";
  options.read = [&](const std::vector<Override>& more) { return read_scene(path, more); };
  Conversation talk(options, check_answer);
  talk.take(R"({"do": "hello"})");
  for (std::size_t k = 0; k < max_messages && !bytes.empty(); ++k) {
    const std::string_view line = bytes.substr(0, std::min(bytes.find('\n'), max_message));
    bytes.remove_prefix(std::min(line.size() + 1, bytes.size()));
    talk.take(std::string(line));
    talk.advance();
    talk.answer_turns();
    if (const auto frame = talk.frame()) require(frame->size() > 4);
  }
  const Particles& particles = talk.session().simulation().particles();
  for (std::size_t i = 0; i < particles.size(); ++i) require(particles.position(i).allFinite());
  std::filesystem::remove_all(options.folder);
}

}  // namespace sinew::fuzz
