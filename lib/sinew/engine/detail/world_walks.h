// SPDX-License-Identifier: GPL-3.0-or-later
// The members of a world as engines know it, for archive.h.
#pragma once

#include <sinew/engine/detail/archive.h>
#include <sinew/world/world.h>

namespace sinew {

/// Makes it the alternative of that number.
template <std::size_t k = 0, class... Forms>
void choose(std::variant<Forms...>& value, std::size_t form) {
  if constexpr (k == sizeof...(Forms))
    throw bad_input("it is truncated or damaged", "start the run again");
  else if (k == form)
    value.template emplace<k>();
  else
    choose<k + 1>(value, form);
}

template <class Transfer, class... Forms>
void walk(std::variant<Forms...>& value, Transfer& transfer) {
  auto form = static_cast<std::uint8_t>(value.index());
  transfer(form);
  if (form != value.index()) choose(value, form);
  std::visit([&](auto& one) { walk(one, transfer); }, value);
}

template <class Transfer>
void walk(PlaneShape& plane, Transfer& transfer) {
  transfer(plane.point);
  transfer(plane.normal);
}

template <class Transfer>
void walk(SphereShape& sphere, Transfer& transfer) {
  transfer(sphere.center);
  transfer(sphere.radius);
}

template <class Transfer>
void walk(CapsuleShape& capsule, Transfer& transfer) {
  transfer(capsule.a);
  transfer(capsule.b);
  transfer(capsule.radius);
}

template <class Transfer>
void walk(BoxShape& box, Transfer& transfer) {
  transfer(box.center);
  transfer(box.half);
  transfer(box.rotation);
}

/// Refused before: see unknown_to_engines().
template <class Transfer>
void walk(MeshShape&, Transfer&) {}
template <class Transfer>
void walk(CustomForce&, Transfer&) {}

template <class Transfer>
void walk(Region& region, Transfer& transfer) {
  transfer(region.shape);
  transfer(region.falloff);
}

template <class Transfer>
void walk(KeyedValue& keys, Transfer& transfer) {
  transfer(keys.times);
  transfer(keys.values);
}

template <class Transfer>
void walk(Obstacle& obstacle, Transfer& transfer) {
  transfer(obstacle.name);
  transfer(obstacle.shape);
  for (double* value :
       {&obstacle.stiffness, &obstacle.damping, &obstacle.friction, &obstacle.stick})
    transfer(*value);
  transfer(obstacle.bone);
}

template <class Transfer>
void walk(UniformAcceleration& form, Transfer& transfer) {
  transfer(form.acceleration);
}

template <class Transfer>
void walk(ForceDensity& form, Transfer& transfer) {
  transfer(form.density);
}

template <class Transfer>
void walk(Attraction& form, Transfer& transfer) {
  transfer(form.point);
  transfer(form.acceleration);
  transfer(form.core);
}

template <class Transfer>
void walk(Swirl& form, Transfer& transfer) {
  transfer(form.point);
  transfer(form.axis);
  transfer(form.acceleration);
  transfer(form.core);
}

template <class Transfer>
void walk(ForceField& field, Transfer& transfer) {
  transfer(field.name);
  transfer(field.form);
  transfer(field.region);
  transfer(field.scale);
}

template <class Transfer>
void walk(Pinned& pin, Transfer& transfer) {
  transfer(pin.particle);
  transfer(pin.bone);
  for (std::int32_t& support : pin.support) transfer(support);
  transfer(pin.along);
}

template <class Transfer>
void walk(Support& support, Transfer& transfer) {
  transfer(support.name);
  for (bool& axis : support.holds) transfer(axis);
  transfer(support.pivot);
  transfer(support.along);
}

template <class Transfer>
void walk(Load& load, Transfer& transfer) {
  transfer(load.name);
  transfer(load.scale);
  transfer(load.particles);
  transfer(load.share);
  transfer(load.force);
  transfer(load.pivot);
}

template <class Transfer>
void walk(World& world, Transfer& transfer) {
  transfer(world.obstacles);
  transfer(world.drag.rate);
  transfer(world.drag.velocity);
  transfer(world.fields);
  transfer(world.pins);
  transfer(world.supports);
  transfer(world.loads);
}

}  // namespace sinew
