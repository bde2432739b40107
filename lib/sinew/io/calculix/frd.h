// SPDX-License-Identifier: GPL-3.0-or-later
// Results of finite elements in ASCII .frd files of CalculiX (CalculiX GraphiX user's manual,
// chapter "Result Format"): the mesh, and displacements, stresses and forces of its
// nodes at the end of each step.
//
//     const FrdResult result = read_frd("beam.frd");
//     const Vec3 moved = result.steps.back().displacement[node];
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include <sinew/core/volume_mesh.h>

namespace sinew {

using StressComponents = std::array<double, 6>;  ///< XX YY ZZ XY YZ XZ, Pa

/// Not-a-number at nodes for which the file has nothing.
struct FrdStep {
  double time = 0;
  Points displacement;                   ///< displacement of each node, m
  std::vector<StressComponents> stress;  ///< stress of each node; empty: not written
  Points force = {};                     ///< force of the elements on each node, N; or empty
};

struct FrdResult {
  VolumeMesh mesh;
  std::vector<FrdStep> steps;  ///< ascending in time; those with displacements
};

/// Hexahedra of 8 and 20 and tetrahedra of 4 and 10 nodes. Throws bad input, with the line, for
/// binary files, other elements, and what is damaged or incomplete.
FrdResult read_frd(const std::filesystem::path& path);

}  // namespace sinew
