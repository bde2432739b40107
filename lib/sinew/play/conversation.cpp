// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/play/conversation.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/json.h>
#include <sinew/core/text.h>
#include <sinew/play/live_view.h>

namespace sinew {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

double seconds(Clock::duration time) { return std::chrono::duration<double>(time).count(); }

Vec3 vector_of(const Json& value) {
  if (!value.is_array() || value.size() != 3)
    throw bad_input("a place is no list of three numbers", "give [x, y, z]");
  return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

Json json_of(const Vec3& vector) { return {vector.x(), vector.y(), vector.z()}; }

/// A value, or what a text says in JSON: "[0, 0, -9.81]".
Json parsed(const Json& value) {
  return value.is_string() ? parsed_json<Json>(value.get<std::string>()) : value;
}

/// A setting that pages may change: of numbers and words, none of which names a file.
Override applicable(const std::string& key, const Json& value) {
  constexpr std::array<std::string_view, 4> sections = {"material.", "materials[", "binding.",
                                                        "solver."};
  const bool known = std::any_of(sections.begin(), sections.end(), [&](std::string_view section) {
    return key.substr(0, section.size()) == section;
  });
  if (!known || key.ends_with(".mesh"))
    throw bad_input(shown(key) + " cannot be changed here",
                    "change settings of material, binding and solver, loads or muscles by name; "
                    "others in the scene");
  return parse_override(key + '=' +
                        (value.is_string() ? value.get<std::string>() : json_text(value)));
}

/// "session", or "session_2" and so on where that is there.
std::string free_name(const std::filesystem::path& folder) {
  std::string name = "session";
  for (int number = 2; std::filesystem::exists(folder / (name + ".keys.csv")); ++number)
    name = "session_" + std::to_string(number);
  return name;
}

}  // namespace

struct Conversation::Impl {
  Impl(const PlayOptions& options, std::function<void(const std::string&)> send)
      : options_(options), send_(std::move(send)) {
    begin({});
  }

  struct Turn {
    Json id;
    int bone = 0;
    std::int64_t from = 0;  ///< key at which it was asked for
    Clock::time_point end;
  };

  void begin(std::optional<BoneKeys> pose) {
    session_ = std::make_unique<Session>(
        options_.read(applied_),
        SessionOptions{options_.folder, free_name(options_.folder), std::move(pose)});
    view_ = std::make_unique<LiveView>(*session_);
    turns_.clear();
    changed_ = true;
    restart_clock();
  }

  // Time.

  void restart_clock() {
    began_ = measured_from_ = Clock::now();
    began_at_ = measured_at_ = session_->time();
  }
  double due() const { return began_at_ + pace_ * seconds(Clock::now() - began_); }
  bool is_due() const {
    return steps_ > 0 || (playing_ && session_->time() + session_->grid().interval() <= due());
  }
  Clock::duration until_due(bool wanted) const {
    constexpr double longest = 0.05;  // s; frames are asked for meanwhile
    double wait = longest;
    if (playing_)
      wait = std::clamp((session_->time() + session_->grid().interval() - due()) / pace_, 0.0,
                        longest);
    if (wanted && changed_) wait = 0;
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(wait));
  }

  void advance() {
    constexpr double max_behind = 0.1;  // s; a body that is too slow does not catch up
    try {
      session_->advance();
    } catch (const Error& error) {
      if (error.exit() != Exit::unstable) throw;
      playing_ = false;
      say("problem", std::string(error.what()) + "; it is as it was at " +
                         three_digits(session_->time()) + " s");
    }
    if (steps_ > 0) --steps_;
    changed_ = true;
    if (due() - session_->time() > max_behind) {
      began_ = Clock::now();
      began_at_ = session_->time();
    }
    const double passed = seconds(Clock::now() - measured_from_);
    if (passed < 1) return;
    real_time_ = (session_->time() - measured_at_) / passed;
    measured_from_ = Clock::now();
    measured_at_ = session_->time();
  }

  // Messages to the page.

  void say(const char* what, const std::string& text) {
    send_(json_text(Json{{what, text}}));
    if (options_.message) options_.message(text);
  }
  void reply(const Json& id, Json answer) {
    answer["id"] = id;
    send_(json_text(answer));
  }

  std::optional<std::string> frame() {
    if (!changed_) return std::nullopt;
    view_->wish.exact = !playing_;
    changed_ = false;
    return view_->frame(*session_, header());
  }

  Json header() {
    constexpr double between_measures = 0.5;  // s
    Json header = {{"time", session_->time()},         {"hash", session_->hash()},
                   {"real_time", real_time_},          {"playing", playing_},
                   {"earliest", session_->earliest()}, {"latest", session_->latest()}};
    if (seconds(Clock::now() - last_measure_) > between_measures) {
      const LiveView::Volumes volumes = LiveView::volumes(*session_);
      const Energies energies = session_->simulation().energies();
      measures_ = {{"J_min", volumes.J_min},
                   {"inverted", volumes.inverted},
                   {"kinetic", energies.kinetic},
                   {"stored", energies.stored() - energies.kinetic}};
      last_measure_ = Clock::now();
    }
    header.update(measures_);
    if (grabbed_ >= 0) {
      const Reaction on =
          session_->simulation().reactions_of_bones().sums()[static_cast<std::size_t>(grabbed_)];
      header["reaction"] = {{"force", on.force.norm()}, {"moment", on.moment.norm()}};
    }
    if (session_->knobs_now().pulls())
      header["pull"] = json_of(session_->knobs_now().force(
          session_->time(), positions_by_id(session_->simulation().particles())));
    return header;
  }

  void answer_turns() {
    std::erase_if(turns_, [&](const Turn& turn) {
      const bool there = session_->key() > turn.from + 1 &&
                         session_->hand_now().is_there(turn.bone, session_->present());
      if (!there && Clock::now() < turn.end) return false;
      if (there)
        reply(turn.id, {{"done", true}});
      else
        reply(turn.id, {{"failed", "the bone was not there within 60 s"}});
      return true;
    });
  }

  void keep(bool now) {
    if (!now && seconds(Clock::now() - last_kept_) < std::max(1.0, 20 * cost_of_keeping_)) return;
    if (kept_key_ == session_->key()) return;
    const Clock::time_point from = Clock::now();
    try {
      session_->keep();
      kept_key_ = session_->key();
      is_told_ = false;
    } catch (const Error& error) {  // it is in memory still, and tried again
      if (now) throw;
      if (!std::exchange(is_told_, true)) say("problem", error.what());
    }
    last_kept_ = Clock::now();
    cost_of_keeping_ = seconds(last_kept_ - from);
  }

  // Messages of the page.

  void take(const std::string& message) {
    Json id;
    try {
      const auto json = parsed_json<Json>(message);
      if (!json.is_object()) throw bad_input("a message that is no object", "write {\"do\": ...}");
      id = json.value("id", Json());
      act(json.value("do", ""), json, id);
    } catch (const Error& error) {
      if (error.exit() == Exit::not_written && options_.message) options_.message(error.what());
      reply(id, {{"failed", error.what()}});
    } catch (const Json::exception&) {
      reply(id, {{"failed", "a message with a value of another kind"}});
    }
  }

  int bone_of(const Json& json) const {
    const Json& bone = json.at("bone");
    const Skeleton& skeleton = session_->skeleton();
    if (bone.is_string()) return bone_named(skeleton, bone.get<std::string>(), "bone");
    const double number = bone.get<double>();
    if (!(number >= 0 && number < static_cast<double>(skeleton.size())))
      throw bad_input("there is no bone " + json_text(bone),
                      "give its name, or a number below " + std::to_string(skeleton.size()));
    return static_cast<int>(number);
  }

  void act(const std::string& what, const Json& json, const Json& id) {
    if (what == "hello") return hello();
    if (what == "show") return look(json);
    changed_ = true;
    if (what == "aim" || what == "reach" || what == "move") return drag(what, json);
    if (what == "turn") return turn(json, id);
    if (what == "grab") return grab(json);
    if (what == "release") return void(grabbed_ = -1);
    if (what == "undo") return void(session_->hand().undo());
    if (what == "pull") return pull(json, id);
    if (what == "set") return set(json, id);
    if (what == "play" || what == "pause") return play_or_pause(what == "play");
    if (what == "step") return void((playing_ = false, steps_ = 1));
    if (what == "pace") return pace(json.at("value").get<double>());
    if (what == "seek") return seek(json.at("time").get<double>());
    if (what == "rewind") return rewind(json.at("seconds").get<double>(), id);
    if (what == "reset") return seek(0);
    if (what == "save") return save(json.at("name").get<std::string>(), id);
    throw bad_input("there is no action " + shown(what), "use the page of this version");
  }

  void hello() {
    if (std::exchange(is_new_, false)) play_or_pause(true);
    grabbed_ = -1;
    send_(view_->scene_text(*session_));
    changed_ = true;
  }

  void look(const Json& json) {
    LiveWish wish = view_->wish;
    wish.particles = json.value("particles", wish.particles);
    wish.skin = json.value("skin", wish.skin);
    wish.holds_range = json.value("holds_range", wish.holds_range);
    const auto field = json.value("field", wish.field);
    const auto known = live_fields();
    if (field.empty() || std::any_of(known.begin(), known.end(),
                                     [&](const LiveField& one) { return one.name == field; }))
      wish.field = field;
    view_->wish = wish;
    changed_ = true;
  }

  void grab(const Json& json) {
    session_->hand().grab();
    if (json.contains("bone")) grabbed_ = bone_of(json);
  }

  void drag(const std::string& what, const Json& json) {
    const Vec3 to = vector_of(json.at("to"));
    const int bone = bone_of(json);
    Hand& hand = session_->hand();
    if (what == "aim") hand.aim(bone, to, session_->ahead());
    if (what == "reach") hand.reach(bone, to, session_->ahead());
    if (what == "move") hand.move(bone, to, session_->ahead());
  }

  void turn(const Json& json, const Json& id) {
    const int bone = bone_of(json);
    Hand& hand = session_->hand();
    hand.grab();
    hand.turn(bone, vector_of(json.at("axis")), radians(json.at("degrees").get<double>()),
              session_->ahead());
    turns_.push_back({id, bone, session_->key(), Clock::now() + std::chrono::seconds(60)});
  }

  void pull(const Json& json, const Json& id) {
    if (!json.contains("to") || json["to"].is_null()) {
      session_->knobs().let_go();
    } else {
      const double particle = json.at("particle").get<double>();
      if (!(particle >= 0 && particle < static_cast<double>(session_->meter().rest().particles())))
        throw bad_input("there is no particle " + json_text(json["particle"]), "give an id");
      const auto i = static_cast<std::uint32_t>(particle);
      const Vec3 from = json.value("relative", false)
                            ? positions_by_id(session_->simulation().particles())[i]
                            : Vec3(Vec3::Zero());
      Knobs& knobs = session_->knobs();
      knobs.pull(i, from + vector_of(json["to"]),
                 json.value("stiffness", knobs.max_stiffness() / 4));
    }
    if (!id.is_null()) reply(id, {{"done", true}});
  }

  /// Loads, muscles and gravity at once; other settings begin anew in the pose of now.
  void set(const Json& json, const Json& id) {
    const Json settings = json.contains("settings")
                              ? json["settings"]
                              : Json{{json.at("key").get<std::string>(), json.at("value")}};
    std::vector<Override> more;
    for (const auto& [key, value] : settings.items()) {
      if (key == "solver.gravity")
        session_->knobs().set_gravity(vector_of(parsed(value)));
      else if (key.find('.') == key.npos)
        session_->knobs().set(key, parsed(value).get<double>());
      else
        more.push_back(applicable(key, value));
    }
    if (!more.empty()) apply(more);
    reply(id, {{"done", true}, {"began_anew", !more.empty()}});
  }

  void apply(const std::vector<Override>& more) {
    const std::vector<Override> before = applied_;
    applied_.insert(applied_.end(), more.begin(), more.end());
    try {
      keep(true);
      begin(session_->ahead());
    } catch (const Error&) {
      applied_ = before;
      throw;
    }
    kept_key_ = -1;
    hello();
  }

  void play_or_pause(bool plays) {
    playing_ = plays;
    restart_clock();
  }

  void pace(double value) {
    if (!(value > 0 && value <= 1))
      throw bad_input("a pace of " + number_text(value), "give one up to 1");
    pace_ = value;
    restart_clock();
  }

  /// To look at the past.
  void seek(double time) {
    playing_ = false;
    turns_.clear();
    session_->go_to(time);
    kept_key_ = -1;
  }

  /// To go on from it, if it goes on.
  void rewind(double seconds, const Json& id) {
    const bool played = playing_;
    seek(session_->time() - seconds);
    play_or_pause(played);
    reply(id, {{"done", true}, {"time", session_->time()}});
  }

  void save(const std::string& name, const Json& id) {
    playing_ = false;
    const std::filesystem::path path = session_->save(name);
    if (options_.message) options_.message("saved " + path.string());
    reply(id, {{"done", true},
               {"path", path.string()},
               {"time", session_->time()},
               {"hash", session_->hash()}});
  }

  const PlayOptions& options_;
  std::function<void(const std::string&)> send_;
  std::vector<Override> applied_;
  std::unique_ptr<Session> session_;
  std::unique_ptr<LiveView> view_;
  std::vector<Turn> turns_;

  bool playing_ = false, changed_ = true, is_new_ = true;  ///< is_new_: no page has come yet
  int steps_ = 0, grabbed_ = -1;
  double pace_ = 1, real_time_ = 0;
  double began_at_ = 0, measured_at_ = 0;  ///< s of the scene
  Clock::time_point began_, measured_from_, last_measure_, last_kept_;
  Json measures_ = Json::object();
  std::int64_t kept_key_ = -1;
  double cost_of_keeping_ = 0;  ///< s
  bool is_told_ = false;        ///< whether the page knows that the disk takes nothing
};

Conversation::Conversation(const PlayOptions& options,
                           std::function<void(const std::string& text)> send)
    : its_(std::make_unique<Impl>(options, std::move(send))) {}
Conversation::~Conversation() = default;

void Conversation::take(const std::string& message) { its_->take(message); }
bool Conversation::is_due() const { return its_->is_due(); }
void Conversation::advance() { its_->advance(); }
std::chrono::steady_clock::duration Conversation::until_due(bool wanted) const {
  return its_->until_due(wanted);
}
void Conversation::answer_turns() { its_->answer_turns(); }
std::optional<std::string> Conversation::frame() { return its_->frame(); }
void Conversation::keep(bool now) { its_->keep(now); }
Session& Conversation::session() { return *its_->session_; }

}  // namespace sinew
