// SPDX-License-Identifier: GPL-3.0-or-later
// Forces that a testing machine puts on parts of a body: a force, a traction or a weight, which
// keep their direction, a pressure, which follows the surface, and a spring, which pulls a point of
// the body to a place.
//
//     LoadNow now(load);
//     now.find(load.at(time), [&](std::size_t k) { return position_of(k); }, true);
//     force += now.force(k);   // on particle load.particles[k]
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <sinew/core/simulation_state.h>
#include <sinew/core/triangles.h>
#include <sinew/world/following_points.h>
#include <sinew/world/pressed_faces.h>
#include <sinew/world/region.h>

namespace sinew {

/// A load at one moment.
struct LoadAt {
  double scale = 1;
  Vec3 free_end = Vec3::Zero();  ///< m

  bool operator==(const LoadAt&) const = default;
};

struct Load {
  std::string name;
  KeyedValue scale;                            ///< over time; 1 without keys
  std::vector<std::uint32_t> particles;        ///< particles on which it acts, by id, ascending
  std::vector<double> weight;                  ///< weight of each of them in `force`; sums to 1
  Vec3 force = Vec3::Zero();                   ///< the sum, N
  double pressure = 0;                         ///< Pa, in addition
  std::vector<std::array<int, 3>> faces = {};  ///< faces of `corners` on which it acts
  FollowingPoints corners = {};                ///< corners from places in `particles`
  Vec3 pivot = Vec3::Zero();                   ///< pivot of its moment, m
  double stiffness = 0;                        ///< stiffness of a spring, N/m
  KeyedPlace free_end = {};                    ///< free end of the spring over time

  LoadAt at(double time) const { return {scale.at(time), free_end.at(time)}; }
};

/// A force (N) distributed over particles as listed, with the same number more than once if need
/// be: weights are summed and made to sum to 1. Its pivot is the mean of `rest` (m) by weights.
/// Throws bad input, which names it, for no particles and weights that cancel.
Load force_load(const std::string& name, const std::vector<std::uint32_t>& particles,
                const std::vector<double>& weights, const Vec3& force, const Points& rest);

/// A spring of that stiffness (N/m) on the point of the body that was at `point` at `rest` (m),
/// which follows the particles near it, or on one `particle` alone. Without keys its free end is
/// the origin. Throws bad input as force_load() does.
Load spring_load(const std::string& name, const Vec3& point, double stiffness, const Points& rest,
                 double radius);
Load spring_load(const std::string& name, std::uint32_t particle, double stiffness,
                 const Points& rest);

/// Number of particles that each corner of a pressure follows: of two layers, at least.
inline constexpr std::size_t followed_by_corners = 12;

/// No side of a pressed face need be shorter, in radii: each corner pushes as many particles of the
/// outermost layer as there are for each corner; with 3 the stress at the surface is as even.
inline constexpr double longest_pressed_side = 4;

/// A pressure (Pa) on all faces of a surface whose points follow the particles at `rest` with
/// `radius` (m); its weights are those of the area. Throws bad input for no faces.
Load pressure_load(const std::string& name, const Triangles& surface, double pressure,
                   const Points& rest, double radius);

/// The area of the faces around each point, as a force on it that is distributed by area:
/// (particle, weight) pairs for force_load(), of points that follow the particles at `rest`.
struct AreaWeights {
  std::vector<std::uint32_t> particles;
  std::vector<double> weights;  ///< m^2
  double area = 0;              ///< m^2
};
AreaWeights area_weights(const Triangles& surface, const Points& rest, double radius);

/// The forces of a load, which must outlive this, at one moment.
class LoadNow {
 public:
  explicit LoadNow(const Load& load)
      : load_(&load), sum_(load.force), pressed_(load.faces, load.corners, load.particles.size()) {}

  /// Finds the forces at a moment; `position(k)`: of load.particles[k], m; `stepping`: for a step
  /// that follows. Returns whether they may have changed. In parallel; the same bits for any number
  /// of threads.
  template <class Position>
  bool find(const LoadAt& at, const Position& position, bool stepping) {
    const bool scaled = at.scale != scale_;
    scale_ = at.scale;
    if (load_->stiffness > 0 && (scaled || scale_ != 0)) {
      Vec3 place = Vec3::Zero();
      for (std::size_t k = 0; k < load_->particles.size(); ++k)
        place += load_->weight[k] * position(k);
      sum_ = load_->stiffness * (at.free_end - place);
      return true;
    }
    return pressed_.find(position, stepping) || scaled;
  }

  /// On load.particles[k], N.
  Vec3 force(std::size_t k) const {
    Vec3 sum = scale_ * load_->weight[k] * sum_;
    if (!pressed_.empty()) sum += scale_ * load_->pressure * pressed_.force(k);
    return sum;
  }
  /// Sums its forces as found last, those of a pressure by their lengths, N.
  double size() const {
    return std::abs(scale_) * (sum_.norm() + std::abs(load_->pressure) * pressed_.size());
  }

  PressedFaces& pressed() { return pressed_; }
  const PressedFaces& pressed() const { return pressed_; }

 private:
  const Load* load_;
  Vec3 sum_;  ///< sum of the force or the spring, N
  PressedFaces pressed_;
  double scale_ = std::numeric_limits<double>::quiet_NaN();
};

void save_loads(std::span<const LoadNow> loads, SimulationState& state);
/// Throws bad input for a state of other loads.
void restore_loads(const SimulationState& state, std::span<LoadNow> loads);

/// An upper bound of the stiffness that a load adds to a particle of `radius` (m), N/m.
double load_stiffness(const Load& load, double radius);

/// Throws bad input, which names the load, for numbers that are not finite and bad keys.
void check_load(const Load& load);

}  // namespace sinew
