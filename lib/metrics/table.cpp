// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/table.h"

#include <algorithm>
#include <array>

namespace sinew {
namespace {

using M = FrameMetrics;

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
    Metric{"displacement_max", "m", "Largest way of a particle from its rest place", "max |x - x0|",
           &M::displacement_max},
    Metric{"displacement_rms", "m", "Way of the particles from their rest places, rms",
           "sqrt(mean |x - x0|^2)", &M::displacement_rms},
    Metric{"speed_max", "m/s", "Largest speed of a particle", "max |v|", &M::speed_max},
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
           Worse::smaller},
    Metric{"J_mean", "", "Mean local volume ratio", "mean J", &M::J_mean, Worse::smaller},
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
