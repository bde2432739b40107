// SPDX-License-Identifier: GPL-3.0-or-later
// What surrounds a body, for the list stepper: obstacles, drag, fields, pins, supports, and the
// friction of the body on itself, evaluated in double precision for the blocks of particles that
// they may touch; loads, as accelerations that the kernel adds. world/world.h gives the forces.
//
//     surroundings.begin(pose, time, state, units, lists, nullptr);  // before a step
//     surroundings.run(work.step[damping], step, begin, end);  // on pieces, in parallel
//     const WorldSums sums = surroundings.sums();                    // after it
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/body/forces.h>
#include <sinew/body/step_plan.h>
#include <sinew/kernel/kernel.h>
#include <sinew/lists/block_state.h>
#include <sinew/lists/load_lists.h>
#include <sinew/lists/verlet_lists.h>
#include <sinew/world/sliding_contacts.h>
#include <sinew/world/world.h>

namespace sinew {

/// Contributions to the ledger, W and J.
struct WorldSums {
  double power = 0;  ///< power of obstacles, fields and pins
  double lost = 0;
  double contact_energy = 0, held_kinetic = 0;
  /// The lengths of forces on particles but those of supports and loads, half of those of pins, N.
  double applied = 0;
};

template <class Real>
class Surroundings {
 public:
  /// For particles of `mass` (kg), and steps as given; `kept`: bytes that the kernel keeps.
  Surroundings(std::shared_ptr<const Body> body, const Stepping& stepping, double mass,
               std::size_t kept);

  /// Whether there is anything but muscles: forces of the world.
  bool any() const { return any_; }
  /// The particles `id` in the kernel's order.
  void set_order(std::span<const std::int32_t> id);

  /// Moves what pins hold exactly to its place: no error accumulates over steps. Adds to `moved`,
  /// by piece, how far (m).
  void hold(const Pose& pose, double time, BlockState<Real>& state, const Units& units,
            std::vector<double>& moved) const;
  /// Finds which blocks may be touched at this moment. `forces`: where the forces of the world are
  /// to be stored, in the kernel's order (N), or null.
  void begin(const Pose& pose, double time, BlockState<Real>& state, const Units& units,
             const VerletLists<Real>& lists, Points* forces);
  /// Steps or probes the pieces, and acts where they are touched.
  void run(kernel::Work<Real> work, const kernel::Step<Real>& step, std::size_t begin,
           std::size_t end);
  kernel::Loads<Real> loads() const { return loads_.arrays(); }

  /// Throws Error (unstable), which names the obstacle, where one pressed a group of particles in
  /// the last step: groups do not yield there.
  void refuse_contact_of_groups() const;

  void set_step(double step);  ///< s

  void save(SimulationState& state) const {
    sliding_.save(state);
    loads_.save(state);
  }
  void restore(const SimulationState& state) {
    sliding_.restore(state);
    loads_.restore(state);
  }

  /// Sums up the last step or probe, in the order of the pieces.
  WorldSums sums() const;
  /// The lengths of the forces of loads at present, N.
  double loaded() const { return loads_.sizes(); }
  std::vector<Reaction> reactions() const;          ///< reactions of obstacles
  std::vector<Reaction> reactions_of_pins() const;  ///< on each bone; none where no pin is on one
  std::vector<Reaction> support_reactions() const;  ///< on the body, of each
  std::vector<Reaction> load_reactions() const;     ///< reactions of the last probe
  bool is_held(std::size_t k) const { return !pin_.empty() && pin_[k] != no_pin; }

 private:
  static constexpr std::uint32_t no_pin = UINT32_MAX;
  static constexpr std::size_t none = SIZE_MAX;
  struct Piece {
    WorldSums sums;
    std::vector<Reaction> reactions;  ///< reactions of obstacles
    std::vector<Reaction> of_pins;    ///< on bones
    std::vector<Reaction> support_reactions, load_reactions;
    std::size_t on_group = none;  ///< the first obstacle that pressed a particle of a group
  };

  struct Rows;

  static bool acts_on(const kernel::Step<Real>& step, std::size_t block);
  void act(const kernel::Step<Real>& step, std::size_t piece, Rows& rows);
  void act_on(std::size_t k, Vec3& acceleration, Real& held);
  double mass_at(std::size_t k) const {
    return mass_of(*body_, static_cast<std::size_t>(id_[k]), mass_);
  }
  std::size_t presses_group(const ParticleState& particle) const;
  void set_pins(std::span<const std::int32_t> id);
  Vec3 friction_on(std::size_t k, const Vec3& position, const Vec3& velocity);
  bool has_contacts(std::size_t block) const;
  void answer_of_pins(std::size_t k, const PinPose& at, const Vec3& unheld, const Vec3& middle,
                      Piece& piece) const;
  std::vector<Reaction> sums_of(std::vector<Reaction> Piece::*part, std::size_t count) const;
  bool may_touch(const Box& box) const;
  void find_touched(std::size_t piece, const Box& box);
  Box box_of(std::size_t first, std::size_t last) const;

  std::shared_ptr<const Body> body_;
  std::shared_ptr<const World> world_;  ///< the body's, or an empty one
  Stepping stepping_;
  double mass_;
  std::size_t kept_;
  bool any_, everywhere_;
  bool acts_in_space_;  ///< there is more than pins, supports, loads and muscles
  bool pins_on_bones_;
  std::vector<std::int32_t> id_;    ///< in the kernel's order; empty without surroundings
  std::vector<std::uint32_t> pin_;  ///< pin by particle in the kernel's order; empty without pins
  std::vector<std::uint32_t> pinned_;  ///< particles that are held, ascending
  std::vector<std::size_t> first_;     ///< first of them in a piece; one longer than the pieces
  std::vector<std::uint8_t> touched_;  ///< one per block
  std::vector<std::uint8_t> held_;     ///< one per block: whether it has pins
  LoadLists<Real> loads_;
  std::vector<Piece> pieces_;
  SlidingContacts sliding_;

  // Values of the moment:
  WorldNow now_;
  BlockState<Real>* state_ = nullptr;
  const Pose* pose_ = nullptr;
  const kernel::Lists* lists_ = nullptr;
  Units units_;
  double until_middle_ = 0;  ///< time until the middle of the step, s
  Points* forces_ = nullptr;
};

}  // namespace sinew
