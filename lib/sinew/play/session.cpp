// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/play/session.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/hash.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr double moments_per_second = 4, longest_past = 20;  // s
constexpr std::size_t particles_at_this_rate = 250'000;      // memory: 1 GB of them in all

void refuse(const Settings& scene, const char* key, const std::string& what,
            const std::string& cure) {
  throw bad_input(scene.place(key), what + " cannot be played", cure);
}

void check_playable(const Settings& scene) {
  if (scene.solver.method == Method::static_equilibrium)
    refuse(scene, "solver.method", "a scene of the static method",
           "set solver.method to dynamic, or run it with sinew run");
  if (scene.hierarchy.enabled)
    refuse(scene, "hierarchy.enabled", "a scene with groups of particles",
           "set hierarchy.enabled to false");
}

/// The largest distance of any particle that a bone carries, itself or by those below, from its
/// head, m.
double reach_of(const Body& body) {
  double reach = 0;
  for (std::size_t i = 0; i < body.rest.size(); ++i)
    for (int bone = body.binding.bone(i); bone != no_bone;
         bone = body.skeleton.bones[static_cast<std::size_t>(bone)].parent)
      reach = std::max(
          reach,
          (body.rest[i] - body.skeleton.bones[static_cast<std::size_t>(bone)].head()).norm());
  return reach;
}

HandSpeed speed_for(const Body& body) {
  HandSpeed speed;
  speed.shift = bounds(body.rest).diagonal().norm();
  return speed;
}

/// A step in which neither the clip nor the fastest that a hand may do carries a particle too far.
/// Hands reach their speed smoothly, and bones share it: flesh follows them in longer steps than a
/// clip, which may jump.
double max_step(const Prepared& prepared, const HandSpeed& hand) {
  constexpr double carried_by_hand = 0.5;  // radii
  double of_clip = 0;
  for (const double speed : prepared.bone_speeds) of_clip = std::max(of_clip, speed);
  const double of_hand = std::max(hand.turn * reach_of(prepared.body), hand.shift);
  return std::min(
      prepared.steps.step,
      prepared.body.material.pair.r / std::max(of_clip / max_carried, of_hand / carried_by_hand));
}

/// The scene with what follows from its motion in numbers, and without that motion.
Settings still_scene(const Prepared& prepared) {
  Settings scene = prepared.settings;
  scene.tracks.clear();
  const std::string clip = scene.skeleton.rest_at ? scene.motion.clip : "";
  scene.motion = {};
  scene.motion.clip = clip;
  const Body& body = prepared.body;
  if (body.material.bond.creep_rate > 0) scene.material.creep_rate = body.material.bond.creep_rate;
  scene.contact.pass_through = {};
  for (const Intrusion& one : prepared.passing)
    scene.contact.pass_through.pairs.push_back(
        {body.skeleton.bones[static_cast<std::size_t>(one.bones[0])].name,
         body.skeleton.bones[static_cast<std::size_t>(one.bones[1])].name});
  scene.solver.wall_time = {};
  return scene;
}

void check_step(const Settings& scene, double step) {
  constexpr double shortest = 1e-7;  // s: no body of any size plays in such steps
  if (!(step > shortest))
    refuse(scene, "solver", "steps of " + three_digits(step) + " s",
           "give a longer time_step, a softer material or larger particles");
}

bool twists(const Motion& motion) {
  return std::any_of(motion.tracks.begin(), motion.tracks.end(), [](const Track& track) {
    return std::any_of(track.twist.values.begin(), track.twist.values.end(),
                       [](double value) { return value != 0; });
  });
}

bool is_rest(const BoneKeys& keys) {
  return std::all_of(keys.begin(), keys.end(), [](const LocalMotion& key) {
    return key.rotation.isApprox(Quat::Identity(), 0) && key.translation.isZero(0) &&
           key.twist == 0;
  });
}

}  // namespace

Session::Session(const Settings& scene, SessionOptions options) : options_(std::move(options)) {
  check_playable(scene);
  Prepared first = prepare({scene});
  if (stretches(first.motion))
    refuse(scene, "motion", "a clip that stretches bones", "remove stretch from its keys");
  skeleton_ = first.body.skeleton;
  clip_ = first.motion;
  const HandSpeed speed = speed_for(first.body);
  check_step(scene, max_step(first, speed));
  hand_.emplace(skeleton_, speed);
  recording_.emplace(still_scene(first), skeleton_, key_grid(max_step(first, speed)),
                     twists(first.motion));
  const BoneKeys start = options_.pose ? *options_.pose : clip_at(0);
  if (options_.pose) hand_->hold(start);
  const bool posed = options_.pose.has_value() || first.beginning.posed;
  recording_->scene().motion.begin = posed && !is_rest(start) ? Begin::pose : Begin::rest;
  recording_->add(0, start);
  recording_->add(1, options_.pose ? start : clip_at(1));
  begin_keys(recording_->scene(), grid());
  create_folder(options_.folder);
  recording_->keep(options_.folder, options_.name, 0);

  const std::filesystem::path table = options_.folder / (options_.name + ".keys.csv");
  Prepared prepared = prepare({.settings = recording_->settings_until(1, table),
                               .filled = std::move(first.filled),
                               .modes = std::move(first.modes)});
  surface_ = prepared.surface;
  obstacles_ = prepared.obstacles;
  meter_.emplace(prepared.body, surface_.triangles, prepared.body.neighbors);
  knobs_.emplace(first.settings, recording_->scene(), prepared.body);
  prepared.body.world = knobs_->world();
  per_moment_ = std::llround(1 / (moments_per_second * grid().interval())) *
                static_cast<std::int64_t>(1 + prepared.body.rest.size() / particles_at_this_rate);
  simulation_.emplace(sinew::start(std::move(prepared)));
  simulation_->play(recording_->motion_now());
  remember();
}

std::string Session::hash() const { return hash_text(state_hash(simulation_->particles())); }

Triangles Session::obstacles() const {
  Triangles all;
  for (std::size_t k = 0; k < obstacles_.size(); ++k) {
    const ObstaclePose now = knobs_->world()->obstacles[k].at(time(), simulation_->pose());
    const int first = static_cast<int>(all.points.size());
    for (const Vec3& point : obstacles_[k].points)
      all.points.push_back(now.frame.origin + now.frame.rotation * point);
    for (const auto& [a, b, c] : obstacles_[k].faces)
      all.faces.push_back({a + first, b + first, c + first});
  }
  return all;
}

BoneKeys Session::clip_at(std::int64_t key) const {
  return local_motions(skeleton_, clip_, grid().time(key));
}

const BoneKeys& Session::ahead() const {
  return is_past() ? past_[shown_].keys.back() : recording_->at(key_ + 1);
}

const BoneKeys& Session::present() const {
  return is_past() ? past_[shown_].keys.front() : recording_->at(key_);
}

/// Goes on from the past: what came after is forgotten.
void Session::settle() {
  if (!is_past()) return;
  const Moment& moment = past_[shown_];
  recording_->truncate(moment.key + 1, moment.keys);
  knobs_->go_back(moment.targets);
  past_.erase(past_.begin() + static_cast<std::ptrdiff_t>(shown_) + 1, past_.end());
  shown_ = past_.size();
}

void Session::advance() {
  settle();
  BoneKeys next = hand_->next(ahead(), grid().interval());
  const BoneKeys clip = clip_at(key_ + 2);
  for (std::size_t b = 0; b < next.size(); ++b)
    if (!hand_->has(static_cast<int>(b))) next[b] = clip[b];
  recording_->add(key_ + 2, next);
  knobs_->go_to(grid(), key_, [this] { return positions_by_id(simulation_->particles()); });
  if (knobs_->is_changed()) simulation_->set_world(knobs_->world());
  simulation_->play(recording_->motion_now());
  try {
    simulation_->advance(grid().steps);
  } catch (const Error& error) {
    if (error.exit() != Exit::unstable) throw;
    show(past_.size() - 1);
    settle();
    throw;
  }
  ++key_;
  if (key_ % per_moment_ == 0) remember();
}

void Session::remember() {
  past_.push_back({key_,
                   simulation_->save(),
                   *hand_,
                   knobs_->targets(),
                   {recording_->at(key_), recording_->at(key_ + 1)}});
  const auto first = key_ - std::llround(longest_past / grid().interval());
  while (past_.size() > 2 && past_[1].key < first) past_.erase(past_.begin() + 1);
  shown_ = past_.size();
}

double Session::earliest() const {
  const bool whole = past_.size() < 2 || past_[1].key - past_[0].key <= per_moment_;
  return grid().time(past_[whole ? 0 : 1].key);
}

double Session::latest() const { return grid().time(std::max(key_, past_.back().key)); }

void Session::show(std::size_t moment) {
  const Moment& then = past_[moment];
  shown_ = moment;
  key_ = then.key;
  *hand_ = then.hand;
  simulation_->play(recording_->motion_of(key_, then.keys));
  simulation_->restore(then.state);
}

void Session::go_to(double time) {
  if (!is_past() && past_.back().key != key_) remember();
  std::size_t nearest = 0;
  for (std::size_t k = 0; k < past_.size(); ++k)
    if (std::abs(grid().time(past_[k].key) - time) <
        std::abs(grid().time(past_[nearest].key) - time))
      nearest = k;
  show(nearest);
}

std::filesystem::path Session::save(const std::string& name) const {
  constexpr std::string_view permitted =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  if (name.empty() || name.size() > 100 || name.front() == '-' ||
      name.find_first_not_of(permitted) != name.npos)
    throw bad_input(shown(name) + " is no name for a recording",
                    "give up to 100 letters, digits, - and _");
  std::filesystem::path path = options_.folder / (name + ".yaml");
  const bool is_recording = std::filesystem::exists(options_.folder / (name + ".keys.csv"));
  if (name == options_.name || (std::filesystem::exists(path) && !is_recording))
    throw bad_input(Place{path.string()}, "is there already, and no saved recording",
                    "give another name");
  if (key_ == 0) throw bad_input("nothing has been recorded", "play first");
  recording_->write(options_.folder, name, key_);
  return path;
}

}  // namespace sinew
