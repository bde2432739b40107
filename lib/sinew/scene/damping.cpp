// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/damping.h>

#include <algorithm>
#include <memory>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/world/references.h>

namespace sinew {
namespace {

/// Whether bones pull every particle that pins do not hold.
bool moves_with_bones(const Body& body) {
  std::vector<bool> moves(body.rest.size());
  for (std::size_t i = 0; i < moves.size(); ++i)
    for (const Influence& by : body.binding.of(i))
      moves[i] = moves[i] || body.springs[static_cast<std::size_t>(by.bone)].stiffest() > 0;
  if (body.world)
    for (const Pinned& pin : body.world->pins)
      moves[pin.particle] = moves[pin.particle] || pin.bone != no_bone;
  return std::find(moves.begin(), moves.end(), false) == moves.end();
}

/// Adds damping of so much (1/s) relative to what holds the body.
void add_rigid(double rate, bool with_bones, Body& body) {
  if (rate == 0) return;
  if (!with_bones) {
    body.rigid_damping = std::make_shared<const RigidDamping>(rigid_damping_of(body, rate));
    return;
  }
  for (BoneSprings& bone : body.springs)
    if (bone.stiffest() > 0) bone.damping += rate * body.material.mass;
}

const ElasticModes& modes_for(const Settings& settings, const char* key, const Body& body,
                              std::optional<ElasticModes>& modes) {
  if (!modes) modes = elastic_modes(body);
  if (modes->empty())
    throw bad_input(settings.place(key),
                    "the lowest elastic mode of this body cannot be found: it has none, or over "
                    "200,000 particles in too few layers",
                    "give material.damping instead");
  return *modes;
}

/// Rayleigh's: eq. 2 has the share of beta in the lowest mode.
void set_rayleigh(const Settings& settings, double alpha, double beta, Body& body,
                  std::optional<ElasticModes>& found) {
  body.material.damping = 0;
  if (beta > 0) {
    const ElasticModes& modes = modes_for(settings, "material.rayleigh", body, found);
    body.material.damping = beta * modes.squared[0] / modes.rates(0, 0);
  }
  add_rigid(alpha, moves_with_bones(body), body);
}

}  // namespace

void set_damping(const Settings& settings, Body& body, std::optional<ElasticModes>& found) {
  if (settings.solver.method == Method::static_equilibrium) return;
  if (const auto& given = settings.material.rayleigh)
    return set_rayleigh(settings, given->at(0), given->at(1), body, found);
  if (!settings.material.damping_ratio) return;
  const double ratio = *settings.material.damping_ratio;
  const ElasticModes& modes = modes_for(settings, "material.damping_ratio", body, found);
  double& damping = body.material.damping;
  if (!(ratio > 0)) {
    damping = 0;
    return;
  }
  if (modes.damping_ratio(0) >= ratio) return;  // bones give it: eq. 2 calms as by default
  const bool with_bones = moves_with_bones(body);
  // Groups of particles know the damping of bones, but no other relative to what holds them.
  if (body.material.damping_form != DampingForm::rigid ||
      (settings.hierarchy.enabled && !with_bones)) {
    damping = modes.damping_for(ratio);
    return;
  }
  // Eq. 2 calms, up to its default; what is lacking is damping relative to what holds the body.
  damping = std::min(damping, modes.damping_for(ratio));
  add_rigid(modes.rate_for(ratio, damping), with_bones, body);
}

}  // namespace sinew
