// SPDX-License-Identifier: GPL-3.0-or-later
// Surroundings of a body of particles of 1 cm: walls that move, pins, fields, muscles, a testing
// machine, and all.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <sinew/world/world.h>

#include "support/world.h"

namespace sinew::surroundings {

inline constexpr double r = 0.01;

inline Obstacle obstacle(const Material& material, const Shape& shape, double friction) {
  Obstacle made;
  made.name = "wall";
  made.shape = shape;
  made.motion = [](double time, const Pose&) {
    return ObstaclePose{{{0.05 * time, 0, 0}, Mat3::Identity()}, {0.05, 0, 0}, Vec3::Zero()};
  };
  made.stiffness = material.pair.contact_stiffness();
  made.damping = 0.5 * std::sqrt(made.stiffness * material.mass);
  made.friction = friction;
  return made;
}

struct Around {
  std::string name;
  std::function<void(const Points& rest, const Material&, World&)> surround;
};

inline std::vector<Around> all_surroundings() {
  const auto walls = [](const Points& rest, const Material& material, World& world) {
    world.obstacles = {
        obstacle(material, PlaneShape{{rest.front().x() - 0.9 * r, 0, 0}, {1, 0, 0}}, 0.4),
        obstacle(material, SphereShape{rest.back() + Vec3(2 * r, 0, 2 * r), 2 * r}, 0)};
    world.obstacles[1].friction = 0.2;
    world.obstacles[1].stick = 0.1 * material.mass / 1e-3;
  };
  const auto pins = [](const Points& rest, const Material&, World& world) {
    world.pins = pinned(rest,
                        {{{BoxShape{rest.front(), {1, 1, 1.5 * r}}, 0}, no_bone},
                         {{BoxShape{rest.back(), {1, 1, 1.5 * r}}, 0}, 1}},
                        2);
  };
  const auto fields = [](const Points& rest, const Material&, World& world) {
    world.drag = {2, {0.1, 0, 0}};
    world.fields = {{"wind", UniformAcceleration{{2, 0, 0}}, {}, {{0, 0.02}, {0, 1}}},
                    {"pull", Attraction{rest.back(), 3, 2 * r}, {}, {}}};
  };
  const auto muscles = [](const Points& rest, const Material&, World& world) {
    Muscle whole, part;
    whole.name = "whole";
    whole.strength = 600;
    whole.activation = {{0, 0.02}, {0, 1}};
    whole.weights = weights_in({}, rest);
    part.name = "part";
    part.direction = {1, 0.2, 0};
    part.strength = 400;
    part.weights = weights_in({SphereShape{rest.back(), 3 * r}, 0.02}, rest);
    world.muscles = make_muscles(rest, r, {whole, part});
  };
  const auto machine = [](const Points& rest, const Material&, World& world) {
    const auto middle = static_cast<std::uint32_t>(rest.size() / 2);
    const Vec3 pivot = rest[middle];
    Support roller{"roller", {middle, middle + 1}, {true, false, true}}, grip = roller;
    grip = {"grip", {middle + 5, middle + 6}, {true, true, false}};
    grip.pivot = pivot;
    grip.motion = [pivot](double time, const Pose&) {
      const Mat3 turn = Eigen::AngleAxisd(3 * time, Vec3::UnitZ()).toRotationMatrix();
      return ObstaclePose{{pivot + time * Vec3(0.02, 0, 0.1), turn}, {0.02, 0, 0.1}, {0, 0, 3}};
    };
    world.supports = {roller, grip};
    const Vec3 size(2.5 * r, 0, 0), up(0, 0, 3 * r);
    const Triangles sheet{{pivot - size, pivot + size, pivot + up}, {{0, 1, 2}}};
    world.loads = {force_load("pull", {1, 3, 4}, {1, 2, 1}, {0.01, 0, 0.02}, rest),
                   pressure_load("press", sheet, 500, rest, r)};
    world.loads[0].scale = {{0, 0.02}, {0, 1}};
    hold(world, rest.size());
  };
  const auto all = [=](const Points& rest, const Material& material, World& world) {
    for (const auto& part : {std::function<void(const Points&, const Material&, World&)>(walls),
                             {pins},
                             {fields},
                             {muscles},
                             {machine}})
      part(rest, material, world);
  };
  return {{"nothing", nullptr}, {"walls", walls},     {"pins", pins}, {"fields", fields},
          {"muscles", muscles}, {"machine", machine}, {"all", all}};
}

}  // namespace sinew::surroundings
