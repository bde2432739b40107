// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the deformed surfaces of a run as mesh files.
//
//     const RunFiles run = open_run({"out/bend"});
//     export_surfaces(run, {"surface", ".stl"}, frames_at(run, {1.2}), "bent.stl");
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/run/run_files.h>

namespace sinew {

/// Whether that is ".obj", ".ply" (both in double precision) or ".stl" (binary, in single).
bool is_surface_file(std::string_view extension);

struct SurfaceExport {
  std::string series = "surface";  ///< or another one of triangles
  std::string extension;           ///< one of is_surface_file()
};

struct ExportedSurfaces {
  std::vector<std::filesystem::path> files;
  Vec3 origin = Vec3::Zero();  ///< what the places in STL are relative to, m: see local_origin()
};

/// Writes these frames of a series to one file, or where there are several as SERIES_000000.obj and
/// so on, by frame, in the folder `target`, which is created. Throws bad input for an unknown
/// series and one that the run has not written, what reading throws, and not written.
ExportedSurfaces export_surfaces(const RunFiles& run, const SurfaceExport& as,
                                 const std::vector<std::size_t>& frames,
                                 const std::filesystem::path& target);

}  // namespace sinew
