// SPDX-License-Identifier: GPL-3.0-or-later
// Tetrahedra as files of other programs, by their ending: VTU, Gmsh 2.2 (.msh), Medit (.mesh), and
// input of Abaqus and CalculiX (.inp).
//
//     write_cells("body.msh", data);
#pragma once

#include <filesystem>
#include <string>

#include <sinew/core/dataset.h>

namespace sinew {

/// Throws bad input, which lists the endings, for another one.
void check_cell_file(const std::filesystem::path& path);

/// ".vtu of VTK, .msh of Gmsh 2.2, ...", for help texts.
std::string help_of_cell_files();

/// Points (m), tetrahedra, and of the point columns `id`: which particle is there, -1 for none. It
/// becomes an array of the points in VTU and Gmsh, in Medit the reference of a vertex less 1, and
/// in .inp the set of nodes PARTICLES. Atomically. Throws not written.
void write_cells(const std::filesystem::path& path, const Dataset& cells);

}  // namespace sinew
