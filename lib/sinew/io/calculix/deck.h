// SPDX-License-Identifier: GPL-3.0-or-later
// Input decks of CalculiX (http://www.dhondt.de, CrunchiX 2.20): a body of finite elements, what
// holds it, and its equilibria under loads.
//
//     write_deck("beam.inp", deck);        // ccx -i beam writes beam.frd
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <sinew/core/volume_mesh.h>

namespace sinew {

/// Linear elastic and isotropic; with large displacements, Saint Venant and Kirchhoff's.
struct DeckMaterial {
  std::string name;
  double young_modulus = 0;  ///< Pa
  double poisson_ratio = 0;
  double density = 0;  ///< kg/m^3
  std::vector<std::uint32_t> elements;
};

/// Nodes whose sum of reactions ccx prints into its .dat file.
struct DeckSet {
  std::string name;
  std::vector<std::uint32_t> nodes;
};

struct HeldNode {
  std::uint32_t node = 0;
  int axis = 0;             ///< 0 to 2
  double displacement = 0;  ///< distance from rest, m
};

struct NodeForce {
  std::uint32_t node = 0;
  Vec3 force = Vec3::Zero();  ///< N
};

struct FacePressure {
  ElementFace face;
  double pressure = 0;  ///< Pa, inward; follows the face
};

/// An equilibrium: all that acts at its time. Between two of them everything changes linearly.
struct DeckStep {
  double time = 0;  ///< s
  std::vector<HeldNode> held;
  std::vector<NodeForce> forces;
  std::vector<FacePressure> pressures;
};

struct Deck {
  std::string title;           ///< one line
  VolumeMesh mesh;             ///< mesh of one kind of elements
  Vec3 origin = Vec3::Zero();  ///< to which written nodes are relative, m: results have six digits
  std::vector<DeckMaterial> materials;
  std::vector<DeckSet> sets;
  std::vector<DeckStep> steps;      ///< steps of ascending times
  bool large_displacements = true;  ///< equilibrium in the deformed shape
  int frequencies =
      0;  ///< above 0: so many lowest modes of the body at rest, held as in its one step
};

/// Atomically. Hexahedra of 20 nodes are fully integrated (C3D20): with one across, a cantilever of
/// four widths bends 2.5 % too little, where that of C3D20R bends half as far; with two, both are
/// within 0.5 %. Those of 8 nodes have incompatible modes (C3D8I). Of each step the .frd file has
/// displacements, stresses and forces at its end, under the step's time. Throws not written.
void write_deck(const std::filesystem::path& path, const Deck& deck);

}  // namespace sinew
