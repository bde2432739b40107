// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/frame_metrics.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/error.h>
#include <sinew/core/local_origin.h>
#include <sinew/core/particles.h>
#include <sinew/core/text.h>
#include <sinew/metrics/detail/surface_distortion.h>
#include <sinew/metrics/table.h>

namespace sinew {
namespace {

void check(const RestBody& rest, const FrameState& state) {
  const auto require = [&](bool holds, const std::string& what) {
    if (!holds)
      throw bad_input("the frame at " + number_text(state.time) + " s " + what,
                      "measure the frames of one run only");
  };
  const std::size_t n = rest.particles();
  require(state.positions.size() == n && (state.velocities.empty() || state.velocities.size() == n),
          "has " + std::to_string(state.positions.size()) + " particles and the body " +
              std::to_string(n));
  require(state.surface_points.size() == rest.surface.points.size(),
          "has a surface of " + std::to_string(state.surface_points.size()) +
              " points and the body " + std::to_string(rest.surface.points.size()));
  require(state.bones.size() == rest.bones.size(), "has " + std::to_string(state.bones.size()) +
                                                       " bones and the body " +
                                                       std::to_string(rest.bones.size()));
  require(state.broken_bonds.empty() || state.broken_bonds.size() == n,
          "has the broken bonds of " + std::to_string(state.broken_bonds.size()) +
              " particles and the body has " + std::to_string(n));
  for (std::size_t i = 0; i < state.broken_bonds.size(); ++i)
    if (state.broken_bonds[i] < 0 || std::size_t(state.broken_bonds[i]) > rest.bonds_of(i))
      require(false, "has " + std::to_string(state.broken_bonds[i]) + " broken bonds at particle " +
                         std::to_string(i) + " of " + std::to_string(rest.bonds_of(i)));
  bool finite = std::isfinite(state.time) && all_finite(state.positions) &&
                all_finite(state.velocities) && all_finite(state.surface_points);
  for (const RigidFrame& bone : state.bones)
    finite = finite && bone.origin.allFinite() && bone.rotation.allFinite();
  require(finite, "holds a number that is not finite");
}

void add_pose(FrameMetrics& out, const RestBody& rest, const FrameState& state) {
  if (rest.bones.empty()) return;
  std::vector<RigidFrame> frames;
  for (const Bone& bone : rest.bones) frames.push_back(bone.rest);
  const PoseChange change = pose_change(frames, state.bones);
  out.bone_angle = degrees(change.turn);
  out.bone_shift = change.shift;
}

void add_volume(FrameMetrics& out, const RestBody& rest, const Triangles& surface) {
  if (!(rest.volume > 0)) return;
  out.volume = volume(surface);
  out.volume_ratio = out.volume / rest.volume;
  out.volume_error = std::abs(out.volume_ratio - 1);
}

Statistics statistics_of(const std::vector<double>& values) {
  return statistics(values.size(), [&](std::size_t i) { return values[i]; });
}

void add_motion(FrameMetrics& out, const ParticleValues& particles) {
  const Statistics moved = statistics_of(particles.displacement);
  out.displacement_max = moved.max();
  out.displacement_rms = moved.rms();
  out.speed_max = statistics_of(particles.speed).max();
}

/// The sum of value(i), a vector, over the particles; added in the order of pieces.
template <class Value>
Vec3 vector_sum(std::size_t count, const Value& value) {
  Vec3 sum;
  for (int k = 0; k < 3; ++k)
    sum[k] = statistics(count, [&](std::size_t i) { return value(i)[k]; }).sum;
  return sum;
}

void add_momentum(FrameMetrics& out, const RestBody& rest, const FrameState& state) {
  const std::size_t n = rest.particles();
  const auto weight = [&](std::size_t i) { return rest.density.empty() ? 1 : rest.density[i]; };
  const Vec3 center =
      vector_sum(n, [&](std::size_t i) -> Vec3 { return weight(i) * state.positions[i]; }) /
      statistics(n, weight).sum;
  out.center_x = center.x(), out.center_y = center.y(), out.center_z = center.z();
  if (state.velocities.empty()) return;
  const auto momentum = [&](std::size_t i) -> Vec3 {
    return rest.mass_of(i) * state.velocities[i];
  };
  const Vec3 linear = vector_sum(n, momentum);
  const Vec3 about = local_origin(bounds(rest.surface.points));
  const Vec3 angular = vector_sum(
      n, [&](std::size_t i) -> Vec3 { return (state.positions[i] - about).cross(momentum(i)); });
  out.momentum_x = linear.x(), out.momentum_y = linear.y(), out.momentum_z = linear.z();
  out.angular_momentum_x = angular.x();
  out.angular_momentum_y = angular.y();
  out.angular_momentum_z = angular.z();
}

void add_surface(FrameMetrics& out, const RestBody& rest, const FrameState& state,
                 const Triangles& surface) {
  const SurfaceDistortion skin = surface_distortion(rest.surface, state.surface_points);
  out.area = rest.fine ? area(surface) : skin.area;
  out.area_ratio = out.area / rest.area;
  out.edge_stretch_max = skin.edge_stretch;
  out.area_stretch_max = skin.area_stretch;
  out.conformal_max = skin.conformal;
  out.symmetric_dirichlet = skin.dirichlet;
  out.flipped_faces = skin.flipped;
}

double percentile_of(std::vector<double> values, double percent) {
  return percentile(values, percent);
}

void add_strain(FrameMetrics& out, const ParticleValues& particles) {
  out.strain_50 = percentile_of(particles.strain, 50);
  out.strain_95 = percentile_of(particles.strain, 95);
  out.strain_99 = percentile_of(particles.strain, 99);
  out.stretch_max = percentile_of(particles.stretch, 100);
  out.D2min_95 = percentile_of(particles.D2min, 95);
  out.von_mises_95 = percentile_of(particles.von_mises, 95);
}

/// Whether the stress of a particle is not the body's: in an outer layer that the world acts on.
bool is_disturbed(const RestBody& rest, const Points& force, double negligible, std::size_t i) {
  if (rest.layer[i] == 0) return false;
  const auto acts = [&](std::size_t k) { return force[k].norm() > negligible; };
  const auto neighbors = rest.shape.neighbors.of(i);
  return acts(i) || std::any_of(neighbors.begin(), neighbors.end(), acts);
}

void add_largest_stress(FrameMetrics& out, const RestBody& rest, const FrameState& state,
                        const std::vector<double>& all) {
  if (all.empty()) return;
  constexpr double rounding = 1e-6;  // fraction of the largest force
  double largest = 0;
  for (const Vec3& force : state.world_force) largest = std::max(largest, force.norm());
  out.von_mises_left_out = 0;
  std::vector<double> stress = all;
  for (std::size_t i = 0; i < stress.size() && largest > 0; ++i)
    if (is_disturbed(rest, state.world_force, rounding * largest, i)) {
      stress[i] = not_measured;
      ++out.von_mises_left_out;
    }
  out.von_mises_max = percentile_of(std::move(stress), 100);
  if (!std::isnan(out.von_mises_max)) return;
  out.von_mises_left_out = 0;  // the body is thin, and the world acts on all of it
  out.von_mises_max = percentile_of(all, 100);
}

void add_energies(FrameMetrics& out, const Energies& start, const Energies& now) {
  out.kinetic_energy = now.kinetic;
  out.pair_energy = now.pair;
  out.bone_energy = now.bone;
  out.gravity_energy = now.gravity;
  out.work_of_bones = now.work_of_bones;
  out.dissipation = now.dissipation;
  out.contact_energy = now.contact;
  out.work_of_world = now.work_of_world;
  out.energy_residual = (now.stored() - start.stored()) - (now.work() - start.work()) +
                        (now.dissipation - start.dissipation);
}

void add_adherence(FrameMetrics& out, const RestBody& rest, const FrameState& state) {
  const Statistics slip = statistics(rest.bound.size(), [&](std::size_t k) {
    const Bound& bound = rest.bound[k];
    const Vec3 foot = carried(bound.foot, rest.bones[bound.bone].rest, state.bones[bound.bone]);
    return std::abs((state.positions[bound.particle] - foot).norm() - bound.distance);
  });
  out.adherence_rms = slip.rms();
  out.adherence_max = slip.max();
}

void add_pose_error(FrameMetrics& out, const RestBody& rest, const ParticleValues& particles) {
  const auto error = [&](std::size_t k) { return particles.pose_error[rest.bound[k].particle]; };
  const Statistics all = statistics(rest.bound.size(), error);
  Statistics far;
  for (std::size_t k = 0; k < rest.bound.size(); ++k)
    if (rest.bound[k].far) far.add(error(k));
  out.pose_error_rms = all.rms();
  out.pose_error_max = all.max();
  out.pose_error_far_rms = far.rms();
}

void add_neighbors(FrameMetrics& out, const RestBody& rest, const ParticleValues& particles) {
  const double from_both_sides = 2 * rest.rest_pairs();
  if (from_both_sides == 0) return;
  out.broken_neighbors = statistics_of(particles.lost).sum / from_both_sides;
  out.new_neighbors = statistics_of(particles.gained).sum / from_both_sides;
}

void add_bonds(FrameMetrics& out, const RestBody& rest, const FrameState& state) {
  if (state.broken_bonds.empty() || rest.rest_pairs() == 0) return;
  const auto broken = [&](std::size_t i) { return state.broken_bonds[i]; };
  const double bonds = rest.rest_pairs() + static_cast<double>(rest.second.neighbor.size()) / 2;
  out.broken_bonds = statistics(rest.particles(), broken).sum / (2 * bonds);
}

void add_groups(FrameMetrics& out, const FrameState& state) {
  if (state.group.empty()) return;
  const auto in_one = [&](std::size_t i) { return state.group[i] >= 0 ? 1.0 : 0.0; };
  out.grouped = statistics(state.group.size(), in_one).mean();
}

void add_sections(FrameMetrics& out, const RestBody& rest, const Triangles& surface) {
  Statistics ratios;
  for (const Section& section : rest.sections)
    ratios.add(area_of(section, surface.points) / section.area);
  out.candy_wrapper = 1 - ratios.min();
  out.bulge = ratios.max() - 1;
}

void add_gradients(FrameMetrics& out, const ParticleValues& particles, double radius) {
  Statistics defined;
  double inverted = 0;
  for (const double J : particles.J) {
    if (std::isnan(J)) continue;
    defined.add(J);
    inverted += J <= 0;
  }
  if (defined.count > 0) out.inverted = inverted;
  out.J_min = defined.min();
  out.J_mean = defined.mean();
  if (defined.count > 0) out.particle_volume = volume_per_particle(radius) * defined.sum;
}

std::vector<std::int64_t> worst_particles(const FrameMetrics& metrics,
                                          const ParticleValues& particles) {
  std::vector<std::int64_t> worst;
  for (const Metric& metric : metrics_table()) {
    worst.push_back(-1);
    if (!metric.of_particles) continue;
    const std::vector<double>& values = particles.*metric.of_particles;
    const auto found = std::find(values.begin(), values.end(), metrics.*metric.value);
    if (found != values.end()) worst.back() = found - values.begin();
  }
  return worst;
}

}  // namespace

PoseChange pose_change(std::span<const RigidFrame> from, std::span<const RigidFrame> to) {
  PoseChange change;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Mat3 turn = to[i].rotation * from[i].rotation.transpose();
    change.turn = std::max(change.turn, Eigen::AngleAxisd(Quat(turn)).angle());
    change.shift = std::max(change.shift, (to[i].origin - from[i].origin).norm());
  }
  return change;
}

MeasuredFrame measure_frame(const RestBody& rest, const FrameState& state) {
  check(rest, state);
  MeasuredFrame frame{{}, particle_values(rest, state), {}};
  FrameMetrics& out = frame.metrics;
  out.time = state.time;
  add_pose(out, rest, state);
  const Triangles surface = measured_surface(rest, state);
  add_volume(out, rest, surface);
  add_motion(out, frame.particles);
  add_energies(out, rest.start, state.energies);
  out.unbalanced_force = state.unbalanced.force;
  out.unbalanced_moment = state.unbalanced.moment;
  add_adherence(out, rest, state);
  add_pose_error(out, rest, frame.particles);
  add_neighbors(out, rest, frame.particles);
  add_bonds(out, rest, state);
  add_groups(out, state);
  add_gradients(out, frame.particles, rest.radius());
  add_strain(out, frame.particles);
  add_largest_stress(out, rest, state, frame.particles.von_mises);
  add_surface(out, rest, state, surface);
  add_sections(out, rest, surface);
  add_momentum(out, rest, state);
  out.tip_angle = degrees(tip_turn(rest.slices, rest.shape.points, state.positions));
  out.twist_jump_max = degrees(largest_twist_jump(rest.slices, rest.shape.points, state.positions));
  frame.worst_particles = worst_particles(out, frame.particles);
  return frame;
}

FrameMetrics measure(const RestBody& rest, const FrameState& state) {
  return measure_frame(rest, state).metrics;
}

}  // namespace sinew
