// SPDX-License-Identifier: GPL-3.0-or-later
// Faces on which a pressure acts while their corners follow particles: A n / 3 inward on each
// corner per pascal, with the area and the normal of the moment, and from there by the corner's
// weights on particles. On a closed surface forces and moments so sum to zero, and the work is the
// volume that is lost.
//
//     PressedFaces pressed(faces, corners, particles);
//     if (pressed.find([&](std::size_t k) { return position_of(k); }, true))  // before each step
//       ... pressed.force(k) has changed
//
// A surface turns by little in a step, so its forces are found once for up to max_steps of them,
// where each corner will be in their middle if it moves on as it did: how many is judged by how far
// the last such guess was off. What a body does so depends on its steps and its state alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <sinew/core/parallel.h>
#include <sinew/core/vector.h>
#include <sinew/world/following_points.h>

namespace sinew {

class PressedFaces {
 public:
  /// Steps for which forces may hold.
  static constexpr int max_steps = 16;
  /// So far may sides of faces be from what was expected of them, over their lengths, rms.
  static constexpr double tolerance = 1e-3;
  /// So much they may change meanwhile.
  static constexpr double max_change = 0.02;

  PressedFaces() = default;  ///< none
  /// `faces` of `corners`, which follow `particles` of them.
  PressedFaces(const std::vector<std::array<int, 3>>& faces, const FollowingPoints& corners,
               std::size_t particles);

  bool empty() const { return face_.empty(); }

  /// Finds the forces, where they no longer hold; `position(k)`: of particle k, m. `stepping`: for
  /// a step that follows. Returns whether they may have changed. In parallel; the same bits for any
  /// number of threads.
  template <class Position>
  bool find(const Position& position, bool stepping) {
    if (empty()) return false;
    const bool due = !found_ || (stepping && left_ == 0);
    if (due) {
      on_all(at_.size(), [&](std::size_t k) { at_[k].template head<3>() = position(k) - origin_; });
      move_corners(stepping);
    }
    if (stepping) --left_;
    return due;
  }

  Vec3 force(std::size_t k) const { return forces_[k].head<3>(); }  ///< on particle k, N/Pa
  double size() const;  ///< the lengths of the forces on all corners, N/Pa

  /// Adds what later forces depend on: of the steps, and of each corner its place and motion.
  void save(std::vector<double>& state) const;
  std::size_t saved_size() const { return empty() ? 0 : 3 + 6 * corner_.size(); }
  /// Reads saved_size() numbers, which are finite. Returns whether they can be such.
  bool restore(const double* state);
  void forget();  ///< what was saved and found

 private:
  static constexpr std::size_t per_task = 512;
  using Four = Eigen::Vector4d;  ///< two pairs: x, y, z, 0

  /// Sums over entries of rows: row k has the entries [first[k], first[k + 1]).
  struct Weights {
    std::vector<std::uint32_t> first, source;
    std::vector<double> weight;

    Four sum(std::size_t k, const std::vector<Four>& of) const {
      Four all = Four::Zero();
      for (std::uint32_t e = first[k]; e < first[k + 1]; ++e) all += weight[e] * of[source[e]];
      return all;
    }
  };

  template <class Each>
  static void on_all(std::size_t count, const Each& each) {
    parallel_for(count, per_task, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) each(k);
    });
  }
  void order(const std::vector<std::array<int, 3>>& faces, const FollowingPoints& given);
  void move_corners(bool stepping);
  int planned(const std::vector<Four>& now) const;
  void find_forces();

  Weights of_corners_, of_particles_, of_faces_;  ///< corners from particles, and back; from faces
  std::vector<std::array<std::uint32_t, 3>> face_;
  Vec3 origin_ = Vec3::Zero();         ///< origin of places, m
  std::vector<Four> at_;               ///< particles, m
  std::vector<Four> corner_, motion_;  ///< when forces were found last, m; by step since before, m
  std::vector<Four> area_, pushed_, forces_;
  int steps_ = 0, left_ = 0;  ///< for which the forces hold; that are left of them
  bool found_ = false;        ///< whether there are forces
  bool moving_ = false;       ///< whether they are for a step
};

}  // namespace sinew
