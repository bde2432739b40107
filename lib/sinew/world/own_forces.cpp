// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/world/own_forces.h>

#include <algorithm>
#include <string>
#include <utility>

#include <sinew/core/error.h>

namespace sinew {

OwnForces::OwnForces(std::size_t particles)
    : forces_(std::make_shared<Points>(particles, Vec3::Zero())) {}

std::shared_ptr<const World> OwnForces::added_to(const std::shared_ptr<const World>& world) const {
  World with = world ? *world : World();
  const auto force = [forces = forces_](const Vec3&, const Grain& grain) {
    return (*forces)[grain.id];
  };
  with.fields.push_back({"own", CustomForce{force}, {}, {}});
  return std::make_shared<const World>(std::move(with));
}

void OwnForces::set(Points forces) {
  if (forces.size() != forces_->size())
    throw bad_input("there are " + std::to_string(forces.size()) + " forces for " +
                        std::to_string(forces_->size()) + " particles",
                    "give one for each");
  if (!std::all_of(forces.begin(), forces.end(), [](const Vec3& f) { return f.allFinite(); }))
    throw bad_input("a force is not finite", "give numbers, in newtons");
  *forces_ = std::move(forces);
}

}  // namespace sinew
