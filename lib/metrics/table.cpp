// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/table.h"

#include <algorithm>
#include <array>

namespace sinew {
namespace {

using M = FrameMetrics;
using V = ParticleValues;

constexpr std::array table = {
    Metric{"time", "s", "Time in the scene", "t", &M::time},
    Metric{"bone_angle", "deg", "Largest turn of any bone away from its rest pose, 0 to 180",
           "max angle(R R0^T)", &M::bone_angle},
    Metric{"bone_shift", "m", "Largest shift of any bone's head away from its rest place",
           "max |o - o0|", &M::bone_shift},
    Metric{"volume", "m^3", "Volume the surface encloses (blind to folds: see J_min)",
           "V = sum a.(b x c) / 6 over its triangles", &M::volume, Worse::smaller},
    Metric{"volume_ratio", "", "Volume relative to the one at rest", "V / V0", &M::volume_ratio,
           Worse::smaller},
    Metric{"volume_error", "", "How far the volume is from the one at rest", "|V / V0 - 1|",
           &M::volume_error},
    Metric{"area", "m^2", "Area of the surface", "A = sum |a x b| / 2 over its triangles",
           &M::area},
    Metric{"area_ratio", "", "Area relative to the one at rest", "A / A0", &M::area_ratio},
    Metric{"particle_volume", "m^3", "Volume of the particles as they are strained",
           "sum V0 J, V0 = 4 sqrt(2) r^3", &M::particle_volume, Worse::smaller},
    Metric{"centre_x", "m", "Centre of mass", "mean x", &M::centre_x, Worse::magnitude},
    Metric{"centre_y", "m", "Centre of mass", "mean y", &M::centre_y, Worse::magnitude},
    Metric{"centre_z", "m", "Centre of mass", "mean z", &M::centre_z, Worse::magnitude},
    Metric{"momentum_x", "kg m/s", "Linear momentum", "sum m v", &M::momentum_x, Worse::magnitude},
    Metric{"momentum_y", "kg m/s", "Linear momentum", "sum m v", &M::momentum_y, Worse::magnitude},
    Metric{"momentum_z", "kg m/s", "Linear momentum", "sum m v", &M::momentum_z, Worse::magnitude},
    Metric{"angular_momentum_x", "kg m^2/s", "Angular momentum about the origin", "sum m x cross v",
           &M::angular_momentum_x, Worse::magnitude},
    Metric{"angular_momentum_y", "kg m^2/s", "Angular momentum about the origin", "sum m x cross v",
           &M::angular_momentum_y, Worse::magnitude},
    Metric{"angular_momentum_z", "kg m^2/s", "Angular momentum about the origin", "sum m x cross v",
           &M::angular_momentum_z, Worse::magnitude},
    Metric{"displacement_max", "m", "Largest way of a particle from its rest place", "max |x - x0|",
           &M::displacement_max, Worse::larger, &V::displacement},
    Metric{"displacement_rms", "m", "Way of the particles from their rest places, rms",
           "sqrt(mean |x - x0|^2)", &M::displacement_rms},
    Metric{"speed_max", "m/s", "Largest speed of a particle", "max |v|", &M::speed_max,
           Worse::larger, &V::speed},
    Metric{"kinetic_energy", "J", "Energy of motion", "sum m v^2 / 2, v in the middle of the step",
           &M::kinetic_energy},
    Metric{"pair_energy", "J", "Energy of the forces between particles", "sum phi(d) over pairs",
           &M::pair_energy},
    Metric{"bone_energy", "J", "Energy of the springs to the bones",
           "sum U, radial + twist + axial or anchor", &M::bone_energy},
    Metric{"gravity_energy", "J", "Energy of height", "-sum m g.x", &M::gravity_energy},
    Metric{"work_of_bones", "J", "Work the bones have done on the body since the start",
           "integral of F.o' + M.omega", &M::work_of_bones},
    Metric{"dissipation", "J", "Energy lost to damping, drag and friction since the start",
           "-integral of damping force . velocity", &M::dissipation},
    Metric{"contact_energy", "J", "Energy of contacts with obstacles", "sum k (r - d)^2 / 2",
           &M::contact_energy},
    Metric{"work_of_world", "J",
           "Work that moving obstacles, pins, fields and muscles have done since the start",
           "integral of force . velocity", &M::work_of_world},
    Metric{"energy_residual", "J",
           "What is missing in the balance of energies: tests the integrator",
           "change of (kinetic + pair + bone + gravity + contact) - work + dissipation",
           &M::energy_residual, Worse::magnitude},
    Metric{"adherence_rms", "m", "How far particles left their distance to the bone, rms",
           "sqrt(mean (|x - p| - l0)^2), p the carried nearest point of the bone",
           &M::adherence_rms},
    Metric{"adherence_max", "m", "How far a particle left its distance to the bone, at most",
           "max ||x - p| - l0|", &M::adherence_max},
    Metric{"pose_error_rms", "m", "Way of the particles from the rigid pose of their bones, rms",
           "sqrt(mean |x - q|^2), q = o + R R0^T (x0 - o0)", &M::pose_error_rms},
    Metric{"pose_error_max", "m", "Largest way of a particle from the rigid pose of its bone",
           "max |x - q|", &M::pose_error_max},
    Metric{"pose_error_far_rms", "m",
           "Likewise, rms, of the particles farther along the bones than half a width from a joint",
           "sqrt(mean |x - q|^2) where |c - joint| > sqrt(A_B) / 2, c the foot on the bone",
           &M::pose_error_far_rms},
    Metric{"broken_neighbours", "", "Share of the rest neighbours that no longer feel each other",
           "pairs with d0 < 2.2 r and d >= b / pairs with d0 < 2.2 r", &M::broken_neighbours},
    Metric{"new_neighbours", "", "Pairs that became neighbours, relative to the rest neighbours",
           "pairs with d < 2.2 r and d0 >= 2.2 r / pairs with d0 < 2.2 r", &M::new_neighbours},
    Metric{"inverted", "", "Particles whose surroundings are turned inside out",
           "count of J <= 0, J = det F", &M::inverted},
    Metric{"J_min", "", "Smallest local volume ratio",
           "min J, F = (sum dx dX^T)(sum dX dX^T)^-1 over rest neighbours", &M::J_min,
           Worse::smaller, &V::J},
    Metric{"J_mean", "", "Mean local volume ratio", "mean J", &M::J_mean, Worse::smaller},
    Metric{"stretch_max", "", "Largest stretch in any direction anywhere",
           "largest principal value of U = sqrt(F^T F)", &M::stretch_max, Worse::larger,
           &V::stretch},
    Metric{"strain_50", "", "Equivalent strain that half of the particles do not exceed",
           "50 % of sqrt(2/3 dev H : dev H), H = ln(F^T F) / 2", &M::strain_50},
    Metric{"strain_95", "", "Equivalent strain that 95 % of the particles do not exceed",
           "95 % of the same", &M::strain_95},
    Metric{"strain_99", "", "Equivalent strain that 99 % of the particles do not exceed",
           "99 % of the same", &M::strain_99},
    Metric{"D2min_95", "m^2", "Motion that is not affine (flow): 95 % do not exceed it",
           "95 % of mean |dx - F dX|^2 over rest neighbours", &M::D2min_95},
    Metric{"von_mises_95", "Pa", "Von Mises stress that 95 % of the particles do not exceed",
           "95 % of sqrt(3/2 dev s : dev s), s = -(1/2V0) sum f (x) r", &M::von_mises_95},
    Metric{"edge_stretch_max", "", "Largest stretch or shrinkage of an edge of the surface",
           "max of l / l0 and l0 / l", &M::edge_stretch_max},
    Metric{"area_stretch_max", "", "Largest growth or shrinkage of a face of the surface",
           "max of A / A0 and A0 / A", &M::area_stretch_max},
    Metric{"conformal_max", "", "Largest change of shape of a face; 1 keeps its angles",
           "max s1 / s2, the stretches of a face", &M::conformal_max},
    Metric{"symmetric_dirichlet", "", "Mean distortion of the surface; 4 for a rigid motion",
           "mean over area of s1^2 + s2^2 + 1/s1^2 + 1/s2^2", &M::symmetric_dirichlet},
    Metric{"flipped_faces", "", "Faces of the surface that are turned over",
           "count of n . (n_a + n_b + n_c) < 0, normals at the corners", &M::flipped_faces},
    Metric{"tip_angle", "deg", "Turn of the outermost two half-planes of the last bone, 0 to 180",
           "angle of the best-fit rotation (Kabsch) from rest", &M::tip_angle},
    Metric{"twist_jump_max", "deg",
           "Largest twist between slices of one half-plane each that follow along the bones",
           "max twist about the axis of Q' Q^T, Q the best-fit rotation of a slice",
           &M::twist_jump_max},
};

constexpr std::array run_table = {
    RunMetric{"residual_rms", "m", "Way from the rest places that stays after the bones are back",
              "displacement_rms of the last frame, bones at rest again after a motion",
              &Summary::residual_rms},
    RunMetric{"settling_time", "s", "Longest time the body takes to settle once its bones stop",
              "until sqrt(mean |x - x_end|^2) stays below 0.2 r", &Summary::settling_time},
    RunMetric{"overshoot", "deg", "How far the tip turns beyond where it comes to rest",
              "max over holds of tip_angle past its last value, in the direction it came",
              &Summary::overshoot},
    RunMetric{"momentum_drift", "kg m/s", "Largest change of the linear momentum since the start",
              "max |P - P0|; bones and gravity change it too", &Summary::momentum_drift},
    RunMetric{"angular_momentum_drift", "kg m^2/s",
              "Largest change of the angular momentum since the start",
              "max |L - L0|; bones and gravity change it too", &Summary::angular_momentum_drift},
};

}  // namespace

std::span<const Metric> metrics_table() { return table; }

std::span<const RunMetric> run_metrics_table() { return run_table; }

std::size_t metric_index(std::string_view name) {
  const auto found = std::find_if(table.begin(), table.end(),
                                  [&](const Metric& metric) { return metric.name == name; });
  return static_cast<std::size_t>(found - table.begin());
}

}  // namespace sinew
