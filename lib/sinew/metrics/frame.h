// SPDX-License-Identifier: GPL-3.0-or-later
// One frame of a run: the state that is measured, and the metrics of it.
//
//     FrameState state{.time = 1.5, .positions = positions, .bones = frames};
#pragma once

#include <cstdint>
#include <vector>

#include <sinew/core/energies.h>
#include <sinew/core/vector.h>
#include <sinew/metrics/statistics.h>

namespace sinew {

/// The state of a run at one time. Particles are in the written order.
struct FrameState {
  double time = 0;                ///< s
  Points positions, velocities;   ///< n x 3, m and m/s
  Points surface_points;          ///< in the order of the surface at rest, m
  std::vector<RigidFrame> bones;  ///< one per bone
  Energies energies;
  std::vector<double> bone_lengths;             ///< head to tail, m; empty: as at rest
  std::vector<std::int32_t> broken_bonds = {};  ///< one per particle; empty: it has no bonds
  /// Rest lengths of the bonds as they are now, m, 0 once broken: by entry of
  /// RestBody::shape.neighbors, then of second. Empty: as at rest, or not known.
  std::vector<double> bond_rest = {};
  std::vector<Mat3> muscle_stress = {};  ///< one per particle, Pa; empty: none, or not known
  std::vector<double> von_mises = {};    ///< one per particle, Pa, as the run wrote it; or empty
  std::vector<std::int32_t> group = {};  ///< one per particle, -1: free; empty: there are none
  /// Force of pins, supports, loads, obstacles and the like on each, N; or empty.
  Points world_force = {};
  Unbalanced unbalanced = {};
};

/// The metrics of one frame; table.cpp gives unit, meaning and formula of each.
struct FrameMetrics {
  double time = not_measured;
  double bone_angle = not_measured, bone_shift = not_measured;
  double volume = not_measured, volume_ratio = not_measured, volume_error = not_measured;
  double area = not_measured, area_ratio = not_measured, particle_volume = not_measured;
  double center_x = not_measured, center_y = not_measured, center_z = not_measured;
  double momentum_x = not_measured, momentum_y = not_measured, momentum_z = not_measured;
  double angular_momentum_x = not_measured, angular_momentum_y = not_measured,
         angular_momentum_z = not_measured;
  double displacement_max = not_measured, displacement_rms = not_measured;
  double speed_max = not_measured;
  double kinetic_energy = not_measured, pair_energy = not_measured, bone_energy = not_measured;
  double gravity_energy = not_measured, work_of_bones = not_measured, dissipation = not_measured;
  double contact_energy = not_measured, work_of_world = not_measured;
  double energy_residual = not_measured;
  double unbalanced_force = not_measured, unbalanced_moment = not_measured;
  double adherence_rms = not_measured, adherence_max = not_measured;
  double pose_error_rms = not_measured, pose_error_max = not_measured;
  double pose_error_far_rms = not_measured;
  double broken_neighbors = not_measured, new_neighbors = not_measured;
  double broken_bonds = not_measured;
  double grouped = not_measured;
  double inverted = not_measured, J_min = not_measured, J_mean = not_measured;
  double stretch_max = not_measured;
  double strain_50 = not_measured, strain_95 = not_measured, strain_99 = not_measured;
  double D2min_95 = not_measured, von_mises_95 = not_measured;
  double von_mises_max = not_measured, von_mises_left_out = not_measured;
  double edge_stretch_max = not_measured, area_stretch_max = not_measured;
  double conformal_max = not_measured, symmetric_dirichlet = not_measured;
  double flipped_faces = not_measured;
  double limb_turn_max = not_measured;
  double tip_angle = not_measured, twist_jump_max = not_measured;
  double candy_wrapper = not_measured, bulge = not_measured;
  // Metrics that need other surfaces or exact geometry: see <sinew/run/measure_run.h>.
  double self_intersections = not_measured;
  double pose_hausdorff = not_measured, pose_distance_mean = not_measured;
  double lbs_hausdorff = not_measured, lbs_distance_mean = not_measured;
  double dqs_hausdorff = not_measured, dqs_distance_mean = not_measured;
  double reference_hausdorff = not_measured, reference_distance_mean = not_measured;
  double reference_surface_rms = not_measured, reference_surface_max = not_measured;
  double reference_particles_rms = not_measured, reference_particles_max = not_measured;
};

}  // namespace sinew
