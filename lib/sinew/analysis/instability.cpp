// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/analysis/instability.h>

#include <algorithm>
#include <cmath>

#include <sinew/analysis/time_step.h>
#include <sinew/core/text.h>
#include <sinew/world/world.h>

namespace sinew {

namespace {

// In radii: how far a bone may carry a particle in a step, and one of its forces may move it, until
// these are the cause; what is sure to do no harm; and how far from its place on the bone a
// particle is when the bone has left it.
constexpr double fast = 0.25, strong = 0.05, harmless = 0.04, left_behind = 6;

std::string step_text(double step) { return "solver.time_step " + three_digits(step) + " or less"; }

std::string in_a_step(double radii) { return three_digits(radii) + " r in one step"; }

/// "fields, loads, muscles": what a world has beside obstacles.
std::string what_acts(const World& world) {
  std::vector<std::string_view> names;
  if (!world.fields.empty()) names.push_back("fields");
  if (!world.loads.empty()) names.push_back("loads");
  if (world.drag.rate > 0) names.push_back("drag");
  if (!world.muscles.muscles.empty()) names.push_back("muscles");
  return names.empty() ? "surroundings" : listed(names);
}

/// One particle of a step that failed. Distances in radii.
class Diagnosis {
 public:
  Diagnosis(const FailedStep& failed, std::size_t particle)
      : failed_(failed),
        i_(particle),
        id_(static_cast<std::size_t>(failed.particles.id[particle])),
        step_(failed.stepping.step),
        limit_(limit_of(failed)) {}

  bool is_over_limit() const { return limit_ > 0 && step_ > limit_; }
  bool is_of_all_steps() const { return is_over_limit() || weight() > strong; }

  std::string text() const {
    if (is_over_limit())
      return "the step of " + three_digits(step_) + " s is over the limit of the body at rest, " +
             three_digits(limit_) + " s; use " + step_text(limit_ / 2);
    if (weight() > strong)
      return "gravity alone moves it " + in_a_step(weight()) +
             "; give solver.gravity in m/s^2 (9.81 on earth), or a stiffer material";
    std::string by_bone = cause_by_bone();
    if (!by_bone.empty()) return by_bone;
    std::string by_world = cause_by_world();
    if (!by_world.empty()) return by_world;
    return "its neighbors push it; use " + step_text(step_ / 4);
  }

 private:
  /// How far a force (N) moves it in the step.
  double by_force(const Vec3& force) const {
    return force.norm() / failed_.particles.mass * step_ * step_ / failed_.particles.radius;
  }
  double weight() const { return by_force(failed_.particles.mass * failed_.stepping.gravity); }
  Vec3 position() const { return failed_.particles.position(i_); }

  std::string cause_by_bone() const {
    const int number = failed_.body.binding.bone(id_);
    if (number == no_bone) return "";
    const BonePose& bone = failed_.pose[static_cast<std::size_t>(number)];
    const Bone& rest = failed_.body.skeleton.bones[static_cast<std::size_t>(number)];
    const double radius = failed_.particles.radius;
    const Vec3 target = bone.carried(failed_.body.rest[id_], rest);
    const double speed = bone.velocity_at(target).norm() * step_ / radius;
    if (speed > fast)
      return "bone '" + rest.name + "' carries it " + in_a_step(speed) +
             "; slow the motion there, or use " + step_text(step_ * harmless / speed);
    const double behind = (position() - target).norm() / radius;
    const double pull = by_force(failed_.forces.bone[i_]);
    if (behind > left_behind && pull > strong && pull > by_force(failed_.forces.pair[i_]))
      return "bone '" + rest.name + "' has left it " + three_digits(behind) +
             " r behind; begin near the pose at rest (motion.preroll), slow the motion, or use " +
             step_text(step_for(failed_.forces.bone[i_].norm() * behind * radius / 2));
    return "";
  }

  std::string cause_by_world() const {
    if (!failed_.body.world || failed_.forces.world.empty()) return "";
    const Vec3& force = failed_.forces.world[i_];
    const double push = by_force(force);
    if (push < strong || push < by_force(failed_.forces.pair[i_])) return "";
    const World& world = *failed_.body.world;
    const WorldNow now = world_at(world, failed_.time, failed_.pose);
    double most = force.norm() / 2;
    const Obstacle* strongest = nullptr;
    double energy = 0;
    for (std::size_t k = 0; k < world.obstacles.size(); ++k) {
      const Contact touch = contact(world.obstacles[k], now.obstacles[k], position(),
                                    failed_.particles.velocity(i_), failed_.particles.radius);
      if (touch.force().norm() <= most) continue;
      most = touch.force().norm();
      energy = touch.energy;
      strongest = &world.obstacles[k];
    }
    if (strongest != nullptr)
      return "obstacle '" + strongest->name + "' pushes it out by " + in_a_step(push) +
             "; keep it off the body at rest, move it more slowly, lower its stiffness, or use " +
             step_text(step_for(energy));
    return what_acts(world) + " move it " + in_a_step(push) +
           "; lower their strength, or choose a stiffer material";
  }

  static double limit_of(const FailedStep& failed) {
    WorldLoad load;
    if (failed.body.world)
      load = {added_stiffness(*failed.body.world, failed.particles),
              added_damping(*failed.body.world, failed.particles)};
    return step_limit(failed.stepping.integrator, failed.body, load);
  }

  /// The step in which it moves no farther than is harmless once a spring has turned its energy
  /// (J) into motion.
  double step_for(double energy) const {
    const double speed = std::sqrt(2 * energy / failed_.particles.mass);
    return std::min(step_ / 2, 2 * harmless * failed_.particles.radius / speed);
  }

  const FailedStep& failed_;
  std::size_t i_, id_;
  double step_, limit_;  ///< s
};

}  // namespace

bool is_of_all_steps(const FailedStep& failed, std::size_t particle) {
  return Diagnosis(failed, particle).is_of_all_steps();
}

std::string cause_and_cure(const FailedStep& failed, std::size_t particle) {
  return Diagnosis(failed, particle).text();
}

Error unstable(const FailedStep& failed, std::size_t particle, bool finite) {
  const std::int32_t id = failed.particles.id[particle];
  const auto bones = failed.body.binding.of(static_cast<std::size_t>(id));
  const std::string where =
      bones.empty() ? "" : " on bone '" + failed.body.skeleton.bones[bones.front().bone].name + "'";
  const std::string what =
      finite ? " moved over " + three_digits(max_radii_per_step) +
                   (bones.empty() ? " r relative to its previous motion in one step"
                                  : " r relative to its bone in one step")
             : std::string(" reached a value that is not finite");
  return Error(Exit::unstable, "step " + std::to_string(failed.steps) + " at " +
                                   three_digits(failed.time) + " s: particle " +
                                   std::to_string(id) + where + what + ": " +
                                   cause_and_cure(failed, particle));
}

}  // namespace sinew
