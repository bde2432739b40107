// SPDX-License-Identifier: GPL-3.0-or-later
// What is changed while a body moves, besides its bones: factors of loads and of the friction of
// obstacles, activations of muscles, gravity, and springs that pull at the flesh. They act on the
// body's world and are keys of the recorded settings at once, which give the same values at every
// moment.
//
//     Knobs knobs(scene, recorded, body);
//     knobs.set("tip", 2);
//     knobs.go_to(grid, key, places);                   // before the steps from that key on
//     if (knobs.is_changed()) simulation.set_world(knobs.world());
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/play/recording.h>
#include <sinew/settings/settings.h>
#include <sinew/world/world.h>

namespace sinew {

/// The keys of a scene's loads, muscles and frictions as the session begins: those of the grid.
void begin_keys(Settings& recorded, const KeyGrid& grid);

class Knobs {
 public:
  /// `scene`: with the keys that it has; `recorded`: the same, with those of begin_keys(), which
  /// must outlive this; `body`: in its world.
  Knobs(const Settings& scene, Settings& recorded, const Body& body);

  /// The world they act on; null while there is nothing around the body.
  const std::shared_ptr<World>& world() const { return world_; }
  /// Whether it is another one since this was asked last.
  bool is_changed() { return std::exchange(changed_, false); }

  /// Sets the factor of a load, the activation of a muscle, or the factor on the friction of an
  /// obstacle ("friction of NAME"), by its name. Throws bad input for another name, with those
  /// there are, and a value that is out of range.
  void set(const std::string& name, double value);
  /// Sets the weight of all particles, m/s^2.
  void set_gravity(const Vec3& gravity);

  enum class Kind { load, muscle, friction };
  /// What changes over time, at a time (s); gravity's own loads apart.
  struct Knob {
    std::string name;
    Kind kind = Kind::load;
    double value = 0;
  };
  std::vector<Knob> all(double time) const;
  Vec3 gravity(double time) const;  ///< m/s^2

  /// Pulls at a particle (id) by a spring (N/m) whose free end goes to a place (m). Throws bad
  /// input for a particle that is not there, and a stiffness that is not in (0, max_stiffness()].
  void pull(std::uint32_t particle, const Vec3& to, double stiffness);
  void let_go();
  bool pulls() const { return !pulls_.empty() && !pulls_.back().ends; }
  /// The force of the spring that pulls, N; zero without one. `now`: particles by id, m.
  Vec3 force(double time, const Points& now) const;
  /// The stiffest spring that needs no shorter step, N/m.
  double max_stiffness() const;

  /// Adds the keys at number `key` + 2 of the grid, where the present moment is that of `key`.
  /// `now`: the particles by id, m; asked for where something pulls.
  void go_to(const KeyGrid& grid, std::int64_t key, const std::function<Points()>& now);

  /// What was set, to go back to.
  using Targets = std::vector<std::optional<double>>;
  Targets targets() const;
  /// Goes on from settings that have been cut short, with what was set then.
  void go_back(const Targets& targets);

 private:
  /// A value over time: of a load, a muscle or an obstacle, by its number.
  struct Channel {
    std::string name;
    Kind kind = Kind::load;
    std::size_t index = 0;
    KeyedValue scene = {};              ///< curve of the scene
    std::optional<double> target = {};  ///< value that was set
  };
  struct Pull {
    std::size_t spring = 0;  ///< number of its spring
    std::uint32_t particle = 0;
    Vec3 to = Vec3::Zero();
    bool ends = false;
  };

  const KeyedValue& live(const Channel& channel) const;
  KeyedValue& live(const Channel& channel);
  std::vector<ValueKeySettings>& keys_of(const Channel& channel);
  Load& load_of(const Pull& pull);
  const Load& load_of(const Pull& pull) const;
  World& changed_world();
  Channel& gravity_along(std::size_t axis);
  void add_key(Channel& channel, double before, double at);
  void add_key(const Pull& pull, double before, double at, const Points& now);

  Settings& recorded_;
  Points rest_;
  double radius_, stiffness_;
  Vec3 weight_;  ///< acceleration in the steps themselves, m/s^2
  std::shared_ptr<World> world_;
  std::vector<Channel> channels_;
  std::vector<std::uint32_t> all_;  ///< all particles, and their masses over that of one
  std::vector<double> masses_;
  double mass_;              ///< kg, in all
  std::vector<Pull> pulls_;  ///< pulls that have keys to come
  bool changed_ = false;
};

}  // namespace sinew
