// SPDX-License-Identifier: GPL-3.0-or-later
// A law of force that a program brings: bonds of Lennard and Jones' form, as stiff at rest as the
// springs of the model bonded, which soften as they are pulled and stiffen as they are pushed.
#include <gtest/gtest.h>

#include <sinew/kernel/functions.h>
#include <sinew/material/laws.h>
#include <sinew/scene/prepare.h>

#include "mesh/shapes.h"
namespace sinew::kernel {

inline constexpr PairLaw lennard_jones{pair_laws};

/// f = 12 e / d ((l/d)^12 - (l/d)^6) with e = k l^2 / 72.
template <class L>
struct BondForce<L, lennard_jones> {
  using V = typename L::V;

  static V depth(const Bond<L>& bond) {
    return bond.stiffness * bond.length * bond.length * L::all(1.0 / 72);
  }
  static V sixth(const Bond<L>& bond, V d) {
    const V ratio = bond.length / d, cube = ratio * ratio * ratio;
    return cube * cube;
  }
  template <Shell shell, bool careful>
  static V pull(const SolidLaw<L>&, const Bond<L>& bond, V squared, V& d) {
    d = L::root(squared);
    const V six = sixth(bond, d);
    return L::all(12) * depth(bond) * (six * six - six) / squared;
  }
  static V energy(const Bonds<typename L::Real>&, const Bond<L>& bond, V d) {
    const V six = sixth(bond, d);
    return depth(bond) * (six * six - (six + six) + L::all(1));
  }
};

}  // namespace sinew::kernel

namespace sinew::own_law_test {

double sixth(const BondSpring& bond, double d) { return std::pow(bond.length / d, 6); }
double depth(const BondSpring& bond) { return bond.stiffness * bond.length * bond.length / 72; }

ForceLaw lennard_jones() {
  static const kernel::OwnLaw steps{
      kernel::functions_of_law<kernel::lanes::Doubles, kernel::lennard_jones>(), {}};
  Material bonded;
  bonded.model = MaterialModel::bonded;
  ForceLaw law = law_of(bonded);
  law.name = "lennard_jones";
  law.bond_force = [](const Material&, const BondSpring& bond, double d) {
    const double six = sixth(bond, d);
    return 12 * depth(bond) / d * (six * six - six);
  };
  law.bond_energy = [](const Material&, const BondSpring& bond, double d) {
    const double six = sixth(bond, d);
    return depth(bond) * (six * six - 2 * six + 1);
  };
  law.kernel = &steps;
  return law;
}

/// A bar whose upper bone stretches by 8 % and bends, from its scene to a moment.
Simulation bent(const ForceLaw* law, NeighborSearch search,
                Precision precision = Precision::binary64) {
  Scene scene;
  scene.settings.body.mesh = "bar";
  scene.settings.meshes["bar"] = shapes::box({-0.05, -0.05, 0}, {0.05, 0.05, 0.3});
  scene.settings.body.radius = 0.013;
  scene.settings.material.model = MaterialModel::bonded;
  scene.settings.solver.neighbor_search = search, scene.settings.solver.precision = precision;
  scene.settings.bones = {{"lower", "", Vec3(0, 0, 0), Vec3(0, 0, 0.15)},
                          {"upper", "lower", {}, Vec3(0, 0, 0.3)}};
  scene.settings.tracks = {{"upper", Interpolation::smooth, "xyz", std::vector<KeyDefinition>(2)}};
  scene.settings.tracks[0].keys[0].time = 0;
  KeyDefinition& key = scene.settings.tracks[0].keys[1];
  key.time = 0.2, key.axis = Vec3::UnitY(), key.angle = 20, key.stretch = 1.08;
  scene.law = law;
  Simulation simulation = start(prepare(scene));
  while (simulation.time() < 0.25) simulation.step();
  return simulation;
}

TEST(OwnLaw, GivesTheSameOnKernelAndReferenceAndOtherThanSprings) {
  const ForceLaw law = lennard_jones();
  Simulation kernel = bent(&law, NeighborSearch::lists), cells = bent(&law, NeighborSearch::cells);
  Simulation springs = bent(nullptr, NeighborSearch::lists);
  const double energy = kernel.energies().stored();
  EXPECT_NEAR(cells.energies().stored(), energy, 1e-9 * energy);
  EXPECT_GT(std::abs(springs.energies().stored() - energy), 1e-2 * energy);
  const Points here = positions_by_id(kernel.particles()),
               there = positions_by_id(cells.particles());
  for (std::size_t i = 0; i < here.size(); ++i) ASSERT_LT((here[i] - there[i]).norm(), 1e-10) << i;
  EXPECT_THROW(bent(&law, NeighborSearch::lists, Precision::binary32), Error);  // it has no steps
}

}  // namespace sinew::own_law_test
