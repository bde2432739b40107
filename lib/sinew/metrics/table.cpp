// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/table.h>

#include <algorithm>
#include <array>
#include <limits>

namespace sinew {
namespace {

using M = FrameMetrics;
using V = ParticleValues;

constexpr std::array metric_table = {
    Metric{"time", "s", "Simulated time", "t", &M::time},
    Metric{"bone_angle", "deg", "Largest rotation of any bone from its rest pose, 0 to 180",
           "max angle(R R0^T)", &M::bone_angle},
    Metric{"bone_shift", "m", "Largest displacement of any bone's head from its rest position",
           "max |o - o0|", &M::bone_shift},
    Metric{"volume", "m^3", "Volume enclosed by the surface (ignores folds: see J_min)",
           "V = sum a.(b x c) / 6 over its triangles", &M::volume, Worse::smaller},
    Metric{"volume_ratio", "", "Volume relative to the rest volume", "V / V0", &M::volume_ratio,
           Worse::smaller},
    Metric{"volume_error", "", "Relative deviation from the rest volume", "|V / V0 - 1|",
           &M::volume_error},
    Metric{"area", "m^2", "Area of the surface", "A = sum |a x b| / 2 over its triangles",
           &M::area},
    Metric{"area_ratio", "", "Area relative to the rest area", "A / A0", &M::area_ratio},
    Metric{"particle_volume", "m^3", "Volume of the strained particles",
           "sum V0 J, V0 = 4 sqrt(2) r^3", &M::particle_volume, Worse::smaller},
    Metric{"center_x", "m", "Center of mass", "mean x", &M::center_x, Worse::magnitude},
    Metric{"center_y", "m", "Center of mass", "mean y", &M::center_y, Worse::magnitude},
    Metric{"center_z", "m", "Center of mass", "mean z", &M::center_z, Worse::magnitude},
    Metric{"momentum_x", "kg m/s", "Linear momentum", "sum m v", &M::momentum_x, Worse::magnitude},
    Metric{"momentum_y", "kg m/s", "Linear momentum", "sum m v", &M::momentum_y, Worse::magnitude},
    Metric{"momentum_z", "kg m/s", "Linear momentum", "sum m v", &M::momentum_z, Worse::magnitude},
    Metric{"angular_momentum_x", "kg m^2/s", "Angular momentum about the origin", "sum m x cross v",
           &M::angular_momentum_x, Worse::magnitude},
    Metric{"angular_momentum_y", "kg m^2/s", "Angular momentum about the origin", "sum m x cross v",
           &M::angular_momentum_y, Worse::magnitude},
    Metric{"angular_momentum_z", "kg m^2/s", "Angular momentum about the origin", "sum m x cross v",
           &M::angular_momentum_z, Worse::magnitude},
    Metric{"displacement_max", "m", "Largest displacement of a particle from its rest position",
           "max |x - x0|", &M::displacement_max, Worse::larger, &V::displacement},
    Metric{"displacement_rms", "m", "Displacement of the particles from their rest positions, rms",
           "sqrt(mean |x - x0|^2)", &M::displacement_rms},
    Metric{"speed_max", "m/s", "Largest speed of a particle", "max |v|", &M::speed_max,
           Worse::larger, &V::speed},
    Metric{"kinetic_energy", "J", "Kinetic energy", "sum m v^2 / 2, v in the middle of the step",
           &M::kinetic_energy},
    Metric{"pair_energy", "J", "Elastic energy of the pair forces", "sum phi(d) over pairs",
           &M::pair_energy},
    Metric{"bone_energy", "J", "Elastic energy of the bone springs",
           "sum U, radial + twist + axial or anchor", &M::bone_energy},
    Metric{"gravity_energy", "J", "Potential energy of gravity", "-sum m g.x", &M::gravity_energy},
    Metric{"work_of_bones", "J", "Work the bones have done on the body since the start",
           "integral of F.o' + M.omega", &M::work_of_bones},
    Metric{"dissipation", "J", "Energy lost to damping, drag and friction since the start",
           "-integral of damping force . velocity", &M::dissipation},
    Metric{"contact_energy", "J", "Elastic energy of contacts with obstacles",
           "sum k (r - d)^2 / 2", &M::contact_energy},
    Metric{
        "work_of_world", "J",
        "Work that moving obstacles, pins, fields, muscles, supports and loads have done since the "
        "start",
        "integral of force . velocity", &M::work_of_world},
    Metric{"energy_residual", "J", "Residual of the energy ledger: tests the integrator",
           "change of (kinetic + pair + bone + gravity + contact) - work + dissipation",
           &M::energy_residual, Worse::magnitude},
    Metric{"unbalanced_force", "N",
           "Size of the sum of all forces on the body from outside: nothing in an equilibrium, "
           "measured in runs of the static method",
           "|sum f| of bones, pins, supports, loads, obstacles, fields and the weight",
           &M::unbalanced_force},
    Metric{"unbalanced_moment", "N m", "Size of the sum of their moments about the center of mass",
           "|sum (x - c) x f|", &M::unbalanced_moment},
    Metric{"adherence_rms", "m", "Change of the particles' distance to the bone, rms",
           "sqrt(mean (|x - p| - l0)^2), p the carried nearest point of the bone",
           &M::adherence_rms},
    Metric{"adherence_max", "m", "Largest change of a particle's distance to the bone",
           "max ||x - p| - l0|", &M::adherence_max},
    Metric{"pose_error_rms", "m",
           "Distance of the particles from the rigid pose of their bones, rms",
           "sqrt(mean |x - q|^2), q = o + R R0^T (x0 - o0)", &M::pose_error_rms},
    Metric{"pose_error_max", "m", "Largest distance of a particle from the rigid pose of its bone",
           "max |x - q|", &M::pose_error_max, Worse::larger, &V::pose_error},
    Metric{"pose_error_far_rms", "m",
           "Distance from the rigid pose, rms, of the particles more than half a width along the "
           "bones from a joint",
           "sqrt(mean |x - q|^2) where |c - joint| > sqrt(A_B) / 2, c the foot on the bone",
           &M::pose_error_far_rms},
    Metric{"broken_neighbors", "", "Fraction of the rest neighbors that no longer interact",
           "pairs with d0 < 2.2 r and d >= b / pairs with d0 < 2.2 r", &M::broken_neighbors},
    Metric{"new_neighbors", "", "Pairs that became neighbors, relative to the rest neighbors",
           "pairs with d < 2.2 r and d0 >= 2.2 r / pairs with d0 < 2.2 r", &M::new_neighbors},
    Metric{"broken_bonds", "", "Fraction of the bonds of a bonded material that have broken",
           "broken bonds / bonds at rest: pairs with d0 < 2.2 r, isotropic ones with d0 < 3.1 r",
           &M::broken_bonds},
    Metric{"grouped", "", "Fraction of the particles that move in groups",
           "particles of any group / particles", &M::grouped},
    Metric{"inverted", "", "Particles whose neighborhood is inverted", "count of J <= 0, J = det F",
           &M::inverted},
    Metric{"J_min", "", "Smallest local volume ratio",
           "min J, F = (sum dx dX^T)(sum dX dX^T)^-1 over rest neighbors", &M::J_min,
           Worse::smaller, &V::J},
    Metric{"J_mean", "", "Mean local volume ratio", "mean J", &M::J_mean, Worse::smaller},
    Metric{"stretch_max", "", "Largest principal stretch anywhere",
           "largest principal value of U = sqrt(F^T F)", &M::stretch_max, Worse::larger,
           &V::stretch},
    Metric{"strain_50", "", "Equivalent strain that half of the particles do not exceed",
           "50 % of sqrt(2/3 dev H : dev H), H = ln(F^T F) / 2", &M::strain_50},
    Metric{"strain_95", "", "Equivalent strain that 95 % of the particles do not exceed",
           "95 % of the same", &M::strain_95},
    Metric{"strain_99", "", "Equivalent strain that 99 % of the particles do not exceed",
           "99 % of the same", &M::strain_99},
    Metric{"D2min_95", "m^2", "Non-affine motion (flow) that 95 % of the particles do not exceed",
           "95 % of mean |dx - F dX|^2 over rest neighbors", &M::D2min_95},
    Metric{"von_mises_95", "Pa", "Von Mises stress that 95 % of the particles do not exceed",
           "95 % of sqrt(3/2 dev s : dev s), s = -(1/2JV) sum f (x) r (Cauchy)", &M::von_mises_95},
    Metric{
        "von_mises_max", "Pa",
        "Largest von Mises stress, the two outer layers left out where the world acts on them: "
        "there stress is less or more than the body's by half",
        "max of the same; not where surface_layer is 1 or 2 and force_world acts on the particle "
        "or a neighbor, unless that leaves none",
        &M::von_mises_max},
    Metric{"von_mises_left_out", "", "Particles that von_mises_max leaves out", "count of them",
           &M::von_mises_left_out},
    Metric{"edge_stretch_max", "", "Largest stretch or shrinkage of an edge of the surface",
           "max of l / l0 and l0 / l", &M::edge_stretch_max},
    Metric{"area_stretch_max", "", "Largest growth or shrinkage of a face of the surface",
           "max of A / A0 and A0 / A", &M::area_stretch_max},
    Metric{"conformal_max", "", "Largest change of shape of a face; 1 preserves its angles",
           "max s1 / s2, the stretches of a face", &M::conformal_max},
    Metric{"symmetric_dirichlet", "", "Mean distortion of the surface; 4 for a rigid motion",
           "mean over area of s1^2 + s2^2 + 1/s1^2 + 1/s2^2", &M::symmetric_dirichlet},
    Metric{"flipped_faces", "", "Faces of the surface that are flipped",
           "count of n . (n_a + n_b + n_c) < 0, normals at the corners", &M::flipped_faces},
    Metric{"limb_turn_max", "deg",
           "Largest angle between a bone and its particles away from joints, both as turned from "
           "rest; of bones with a dozen such particles",
           "max over the bones of turn_error in metrics_bones.csv", &M::limb_turn_max},
    Metric{"tip_angle", "deg",
           "Rotation of the outermost two half-planes of the last bone, 0 to 180",
           "angle of the best-fit rotation (Kabsch) from rest", &M::tip_angle},
    Metric{"twist_jump_max", "deg",
           "Largest twist between adjacent slices along the bones, each one half-plane thick",
           "max twist about the axis of Q' Q^T, Q the best-fit rotation of a slice",
           &M::twist_jump_max},
    Metric{"candy_wrapper", "", "Largest loss of area of a section across a bone; 1: pinched off",
           "1 - min A / A0 over the sections of sections.csv", &M::candy_wrapper},
    Metric{"bulge", "", "Largest gain of area of a section across a bone",
           "max A / A0 - 1 over the sections of sections.csv", &M::bulge},
    Metric{"self_intersections", "",
           "Pairs of faces of the surface that intersect or touch, beyond those at rest",
           "count, by exact predicates, at most 100000, minus that at rest",
           &M::self_intersections},
    Metric{"pose_hausdorff", "m",
           "Largest distance between the surface and its rigid pose, in which each point follows "
           "its bone",
           "Hausdorff distance at corners and centers of faces", &M::pose_hausdorff},
    Metric{"pose_distance_mean", "m", "Mean distance between the surface and its rigid pose",
           "over the area of both, to the nearest point of the other", &M::pose_distance_mean},
    Metric{"lbs_hausdorff", "m",
           "Largest distance between the surface and linear-blend skinning (output.skin_lbs)",
           "as pose_hausdorff", &M::lbs_hausdorff},
    Metric{"lbs_distance_mean", "m", "Mean distance between the surface and linear-blend skinning",
           "as pose_distance_mean", &M::lbs_distance_mean},
    Metric{"dqs_hausdorff", "m",
           "Largest distance between the surface and dual-quaternion skinning (output.skin_dqs)",
           "as pose_hausdorff", &M::dqs_hausdorff},
    Metric{"dqs_distance_mean", "m",
           "Mean distance between the surface and dual-quaternion skinning",
           "as pose_distance_mean", &M::dqs_distance_mean},
    Metric{"reference_hausdorff", "m",
           "Largest distance between the surface and a reference (--reference, or the other run)",
           "as pose_hausdorff", &M::reference_hausdorff},
    Metric{"reference_distance_mean", "m", "Mean distance between the surface and the reference",
           "as pose_distance_mean", &M::reference_distance_mean},
    Metric{"reference_surface_rms", "m",
           "Distance between the surface's points and the same points of the reference, rms",
           "sqrt(mean |x - y|^2), where both have the same number of points",
           &M::reference_surface_rms},
    Metric{"reference_surface_max", "m", "The same, maximum", "max |x - y|",
           &M::reference_surface_max},
    Metric{"reference_particles_rms", "m",
           "Distance between the particles and the same particles of the other run, rms",
           "sqrt(mean |x - y|^2), where both began at the same positions",
           &M::reference_particles_rms},
    Metric{"reference_particles_max", "m", "The same, maximum", "max |x - y|",
           &M::reference_particles_max},
};

constexpr std::array run_table = {
    RunMetric{"residual_rms", "m", "Displacement from rest that remains after the bones return",
              "displacement_rms of the last frame, bones at rest again after a motion",
              &Summary::residual_rms},
    RunMetric{"settling_time", "s", "Longest time the body takes to settle after its bones stop",
              "until sqrt(mean |x - x_end|^2) stays below 0.2 r", &Summary::settling_time},
    RunMetric{"overshoot", "deg", "Rotation of the tip beyond its final angle",
              "max over holds of tip_angle beyond its last value, in its direction of approach",
              &Summary::overshoot},
    RunMetric{"momentum_drift", "kg m/s", "Largest change of the linear momentum since the start",
              "max |P - P0|; bones and gravity change it too", &Summary::momentum_drift},
    RunMetric{"angular_momentum_drift", "kg m^2/s",
              "Largest change of the angular momentum since the start",
              "max |L - L0|; bones and gravity change it too", &Summary::angular_momentum_drift},
};

}  // namespace

std::span<const Metric> metrics_table() { return metric_table; }

std::span<const RunMetric> run_metrics_table() { return run_table; }

std::size_t metric_index(std::string_view name) {
  const auto found = std::find_if(metric_table.begin(), metric_table.end(),
                                  [&](const Metric& metric) { return metric.name == name; });
  return static_cast<std::size_t>(found - metric_table.begin());
}

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

/// Besides those whose magnitude is what counts.
constexpr std::array<std::string_view, 11> with_sign = {
    "volume",        "volume_ratio", "particle_volume",   "J_min",
    "J_mean",        "pair_energy",  "gravity_energy",    "work_of_bones",
    "work_of_world", "bulge",        "self_intersections"};

struct NamedRange {
  std::string_view name;
  double low, high;
};
constexpr NamedRange narrow_ranges[] = {{"bone_angle", 0, 180},
                                        {"tip_angle", 0, 180},
                                        {"limb_turn_max", 0, 180},
                                        {"twist_jump_max", 0, 180},
                                        {"broken_neighbors", 0, 1},
                                        {"broken_bonds", 0, 1},
                                        {"grouped", 0, 1},
                                        {"candy_wrapper", -endless, 1},
                                        {"edge_stretch_max", 1, endless},
                                        {"area_stretch_max", 1, endless},
                                        {"conformal_max", 1, endless},
                                        {"symmetric_dirichlet", 4, endless}};

}  // namespace

ValueRange range_of(std::string_view name) {
  for (const NamedRange& one : narrow_ranges)
    if (one.name == name) return {one.low, one.high};
  const auto named = [&](const auto& one) { return one.name == name; };
  const auto metric = std::find_if(metric_table.begin(), metric_table.end(), named);
  const bool is_size = metric != metric_table.end()
                           ? metric->worse != Worse::magnitude
                           : std::any_of(run_table.begin(), run_table.end(), named);
  const bool has_sign = std::find(with_sign.begin(), with_sign.end(), name) != with_sign.end();
  return {is_size && !has_sign ? 0 : -endless, endless};
}

}  // namespace sinew
