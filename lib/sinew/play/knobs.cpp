// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/play/knobs.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr std::array along = {"gravity_x", "gravity_y", "gravity_z"};
const std::string friction_of = "friction of ";  // before the name of an obstacle

KeyedValue curve_of(const std::vector<ValueKeySettings>& keys) {
  KeyedValue curve;
  for (const ValueKeySettings& key : keys)
    curve.times.push_back(key.time), curve.values.push_back(key.value);
  return curve;
}

void sample_start(std::vector<ValueKeySettings>& keys, const KeyGrid& grid) {
  if (keys.empty()) return;
  const KeyedValue curve = curve_of(keys);
  keys = {{0, curve.at(0)}};
  const double next = curve.at(grid.time(1));
  if (next != keys.front().value) keys.push_back({grid.time(1), next});
}

/// "pull_3", unless a spring has that name.
std::string free_name(const std::vector<SpringSettings>& springs) {
  for (std::size_t number = springs.size() + 1;; ++number) {
    std::string name = "pull_" + std::to_string(number);
    if (std::none_of(springs.begin(), springs.end(),
                     [&](const SpringSettings& one) { return one.name == name; }))
      return name;
  }
}

Vec3 place_of(const Load& spring, const Points& now) {
  Vec3 place = Vec3::Zero();
  for (std::size_t k = 0; k < spring.particles.size(); ++k)
    place += spring.weight[k] * now[spring.particles[k]];
  return place;
}

}  // namespace

void begin_keys(Settings& recorded, const KeyGrid& grid) {
  for (LoadSettings& load : recorded.loads) sample_start(load.keys, grid);
  for (MuscleSettings& muscle : recorded.world.muscles) sample_start(muscle.keys, grid);
  for (ObstacleSettings& one : recorded.world.obstacles) sample_start(one.friction_keys, grid);
}

Knobs::Knobs(const Settings& scene, Settings& recorded, const Body& body)
    : recorded_(recorded),
      rest_(body.rest),
      radius_(body.material.pair.r),
      stiffness_(body.material.stiffness()),
      weight_(scene.solver.gravity),
      all_(body.rest.size()),
      mass_(0) {
  if (body.world) world_ = std::make_shared<World>(*body.world);
  for (std::size_t k = 0; k < scene.loads.size(); ++k)
    channels_.push_back({scene.loads[k].name, Kind::load, k, curve_of(scene.loads[k].keys)});
  for (std::size_t k = 0; k < scene.world.muscles.size(); ++k)
    channels_.push_back(
        {scene.world.muscles[k].name, Kind::muscle, k, curve_of(scene.world.muscles[k].keys)});
  for (std::size_t k = 0; k < scene.world.obstacles.size(); ++k) {
    const ObstacleSettings& one = scene.world.obstacles[k];
    if (one.friction > 0)
      channels_.push_back({friction_of + one.name, Kind::friction, k, curve_of(one.friction_keys)});
  }
  std::iota(all_.begin(), all_.end(), 0u);
  for (const std::uint32_t i : all_) {
    masses_.push_back(mass_of(body, i, 1));
    mass_ += body.material.mass * masses_.back();
  }
}

const KeyedValue& Knobs::live(const Channel& channel) const {
  if (channel.kind == Kind::muscle) return world_->muscles.muscles[channel.index].activation;
  if (channel.kind == Kind::friction) return world_->obstacles[channel.index].friction_scale;
  return world_->loads[channel.index].scale;
}
KeyedValue& Knobs::live(const Channel& channel) {
  return const_cast<KeyedValue&>(std::as_const(*this).live(channel));
}

std::vector<ValueKeySettings>& Knobs::keys_of(const Channel& channel) {
  if (channel.kind == Kind::muscle) return recorded_.world.muscles[channel.index].keys;
  if (channel.kind == Kind::friction) return recorded_.world.obstacles[channel.index].friction_keys;
  return recorded_.loads[channel.index].keys;
}

/// Springs come after the loads, as a scene's do.
const Load& Knobs::load_of(const Pull& pull) const {
  return world_->loads[recorded_.loads.size() + pull.spring];
}
Load& Knobs::load_of(const Pull& pull) {
  return world_->loads[recorded_.loads.size() + pull.spring];
}

World& Knobs::changed_world() {
  world_ = world_ ? std::make_shared<World>(*world_) : std::make_shared<World>();
  changed_ = true;
  return *world_;
}

void Knobs::set(const std::string& name, double value) {
  std::vector<std::string_view> names;
  for (Channel& channel : channels_) {
    names.emplace_back(channel.name);
    if (channel.name != name) continue;
    const bool muscle = channel.kind == Kind::muscle, load = channel.kind == Kind::load;
    if (!is_computable(value) || (!load && value < 0) || (muscle && value > 1))
      throw bad_input(shown(name) + " cannot be " + number_text(value),
                      muscle ? "give an activation from 0 to 1"
                      : load ? "give a finite factor"
                             : "give a finite factor of 0 or more");
    channel.target = value;
    return;
  }
  throw bad_input("there is no load, muscle or friction " + shown(name),
                  names.empty() ? "add one to the scene" : suggestion(name, names));
}

/// The load of a unit of gravity along an axis, whose factor is the change of gravity there.
Knobs::Channel& Knobs::gravity_along(std::size_t axis) {
  for (Channel& channel : channels_)
    if (channel.name == along[axis]) return channel;
  const Vec3 unit = Vec3::Unit(static_cast<int>(axis));
  const std::size_t index = recorded_.loads.size();
  LoadSettings& settings = recorded_.loads.emplace_back();
  settings.name = along[axis];
  settings.gravity = unit;
  settings.keys = {{0, 0}};
  Load load = force_load(along[axis], all_, masses_, mass_ * unit, rest_);
  load.scale = {{0}, {0}};
  std::vector<Load>& loads = changed_world().loads;
  loads.insert(loads.begin() + static_cast<std::ptrdiff_t>(index), std::move(load));
  channels_.push_back({along[axis], Kind::load, index, {{0}, {0}}});
  return channels_.back();
}

void Knobs::set_gravity(const Vec3& gravity) {
  if (!is_computable(gravity))
    throw bad_input("gravity is not finite", "give three numbers, in m/s^2");
  for (std::size_t axis = 0; axis < along.size(); ++axis) {
    const double change = gravity[static_cast<int>(axis)] - weight_[static_cast<int>(axis)];
    const bool known = std::any_of(channels_.begin(), channels_.end(),
                                   [&](const Channel& one) { return one.name == along[axis]; });
    if (change != 0 || known) gravity_along(axis).target = change;
  }
}

std::vector<Knobs::Knob> Knobs::all(double time) const {
  std::vector<Knob> all;
  for (const Channel& channel : channels_)
    if (std::find(along.begin(), along.end(), channel.name) == along.end())
      all.push_back({channel.name, channel.kind, live(channel).at(time)});
  return all;
}

Vec3 Knobs::gravity(double time) const {
  Vec3 sum = weight_;
  for (const Channel& channel : channels_)
    for (std::size_t axis = 0; axis < along.size(); ++axis)
      if (channel.name == along[axis]) sum[static_cast<int>(axis)] += live(channel).at(time);
  return sum;
}

double Knobs::max_stiffness() const { return stiffness_; }

void Knobs::pull(std::uint32_t particle, const Vec3& to, double stiffness) {
  if (particle >= rest_.size())
    throw bad_input("there is no particle " + std::to_string(particle),
                    "give an id from 0 to " + std::to_string(rest_.size() - 1));
  if (!is_computable(to)) throw bad_input("a pull to no place", "give three numbers, in m");
  if (!(stiffness > 0 && stiffness <= max_stiffness()))
    throw bad_input("a spring of " + number_text(stiffness) + " N/m",
                    "give a stiffness above 0, up to " + three_digits(max_stiffness()) + " N/m");
  if (pulls() && pulls_.back().particle == particle) {
    pulls_.back().to = to;
    return;
  }
  let_go();
  SpringSettings spring;
  spring.name = free_name(recorded_.world.springs);
  spring.at = rest_[particle];
  spring.stiffness = stiffness;
  spring.keys = {{0, rest_[particle], 0}};
  Load load = spring_load(spring.name, rest_[particle], stiffness, rest_, radius_);
  load.scale = {{0}, {0}};
  load.free_end = {{0}, {rest_[particle]}};
  changed_world().loads.push_back(std::move(load));
  pulls_.push_back({recorded_.world.springs.size(), particle, to});
  recorded_.world.springs.push_back(std::move(spring));
}

void Knobs::let_go() {
  if (pulls()) pulls_.back().ends = true;
}

Vec3 Knobs::force(double time, const Points& now) const {
  if (!pulls()) return Vec3::Zero();
  const Load& load = load_of(pulls_.back());
  const LoadAt at = load.at(time);
  return at.scale * load.stiffness * (at.free_end - place_of(load, now));
}

/// Where it changes, the value before is kept until the key before.
void Knobs::add_key(Channel& channel, double before, double at) {
  const double value = channel.target.value_or(channel.scene.at(at));
  std::vector<ValueKeySettings>& keys = keys_of(channel);
  KeyedValue& curve = live(channel);
  const double last = keys.empty() ? 1 : keys.back().value;
  if (value == last) return;
  const auto add = [&](double time, double one) {
    keys.push_back({time, one});
    curve.times.push_back(time), curve.values.push_back(one);
  };
  if (keys.empty() || keys.back().time < before) add(before, last);
  add(at, value);
}

/// A free end that is far pulls no more than one that is near enough not to tear the flesh.
void Knobs::add_key(const Pull& pull, double before, double at, const Points& now) {
  constexpr double max_force = 5;  // times the stiffness between two particles and their radius
  Load& load = load_of(pull);
  std::vector<SpringKeySettings>& keys = recorded_.world.springs[pull.spring].keys;
  const auto add = [&](double time, const Vec3& to, double factor) {
    keys.push_back({time, to, factor});
    load.scale.times.push_back(time), load.scale.values.push_back(factor);
    load.free_end.times.push_back(time), load.free_end.places.push_back(to);
  };
  const Vec3 place = place_of(load, now), offset = pull.to - place;
  const double longest = max_force * stiffness_ * radius_ / load.stiffness;
  const Vec3 to = place + std::min(1.0, longest / std::max(offset.norm(), 1e-300)) * offset;
  const bool begins = keys.back().factor == 0;
  if (keys.back().time < before) add(before, begins ? place : keys.back().to, keys.back().factor);
  add(at, pull.ends ? keys.back().to : to, pull.ends ? 0 : 1);
}

void Knobs::go_to(const KeyGrid& grid, std::int64_t key, const std::function<Points()>& now) {
  const double before = grid.time(key + 1), at = grid.time(key + 2);
  for (Channel& channel : channels_) add_key(channel, before, at);
  if (pulls_.empty()) return;
  const Points places = now();
  for (const Pull& pull : pulls_) add_key(pull, before, at, places);
  std::erase_if(pulls_, [](const Pull& pull) { return pull.ends; });
}

Knobs::Targets Knobs::targets() const {
  Targets targets;
  for (const Channel& channel : channels_) targets.push_back(channel.target);
  return targets;
}

void Knobs::go_back(const Targets& targets) {
  for (std::size_t k = 0; k < channels_.size(); ++k) {
    Channel& channel = channels_[k];
    channel.target = k < targets.size() ? targets[k] : std::nullopt;
    live(channel) = curve_of(keys_of(channel));
  }
  pulls_.clear();
  for (std::size_t s = 0; s < recorded_.world.springs.size(); ++s) {
    const Pull pull{s, 0, Vec3::Zero(), true};
    if (recorded_.world.springs[s].keys.back().factor > 0) pulls_.push_back(pull);
    Load& load = load_of(pull);
    load.scale = {}, load.free_end = {};
    for (const SpringKeySettings& key : recorded_.world.springs[s].keys) {
      load.scale.times.push_back(key.time), load.scale.values.push_back(key.factor);
      load.free_end.times.push_back(key.time), load.free_end.places.push_back(key.to);
    }
  }
}

}  // namespace sinew
