// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/check/warnings.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <sinew/analysis/rest_stability.h>
#include <sinew/body/grouping.h>
#include <sinew/body/solid.h>
#include <sinew/core/particles.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/rig/motion_checks.h>
#include <sinew/scene/check/needs.h>
#include <sinew/scene/check/stiffness.h>
#include <sinew/scene/filling.h>
#include <sinew/scene/rigid_parts.h>
#include <sinew/world/world.h>

namespace sinew {

namespace {

using Warnings = std::vector<std::string>;

// Fall of energy from FCC to BCC beyond which bodies crept, and the barrier before it, over the
// fall, that kept them (rest_stability.h): of 64 trials with b from 2.75 to 2.9 radii and lambda
// from 0.02 to 2, these let all pass that kept their shape but four, and none that did not.
constexpr double largest_fall = 0.9e-3, smallest_barrier = 0.055;
constexpr double fastest_bone =
    0.5;  // radii per step: faster bones pass neighbors instead of pushing them
constexpr double largest_overstress = 0.1;  // fraction of the yield stress
constexpr double deepest_start = 0.1;       // radii inside an obstacle: more is visible as a kick
constexpr double largest_face = 4;          // particles along a side
constexpr double min_shift = 0.1;           // radii: a smaller jump of a bone is invisible
// In square roots of a bone's cross-section: 0.6 is the rim of a round limb.
constexpr double far_from_bone = 3;
constexpr double largest_turn = 180;  // degrees of a bone about itself against its parent
constexpr double steepest_joint = 5;  // degrees between two planes: more breaks bonds

void warn_of_material(const PairForce& pair, Warnings& warnings) {
  if (second_neighbors_may_pull(pair)) {
    const BainPath path = bain_path(pair);
    if (path.fall() > largest_fall && path.barrier() < smallest_barrier * path.fall())
      warnings.push_back("b is " + three_digits(pair.b / pair.r) + " radii, and lambda " +
                         three_digits(pair.lambda()) +
                         ": second neighbors pull, the energy falls by " +
                         three_digits(path.fall()) +
                         " k r^2 per particle from FCC to BCC, and the body may creep or collapse "
                         "at rest, which sinew check tries; set material.lambda to 0.05 or less, "
                         "or material.b to 2.75");
  }
  if (pair.a > 2 * pair.r * (1 + 1e-9))
    warnings.push_back("a is " + three_digits(pair.a / pair.r) +
                       " radii: between 2 and a neighbors do not pull and a free body swells; set "
                       "material.a to 2");
}

void warn_of_step(const StepChoice& steps, Warnings& warnings) {
  const std::string factor =
      "the time step is " + three_digits(steps.factor()) + " of the stability limit: ";
  if (steps.factor() > 1)
    warnings.push_back(factor + "the run will become unstable; use solver.time_step " +
                       three_digits(steps.limit / 2) + " or auto");
  else if (steps.factor() > 0.9)
    warnings.push_back(factor + "bent joints oscillate above 0.9; use solver.time_step auto");
}

void warn_of_speed(double speed, Warnings& warnings) {
  if (speed > fastest_bone)
    warnings.push_back("a bone or a support moves particles by " + three_digits(speed) +
                       " radii in a step: the body cannot follow; slow the motion down or shorten "
                       "solver.time_step");
}

std::string bone_of(const Prepared& prepared, const Track& track) {
  return '\'' + prepared.body.skeleton.bones[track.bone].name + '\'';
}

/// The largest rotation of the bone about itself in the track, by rotations and twist, rad.
double turn_about_bone(const Bone& bone, const Track& track) {
  double turned = 0, twisted = 0;
  for (const Quat& rotation : track.rotation.values) {
    const double along = rotation.vec().dot(bone.axis());
    turned = std::max(turned, std::abs(2 * std::atan2(along, std::abs(rotation.w()))));
  }
  for (const double twist : track.twist.values) twisted = std::max(twisted, std::abs(twist));
  return turned + twisted;
}

/// Planes of particles over which a rotation about the bone is distributed.
double planes_of_zone(const Prepared& prepared, double joint_zone, int bone) {
  const double length = joint_zone * std::sqrt(prepared.body.binding.cross_section[bone]);
  return std::max(1.0, length / half_plane_spacing(prepared.body.material.pair.r));
}

/// Bones that turn about themselves by more than flesh can follow, or in too short a zone.
void warn_of_cut(const Prepared& prepared, const Track& track, Warnings& warnings) {
  const Bone& bone = prepared.body.skeleton.bones[track.bone];
  if (bone.parent == no_bone || prepared.weights_given) return;
  const double turn = turn_about_bone(bone, track);
  const double step = degrees(turn) / planes_of_zone(prepared, prepared.joint_zone, track.bone);
  if (step > steepest_joint)
    warnings.push_back("bone " + bone_of(prepared, track) + " turns " +
                       three_digits(degrees(turn)) + " degrees about itself, " +
                       three_digits(step) +
                       " from one plane of particles to the next: that cuts the body; set "
                       "binding.joint_zone to 3 or more and binding.twist_stiffness to 6.4");
  if (degrees(turn) > largest_turn)
    warnings.push_back("bone " + bone_of(prepared, track) + " turns " +
                       three_digits(degrees(turn)) +
                       " degrees about itself against its parent: beyond 180 flesh between them "
                       "is pulled the shorter way round, and snaps; divide the turn among several "
                       "bones, each by 90 or less");
}

/// Where the rig lies, if that is not where the body is, and what helps.
std::string place_of_rig(const Body& body) {
  const Box rig = bounds(body.skeleton), flesh = bounds(body.rest);
  const std::string cure =
      "; set skeleton.fit to mesh, or give skeleton scale, rotation and offset";
  const double ratio = rig.diagonal().norm() / flesh.diagonal().norm();
  if (ratio > 3 || ratio < 1.0 / 3)
    return ": the rig is " + three_digits(ratio) + " times as large as the body" + cure;
  const double beside = std::sqrt(rig.squaredExteriorDistance(flesh));
  if (beside > 0) return ": the rig lies " + three_digits(beside) + " m beside the body" + cure;
  return "; move them into the body, or remove them";
}

void warn_of_idle_bones(const Body& body, Warnings& warnings) {
  std::vector<std::string_view> idle;
  for (std::size_t b = 0; b < body.skeleton.size(); ++b)
    if (!(body.binding.cross_section[b] > 0)) idle.emplace_back(body.skeleton.bones[b].name);
  if (idle.empty()) return;
  std::string names = shown(std::string(idle.front()));
  if (idle.size() > 1) names += " and " + std::to_string(idle.size() - 1) + " more";
  warnings.push_back("no particle follows " + std::to_string(idle.size()) + " of " +
                     std::to_string(body.skeleton.size()) + " bones (" + names + ")" +
                     place_of_rig(body));
}

/// Scale of joints without flesh shows nowhere.
void warn_of_scale(const Prepared& prepared, Warnings& warnings) {
  std::vector<bool> pulling;
  for (const double section : prepared.body.binding.cross_section) pulling.push_back(section > 0);
  std::string warning = scale_warning(prepared.body.skeleton, prepared.motion, pulling);
  if (!warning.empty()) warnings.push_back(std::move(warning));
}

/// Angles of 1.57 and the like, all of them small.
void warn_of_radians(const Prepared& prepared, Warnings& warnings) {
  constexpr double twelfth = pi / 12, rounding = 0.005;  // rounding of numbers with two decimals
  double largest = 0;
  for (const Track& track : prepared.motion.tracks)
    for (const Quat& rotation : track.rotation.values)
      largest = std::max(largest, degrees(rotation_vector(rotation).norm()));
  const double parts = std::round(largest / twelfth), off = largest - parts * twelfth;
  if (largest > 2 * pi || parts < 2 || std::abs(off) > rounding) return;
  if (std::abs(largest - std::round(largest)) < 1e-9) return;  // whole degrees
  warnings.push_back("the largest rotation of a bone is " + three_digits(largest) +
                     " degrees, which is " + three_digits(degrees(largest)) +
                     " degrees in radians: angles are in degrees");
}

/// Sizes that no soft body has: a unit is wrong.
void warn_of_unit(const Body& body, Warnings& warnings) {
  constexpr double large = 30, small = 1e-3;  // m
  const double size = bounds(body.rest).diagonal().norm();
  if (size <= large && size >= small) return;
  warnings.push_back("the body is " + three_digits(size) + " m across: if that is not its size, " +
                     (size > large ? "set body.unit to mm or cm" : "make body.scale larger"));
}

/// Finds the distance from each bone, m, beyond which a particle's lever arm is too long.
std::vector<double> longest_arms(const Body& body) {
  const double half = bounds(body.rest).diagonal().norm() / 2;
  std::vector<double> arms;
  arms.reserve(body.skeleton.size());
  for (const double section : body.binding.cross_section)
    arms.push_back(std::min(half, far_from_bone * std::sqrt(section)));
  return arms;
}

void warn_of_far_particles(const Body& body, Warnings& warnings) {
  const std::size_t bones = body.skeleton.size();
  const std::vector<double> limit = longest_arms(body);
  std::vector<double> farthest(bones, 0.0);
  std::vector<std::size_t> count(bones, 0);
  for (std::size_t i = 0; i < body.rest.size(); ++i) {
    const int bone = body.binding.bone(i);
    if (bone == no_bone) continue;
    const double distance = distance_to(body.skeleton.bones[bone], body.rest[i]);
    if (distance > limit[bone]) ++count[bone];
    farthest[bone] = std::max(farthest[bone], distance);
  }
  std::size_t worst = bones;
  for (std::size_t b = 0; b < bones; ++b)
    if (count[b] > 0 && (worst == bones || farthest[b] > farthest[worst])) worst = b;
  if (worst == bones) return;
  const auto others = std::count_if(count.begin(), count.end(), [](auto n) { return n > 0; }) - 1;
  warnings.push_back(
      std::to_string(count[worst]) + " particles of bone '" + body.skeleton.bones[worst].name +
      "' are farther from it than " + three_digits(limit[worst]) + " m, up to " +
      three_digits(farthest[worst]) + " m" +
      (others > 0 ? " (and some of " + std::to_string(others) + " more bones)" : "") +
      "; add a bone there, or let them follow the others by binding.core_radius");
}

void warn_of_unreached(const Binding& binding, Warnings& warnings) {
  if (binding.unreached > 0)
    warnings.push_back(
        std::to_string(binding.unreached) +
        " particles are reached from no bone inside the body and follow the nearest "
        "by straight distance; close the body's gaps, or give it a bone in each piece");
}

/// Whether an edge is longer than both bones that its ends are nearest to; no bone is shorter than
/// `shortest`, m.
bool spans_bones(const Skeleton& skeleton, double shortest, const Vec3& from, const Vec3& to) {
  if ((to - from).norm() <= shortest) return false;  // nearly all, without a search
  const int a = nearest_bone(skeleton, from), b = nearest_bone(skeleton, to);
  const double longer = std::max(skeleton.bones[a].length, skeleton.bones[b].length);
  return a != b && (to - from).norm() > longer;
}

/// The surface follows the particles at its points alone.
void warn_of_coarse_surface(const Prepared& prepared, Warnings& warnings) {
  if (prepared.motion.tracks.empty()) return;
  const Skeleton& skeleton = prepared.body.skeleton;
  const Triangles& surface = prepared.surface.triangles;
  double shortest = skeleton.bones.front().length;
  for (const Bone& bone : skeleton.bones) shortest = std::min(shortest, bone.length);
  std::size_t count = 0;
  for (const auto& face : surface.faces) {
    bool spans = false;
    for (int k = 0; k < 3; ++k)
      spans = spans || spans_bones(skeleton, shortest, surface.points[face[k]],
                                   surface.points[face[(k + 1) % 3]]);
    count += spans;
  }
  if (count > 0)
    warnings.push_back(std::to_string(count) +
                       " faces of the mesh reach from bone to bone with edges longer than both: "
                       "the surface cannot bend there as the particles do; subdivide the mesh");
}

/// The same where a machine bends it between its points.
void warn_of_large_faces(const Prepared& prepared, Warnings& warnings) {
  const World* world = prepared.body.world.get();
  if (world == nullptr || (world->supports.empty() && world->loads.empty())) return;
  const Triangles& surface = prepared.surface.triangles;
  const double longest = largest_face * nearest_distance(prepared.body.material.pair.r);
  const auto side = [&](const std::array<int, 3>& face, int k) {
    return (surface.points[face[k]] - surface.points[face[(k + 1) % 3]]).norm();
  };
  const auto count =
      std::count_if(surface.faces.begin(), surface.faces.end(), [&](const auto& face) {
        return std::max({side(face, 0), side(face, 1), side(face, 2)}) > longest;
      });
  if (count > 0)
    warnings.push_back(std::to_string(count) +
                       " faces of the mesh are longer than four particles: where supports and "
                       "loads bend the body, the written surface stays flat between its points "
                       "(volumes, areas and sections are measured on a finer one); subdivide the "
                       "mesh");
}

/// A body that begins inside an obstacle is pushed out of it violently.
void warn_of_overlaps(const Prepared& prepared, Warnings& warnings) {
  if (!prepared.body.world) return;
  const World& world = *prepared.body.world;
  const WorldNow start = world_at(world, 0, pose_at(prepared.body.skeleton, prepared.motion, 0));
  const double r = prepared.body.material.pair.r;
  for (std::size_t k = 0; k < world.obstacles.size(); ++k) {
    std::size_t count = 0;
    for (const Vec3& place : prepared.body.rest) {
      const double pressing =
          contact(world.obstacles[k], start.obstacles[k], place, Vec3::Zero(), r).pressing;
      count += pressing > deepest_start * r * world.obstacles[k].stiffness;
    }
    if (count > 0)
      warnings.push_back(std::to_string(count) + " particles begin over " +
                         three_digits(deepest_start) + " radii within obstacle '" +
                         world.obstacles[k].name +
                         "', which throws them out; move it away from the body");
  }
}

/// Measured on bars of 2e5 particles, paper's and bonded, as they begin to bend: with 0.19 of them
/// within groups, steps took 1.05 times as long, with 0.3 0.9 times, with 0.53 0.5 to 0.7 times.
constexpr double groups_pay_from = 0.3;

void warn_of_groups(const Grouping* grouping, Warnings& warnings) {
  if (grouping == nullptr) return;
  const double within = static_cast<double>(grouping->inside()) /
                        static_cast<double>(std::max<std::size_t>(1, grouping->group.size()));
  if (within < groups_pay_from)
    warnings.push_back(three_digits(100 * within) +
                       " % of the particles are within groups: they pay "
                       "from about " +
                       three_digits(100 * groups_pay_from) +
                       " % on; make body.radius or hierarchy.joint_distance smaller, or set "
                       "hierarchy.enabled to false");
}

/// Loads that act on particles which are held on all axes.
void warn_of_idle_loads(const World* world, Warnings& warnings) {
  constexpr double mostly = 0.5;
  if (world == nullptr) return;
  std::set<std::uint32_t> held;
  for (const Pinned& pin : world->pins)
    if (pin.holds(0) && pin.holds(1) && pin.holds(2)) held.insert(pin.particle);
  for (const Load& load : world->loads) {
    double idle = 0, all = 0;  // weights below 0 balance those of particles nearer to the surface
    for (std::size_t n = 0; n < load.particles.size(); ++n) {
      all += std::abs(load.weight[n]);
      if (held.contains(load.particles[n])) idle += std::abs(load.weight[n]);
    }
    if (idle > mostly * all)
      warnings.push_back("load '" + load.name +
                         "' acts on held particles, which it does not move; give it a part that is "
                         "free");
  }
}

/// Bones that carry no particle by a radius, with nothing else to move the body.
void warn_of_still_body(const Prepared& prepared, Warnings& warnings) {
  const Body& body = prepared.body;
  const World* world = body.world.get();
  const bool pushed =
      world != nullptr && (!world->obstacles.empty() || !world->fields.empty() ||
                           !world->supports.empty() || !world->loads.empty() || has_muscles(body));
  if (prepared.motion.tracks.empty() || pushed || !prepared.settings.solver.gravity.isZero(0))
    return;
  constexpr int moments = 60;
  const double r = body.material.pair.r;
  for (int k = 0; k <= moments; ++k) {
    const Pose pose =
        pose_at(body.skeleton, prepared.motion, prepared.settings.solver.duration * k / moments);
    for (std::size_t i = 0; i < body.rest.size(); ++i) {
      const int bone = body.binding.bone(i);
      if (bone == no_bone) continue;
      const Vec3 moved = pose[bone].carried(body.rest[i], body.skeleton.bones[bone]);
      if ((moved - body.rest[i]).norm() > r) return;
    }
  }
  warnings.push_back(
      "no bone moves any particle by its radius: the body stays as it is; give "
      "motion.tracks to bones that hold particles");
}

void warn_of_memory(const Needs& needs, Warnings& warnings) {
  const double available = available_memory(), needed = static_cast<double>(needs.memory);
  if (needed > available)
    warnings.push_back("the run needs about " + bytes_text(needed) + " of memory, " +
                       bytes_text(available) +
                       " are free: make body.radius larger, or use solver.precision single");
}

/// Where automatic creep cannot be as fast as the scene strains the body.
void warn_of_flow(const Prepared& prepared, Warnings& warnings) {
  const double above = stress_above_yield(prepared);
  if (above > largest_overstress)
    warnings.push_back("creep is bounded to " +
                       three_digits(prepared.body.material.bond.creep_rate) +
                       "/s by the step: where the scene strains the body fastest, it bears up to " +
                       three_digits(100 * above) +
                       " % more than its yield stress; set material.creep_rate, or a shorter "
                       "solver.time_step");
}

}  // namespace

std::vector<std::string> warnings_of(const Prepared& prepared, double bone_speed) {
  Warnings warnings = prepared.file_warnings;
  if (!law_of(prepared.body.material).has_bonds)
    warn_of_material(prepared.body.material.pair, warnings);
  warn_of_step(prepared.steps, warnings);
  for (std::string& note : costly_choices(prepared)) warnings.push_back(std::move(note));
  warn_of_flow(prepared, warnings);
  if (grows(prepared.settings, prepared.body))
    warnings.push_back(
        "explicit Euler without damping of bones or material, as the paper prints it, lets every "
        "vibration grow: with a step of " +
        three_digits(prepared.steps.limit) + " s by a factor of e within the scene's " +
        three_digits(prepared.settings.solver.duration) +
        " s; use symplectic_euler, or give material.damping and binding.bone_damping");
  warn_of_speed(bone_speed, warnings);
  for (const Track& track : prepared.motion.tracks) warn_of_cut(prepared, track, warnings);
  for (std::string& warning :
       motion_warnings(prepared.body.skeleton, prepared.motion,
                       min_shift * prepared.body.material.pair.r, prepared.beginning.posed))
    warnings.push_back(std::move(warning));
  warn_of_scale(prepared, warnings);
  warn_of_groups(prepared.body.grouping.get(), warnings);
  warn_of_unit(prepared.body, warnings);
  warn_of_radians(prepared, warnings);
  warn_of_idle_bones(prepared.body, warnings);
  warn_of_idle_loads(prepared.body.world.get(), warnings);
  warn_of_far_particles(prepared.body, warnings);
  warn_of_unreached(prepared.body.binding, warnings);
  warn_of_overlaps(prepared, warnings);
  warn_of_coarse_surface(prepared, warnings);
  warn_of_large_faces(prepared, warnings);
  warn_of_contacts(prepared, warnings);
  for (const std::string& note :
       thin_part_notes(prepared.settings.binding, prepared.body, prepared.steps.step))
    warnings.push_back(note);
  warn_of_still_body(prepared, warnings);
  return warnings;
}

std::vector<std::string> warnings_before_trials(const Prepared& prepared, double bone_speed) {
  Warnings warnings = warnings_of(prepared, bone_speed);
  warn_of_stiffness(prepared, warnings);
  warn_of_memory(needs_of(prepared), warnings);
  for (std::string& warning : fill_warnings(prepared.filled))
    warnings.push_back(std::move(warning));
  shortest_first(warnings);
  return warnings;
}

void shortest_first(Warnings& warnings) {
  std::sort(warnings.begin(), warnings.end(), [](const std::string& a, const std::string& b) {
    return std::pair(a.size(), std::string_view(a)) < std::pair(b.size(), std::string_view(b));
  });
  warnings.erase(std::unique(warnings.begin(), warnings.end()), warnings.end());
}

}  // namespace sinew
