// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/warnings.h"

#include <algorithm>
#include <cmath>

#include "core/closest_packing.h"
#include "core/number_text.h"
#include "physics/world/world.h"
#include "rig/motion_warnings.h"

namespace sinew {
namespace {

using Warnings = std::vector<std::string>;

// Beyond this the second neighbours, at 2.83 r, weaken the packing at rest: noise grows.
constexpr double largest_stable_b = 2.75;
constexpr double fastest_bone = 0.5;  // radii per step: more, and neighbours are passed, not pushed
constexpr double deepest_start = 0.1;  // radii within an obstacle: more is seen as a kick
constexpr double least_shift = 0.1;    // radii that a bone may jump unnoticed
// In square roots of what a bone holds of the cross-section: 0.6 is the rim of a round limb.
constexpr double far_from_bone = 3;
constexpr double steepest_joint = 5;  // degrees between two planes: more, and bonds break

void warn_of_material(const PairForce& pair, Warnings& warnings) {
  if (pair.b > largest_stable_b * pair.r)
    warnings.push_back("b is " + three_digits(pair.b / pair.r) +
                       " radii: second neighbours at 2.83 weaken the packing until it collapses by "
                       "itself; set material.b to 2.75 or less");
  if (pair.a > 2 * pair.r * (1 + 1e-9))
    warnings.push_back("a is " + three_digits(pair.a / pair.r) +
                       " radii: between 2 and a neighbours do not pull and a free body swells; set "
                       "material.a to 2");
}

void warn_of_step(const StepChoice& steps, Warnings& warnings) {
  const std::string share =
      "the time step is " + three_digits(steps.factor()) + " of the stability limit: ";
  if (steps.factor() > 1)
    warnings.push_back(share + "the run will become unstable; use solver.time_step " +
                       three_digits(steps.limit / 2) + " or auto");
  else if (steps.factor() > 0.9)
    warnings.push_back(share + "bent joints rattle above 0.9; use solver.time_step auto");
}

void warn_of_speed(double speed, Warnings& warnings) {
  if (speed > fastest_bone)
    warnings.push_back("a bone moves particles by " + three_digits(speed) +
                       " radii in a step: the body cannot follow; slow the motion down or shorten "
                       "solver.time_step");
}

std::string bone_of(const Setup& setup, const Track& track) {
  return '\'' + setup.body.skeleton.bones[track.bone].name + '\'';
}

/// How far the track turns the bone about itself at most, by its rotations and its twist, rad.
double turn_about_bone(const Bone& bone, const Track& track) {
  double turned = 0, twisted = 0;
  for (const Quat& rotation : track.rotation.values) {
    const double along = rotation.vec().dot(bone.axis());
    turned = std::max(turned, std::abs(2 * std::atan2(along, std::abs(rotation.w()))));
  }
  for (const double twist : track.twist.values) twisted = std::max(twisted, std::abs(twist));
  return turned + twisted;
}

/// Planes of particles over which a turn about the bone is spread.
double planes_of_zone(const Setup& setup, double joint_zone, int bone) {
  const double length = joint_zone * std::sqrt(setup.body.binding.cross_section[bone]);
  return std::max(1.0, length / half_plane_spacing(setup.body.material.pair.r));
}

void warn_of_cut(const Setup& setup, const Track& track, Warnings& warnings) {
  const Bone& bone = setup.body.skeleton.bones[track.bone];
  if (bone.parent == no_bone || setup.weights_given) return;
  const double turn = turn_about_bone(bone, track);
  const double step = degrees(turn) / planes_of_zone(setup, setup.joint_zone, track.bone);
  if (step > steepest_joint)
    warnings.push_back("bone " + bone_of(setup, track) + " turns " + three_digits(degrees(turn)) +
                       " degrees about itself, " + three_digits(step) +
                       " from one plane of particles to the next: that cuts the body; set "
                       "binding.joint_zone to 3 or more and binding.twist_stiffness to 6.4");
}

void warn_of_idle_bones(const Body& body, Warnings& warnings) {
  for (std::size_t b = 0; b < body.skeleton.size(); ++b)
    if (!(body.binding.cross_section[b] > 0))
      warnings.push_back("no particle follows bone '" + body.skeleton.bones[b].name +
                         "'; move it into the body");
}

/// Particles farther from their bone than this are held by a long arm, m.
double longest_arm(const Body& body, int bone) {
  Box box;
  for (const Vec3& point : body.rest) box.extend(point);
  return std::min(box.diagonal().norm() / 2,
                  far_from_bone * std::sqrt(body.binding.cross_section[bone]));
}

void warn_of_far_particles(const Body& body, Warnings& warnings) {
  const std::size_t bones = body.skeleton.size();
  std::vector<double> limit, farthest(bones, 0.0);
  for (std::size_t b = 0; b < bones; ++b) limit.push_back(longest_arm(body, static_cast<int>(b)));
  std::vector<std::size_t> count(bones, 0);
  for (std::size_t i = 0; i < body.rest.size(); ++i) {
    const int bone = body.binding.bone(i);
    if (bone == no_bone) continue;
    const double distance = distance_to(body.skeleton.bones[bone], body.rest[i]);
    if (distance > limit[bone]) ++count[bone];
    farthest[bone] = std::max(farthest[bone], distance);
  }
  for (std::size_t b = 0; b < bones; ++b)
    if (count[b] > 0)
      warnings.push_back(std::to_string(count[b]) + " particles of bone '" +
                         body.skeleton.bones[b].name + "' are farther from it than " +
                         three_digits(limit[b]) + " m, up to " + three_digits(farthest[b]) +
                         " m; add a bone there, or let them follow the others by "
                         "binding.core_radius");
}

void warn_of_unreached(const Binding& binding, Warnings& warnings) {
  if (binding.unreached > 0)
    warnings.push_back(std::to_string(binding.unreached) +
                       " particles are reached from no bone inside the body and follow the nearest "
                       "through the air; close the body's gaps, or give it a bone in each piece");
}

void warn_of_cells(const Setup& setup, const SolverSettings& solver, Warnings& warnings) {
  const StepWay way = step_way(solver, setup.body, setup.motion);
  if (!way.unserved || setup.body.material.model != MaterialModel::paper) return;
  const auto& [key, value, served] = *way.unserved;
  std::string warning = key;
  warning += " is " + value + ", which lists of partners do not know: steps use the paper's cells";
  if (solver.precision == Precision::binary32) warning += ", in double precision";
  warning += ", about " + three_digits(std::round(slowness_of_cells(solver.precision))) +
             " times slower; use " + key + ' ' + served + " where its difference does not matter";
  warnings.push_back(warning);
}

/// A body that begins within an obstacle is thrown out of it.
void warn_of_overlaps(const Setup& setup, Warnings& warnings) {
  if (!setup.body.world) return;
  const World& world = *setup.body.world;
  const WorldNow start = world_at(world, 0, pose_at(setup.body.skeleton, setup.motion, 0));
  const double r = setup.body.material.pair.r;
  for (std::size_t k = 0; k < world.obstacles.size(); ++k) {
    std::size_t count = 0;
    for (const Vec3& place : setup.body.rest) {
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

}  // namespace

std::vector<std::string> warnings_of(const Setup& setup, const SolverSettings& solver,
                                     double bone_speed) {
  Warnings warnings;
  if (setup.body.material.model == MaterialModel::paper)
    warn_of_material(setup.body.material.pair, warnings);
  warn_of_step(setup.steps, warnings);
  warn_of_speed(bone_speed, warnings);
  for (const Track& track : setup.motion.tracks) warn_of_cut(setup, track, warnings);
  for (std::string& warning :
       motion_warnings(setup.body.skeleton, setup.motion, least_shift * setup.body.material.pair.r))
    warnings.push_back(std::move(warning));
  warn_of_idle_bones(setup.body, warnings);
  warn_of_far_particles(setup.body, warnings);
  warn_of_unreached(setup.body.binding, warnings);
  warn_of_cells(setup, solver, warnings);
  warn_of_overlaps(setup, warnings);
  return warnings;
}

}  // namespace sinew
