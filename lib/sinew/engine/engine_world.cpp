// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/engine/engine_world.h>

#include <algorithm>
#include <fstream>

#include <sinew/core/error.h>
#include <sinew/core/file.h>

namespace sinew {
namespace {

constexpr std::size_t pose_numbers = 19;
constexpr std::int64_t steps_at_once = 256;

void put(const ObstaclePose& pose, std::vector<double>& numbers) {
  for (const Vec3* part : {&pose.frame.origin, &pose.velocity, &pose.angular_velocity})
    numbers.insert(numbers.end(), part->begin(), part->end());
  numbers.insert(numbers.end(), pose.frame.rotation.data(), pose.frame.rotation.data() + 9);
  numbers.push_back(pose.friction);
}

ObstaclePose pose_at(const double* numbers) {
  ObstaclePose pose;
  for (Vec3* part : {&pose.frame.origin, &pose.velocity, &pose.angular_velocity}) {
    *part = Eigen::Map<const Vec3>(numbers);
    numbers += 3;
  }
  pose.frame.rotation = Eigen::Map<const Mat3>(numbers);
  pose.friction = numbers[9];
  return pose;
}

}  // namespace

World engine_world(const World& world) {
  World known;
  known.obstacles = world.obstacles;
  known.drag = world.drag;
  known.fields = world.fields;
  known.pins = world.pins;
  known.supports = world.supports;
  known.loads = world.loads;
  for (Obstacle& obstacle : known.obstacles) obstacle.motion = {};
  for (Support& support : known.supports) {
    support.motion = {};
    support.particles.clear();  // they are among the pins
  }
  return known;
}

void write_engine_poses(const std::filesystem::path& file, const World& world,
                        const Skeleton& skeleton, const Motion& motion, const StepPlan& plan,
                        std::int64_t first, std::int64_t last) {
  PoseCursor cursor(skeleton, motion);
  NewFile out(file);
  std::vector<double> numbers;
  for (std::int64_t step = first; step <= last; ++step) {
    const double time = plan.time(step);
    const Pose& pose = cursor.at(time);
    for (const Obstacle& obstacle : world.obstacles) put(obstacle.at(time, pose), numbers);
    for (const ObstaclePose& support : poses_of(world.supports, time, pose)) put(support, numbers);
    if (step < last && (step - first) % steps_at_once != 0) continue;
    out.write(numbers.data(), numbers.size() * sizeof(double));
    numbers.clear();
  }
  out.finish();
}

EngineWorld::EngineWorld(std::filesystem::path file, const World& world, std::int64_t first)
    : file_(std::move(file)), world_(world), first_(first) {}

std::size_t EngineWorld::width() const {
  return pose_numbers * (world_.obstacles.size() + world_.supports.size());
}

void EngineWorld::read_from(std::int64_t step) {
  std::ifstream file(file_, std::ios::binary);
  const auto row = static_cast<std::streamoff>(width() * sizeof(double));
  poses_.resize(width() * steps_at_once);
  file.seekg((step - first_) * row);
  file.read(reinterpret_cast<char*>(poses_.data()), row * steps_at_once);
  poses_.resize(static_cast<std::size_t>(file.gcount()) / sizeof(double));
  read_ = step;
  if (poses_.size() < width())
    throw bad_input(Place{file_.string()}, "is truncated or missing", "start the run again");
}

void EngineWorld::go_to(std::int64_t step, double time) {
  now_ = {};
  for (const ForceField& field : world_.fields) now_.scales.push_back(field.scale.at(time));
  for (const Load& load : world_.loads) now_.loads.push_back(load.at(time));
  if (width() == 0) return;
  const auto there = static_cast<std::int64_t>(poses_.size() / width());
  if (step < read_ || step >= read_ + there) read_from(step);
  const double* at = poses_.data() + width() * static_cast<std::size_t>(step - read_);
  for (std::size_t k = 0; k < world_.obstacles.size(); ++k, at += pose_numbers)
    now_.obstacles.push_back(pose_at(at));
  for (std::size_t k = 0; k < world_.supports.size(); ++k, at += pose_numbers)
    now_.supports.push_back(pose_at(at));
}

const Pinned* EngineWorld::held(std::int32_t id) const {
  const auto particle = static_cast<std::uint32_t>(id);
  const auto found =
      std::lower_bound(world_.pins.begin(), world_.pins.end(), particle,
                       [](const Pinned& pin, std::uint32_t other) { return pin.particle < other; });
  return found == world_.pins.end() || found->particle != particle ? nullptr : &*found;
}

Vec3 EngineWorld::load(std::int32_t id) const {
  Vec3 sum = Vec3::Zero();
  for (std::size_t n = 0; n < world_.loads.size(); ++n) {
    const Load& load = world_.loads[n];
    const auto found = std::lower_bound(load.particles.begin(), load.particles.end(),
                                        static_cast<std::uint32_t>(id));
    if (found == load.particles.end() || *found != static_cast<std::uint32_t>(id)) continue;
    const auto k = static_cast<std::size_t>(found - load.particles.begin());
    sum += now_.loads[n].scale * load.weight[k] * load.force;
  }
  return sum;
}

}  // namespace sinew
