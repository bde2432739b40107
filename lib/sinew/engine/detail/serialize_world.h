// SPDX-License-Identifier: GPL-3.0-or-later
// The members of a world as engines know it, for archive.h.
#pragma once

#include <sinew/core/archive.h>
#include <sinew/world/world.h>

namespace sinew {

template <class Archive>
void serialize(Archive& archive, PlaneShape& plane) {
  archive(plane.point);
  archive(plane.normal);
}

template <class Archive>
void serialize(Archive& archive, SphereShape& sphere) {
  archive(sphere.center);
  archive(sphere.radius);
}

template <class Archive>
void serialize(Archive& archive, CapsuleShape& capsule) {
  archive(capsule.a);
  archive(capsule.b);
  archive(capsule.radius);
}

template <class Archive>
void serialize(Archive& archive, BoxShape& box) {
  archive(box.center);
  archive(box.half);
  archive(box.rotation);
}

/// Refused before: see core/capabilities.h.
template <class Archive>
void serialize(Archive&, MeshShape&) {}
template <class Archive>
void serialize(Archive&, CustomForce&) {}

template <class Archive>
void serialize(Archive& archive, Region& region) {
  archive(region.shape);
  archive(region.falloff);
}

template <class Archive>
void serialize(Archive& archive, KeyedValue& keys) {
  archive(keys.times);
  archive(keys.values);
}

template <class Archive>
void serialize(Archive& archive, Obstacle& obstacle) {
  archive(obstacle.name);
  archive(obstacle.shape);
  for (double* value :
       {&obstacle.stiffness, &obstacle.damping, &obstacle.friction, &obstacle.stick})
    archive(*value);
  archive(obstacle.bone);
}

template <class Archive>
void serialize(Archive& archive, UniformAcceleration& form) {
  archive(form.acceleration);
}

template <class Archive>
void serialize(Archive& archive, ForceDensity& form) {
  archive(form.density);
}

template <class Archive>
void serialize(Archive& archive, Attraction& form) {
  archive(form.point);
  archive(form.acceleration);
  archive(form.core);
}

template <class Archive>
void serialize(Archive& archive, Swirl& form) {
  archive(form.point);
  archive(form.axis);
  archive(form.acceleration);
  archive(form.core);
}

template <class Archive>
void serialize(Archive& archive, ForceField& field) {
  archive(field.name);
  archive(field.form);
  archive(field.region);
  archive(field.scale);
}

template <class Archive>
void serialize(Archive& archive, Pinned& pin) {
  archive(pin.particle);
  archive(pin.bone);
  for (std::int32_t& support : pin.support) archive(support);
  archive(pin.along);
}

template <class Archive>
void serialize(Archive& archive, Support& support) {
  archive(support.name);
  for (bool& axis : support.holds) archive(axis);
  archive(support.pivot);
  archive(support.along);
}

template <class Archive>
void serialize(Archive& archive, Load& load) {
  archive(load.name);
  archive(load.scale);
  archive(load.particles);
  archive(load.weight);
  archive(load.force);
  archive(load.pivot);
}

template <class Archive>
void serialize(Archive& archive, World& world) {
  archive(world.obstacles);
  archive(world.drag.rate);
  archive(world.drag.velocity);
  archive(world.fields);
  archive(world.pins);
  archive(world.supports);
  archive(world.loads);
}

}  // namespace sinew
