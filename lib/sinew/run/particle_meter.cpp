// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/particle_meter.h>

#include <sinew/core/particles.h>
#include <sinew/material/laws.h>
#include <sinew/metrics/pair_forces.h>
#include <sinew/metrics/particle_values.h>
#include <sinew/run/moment_arrays.h>
#include <sinew/scene/prepare.h>
#include <sinew/stepping/simulation.h>
#include <sinew/world/muscles.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

RestBody measured_rest(const Body& body, const Triangles& surface, SharedNeighbors near) {
  RestInput input;
  input.positions = body.rest;
  input.neighbors = near ? std::move(near) : body.neighbors;
  input.surface = surface;
  input.bone = bones_of_particles(body);
  input.skeleton = body.skeleton;
  input.material = body.material;
  input.forces.has_muscles = has_muscles(body);
  input.forces.factors = std::make_shared<const BondFactors>(body.factors);
  input.forces.stiffness = body.stiffness;
  input.forces.volume_stiffness = body.local.volume;
  input.forces.pass = body.pass_through;
  return rest_body(std::move(input));
}

}  // namespace

ParticleMeter::ParticleMeter(const Body& body, const Triangles& surface, SharedNeighbors near)
    : world_(body.world), rest_(measured_rest(body, surface, std::move(near))) {}

FrameState ParticleMeter::at_rest() const {
  FrameState state = state_at_rest(rest_);
  state.bond_rest = first_bond_rest(rest_);
  if (rest_.forces.has_muscles) state.muscle_stress.assign(rest_.particles(), Mat3::Zero());
  return state;
}

void ParticleMeter::take_forces(Simulation& simulation, double time, FrameState& state) const {
  if (bonds_change(rest_.material))
    state.bond_rest = simulation.rest_of_bonds(rest_.shape.neighbors, rest_.second);
  if (!rest_.forces.has_muscles) return;
  const Muscles& muscles = world_->muscles;
  state.muscle_stress = muscle_stress(muscles, activations_at(muscles, time), state.positions);
}

FrameState ParticleMeter::now(Simulation& simulation) const {
  FrameState state;
  state.time = simulation.time();
  state.positions = positions_by_id(simulation.particles());
  for (const BonePose& bone : simulation.pose()) state.bones.push_back(bone.frame);
  take_forces(simulation, state.time, state);
  return state;
}

std::vector<Column> ParticleMeter::arrays(Simulation& simulation, std::string_view words) {
  auto asked = asked_.find(words);
  if (asked == asked_.end()) {
    RequestedArrays named = requested_arrays(words);
    named.measured = defined_arrays(rest_, at_rest(), named);
    named.stepped = defined_moment_arrays(simulation.body(), std::move(named.stepped), named.all);
    asked = asked_.emplace(words, std::move(named)).first;
  }
  const FrameState state = now(simulation);
  std::vector<Column> found = particle_arrays(rest_, state, asked->second.measured);
  const BodyMoment moment{simulation.body(),   state.positions,   simulation.particles(),
                          simulation.forces(), simulation.pose(), simulation.stepping().gravity};
  for (Column& array : moment_arrays(moment, asked->second.stepped))
    found.push_back(std::move(array));
  return found;
}

}  // namespace sinew
