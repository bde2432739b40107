// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of what is written.
#include <sinew/settings/row.h>

#include <utility>

namespace sinew {

using namespace rows;

namespace {

/// What of the particles frames contain.
std::vector<Field<Settings>> content_rows() {
  using S = Settings;
  return {
      may_lack("none",
               field<S>("output", "arrays", SINEW_AT(S, output.arrays), "",
                        "arrays of particles beside the usual ones (strain_eq is one up to "
                        "200,000 particles), such as \"J, stress\", or all: F, J, stretch, "
                        "strain, hencky_strain, strain_eq, stress, stress_kirchhoff, "
                        "von_mises, energy_density, D2min, turnover, surface_layer, "
                        "inverted, pose_error; by forces and bones acceleration, bone_point, "
                        "force_radial, force_twist, force_axial")),
      may_lack("all", field<S>("output", "only", SINEW_AT(S, output.only), "",
                               "the only arrays of particles beside those of output.arrays, such "
                               "as \"displacement, velocity\"")),
      may_lack("auto",
               field<S>("output", "skin", SINEW_AT(S, output.skin), "",
                        "arrays of particles that the surface has as well, such as \"velocity, "
                        "stress\", or all; beside strain_eq and, of materials with bonds, "
                        "von_mises, which it has by itself up to 200,000 particles; none: without "
                        "these two; contact_pressure, contact_area: of obstacles and other "
                        "bodies")),
      field<S>("output", "every", SINEW_AT(S, output.every), "",
               "writes the particles in every Nth frame only, from the first on; surface and bones "
               "are in all frames",
               Range{1, inf}),
      field<S>("output", "region", SINEW_AT(S, output.region), "m",
               "writes only the particles in a box at rest: x, y, z of its least corner, then of "
               "its greatest; metrics are then of these",
               any, "none"),
      field<S>("output", "inside_every", SINEW_AT(S, output.inside_every), "",
               "writes only every Nth of the particles that lie deeper than two layers below the "
               "surface; metrics are then of what is written",
               Range{1, 1e9}),
  };
}

}  // namespace

std::vector<Field<Settings>> rows::output_rows() {
  using S = Settings;
  std::vector<Field<Settings>> all = {
      field<S>("output", "interval", SINEW_AT(S, output.interval), "s",
               "simulated time between frames", positive),
      field<S>("output", "checkpoint_interval", SINEW_AT(S, output.checkpoint_interval), "s",
               "wall-clock time between checkpoints, from which --resume continues", not_negative),
      choice<S>(
          "output", "encoding", SINEW_AT(S, output.encoding), {"zlib", "lz4", "raw", "none"},
          "encoding of the arrays in VTU files; none: plain base64; raw: not for VTK before 9.3"),
      field<S>("output", "double_precision", SINEW_AT(S, output.double_precision), "",
               "writes Float64 instead of Float32"),
      field<S>("output", "skin_lbs", SINEW_AT(S, output.skin_lbs), "",
               "also writes the surface moved by linear-blend skinning, for comparison"),
      field<S>("output", "skin_dqs", SINEW_AT(S, output.skin_dqs), "",
               "also writes the surface moved by dual-quaternion skinning, for comparison"),
      field<S>("output", "export", SINEW_AT(S, output.export_surface), "",
               "writes the moving surface for Blender, 3ds Max and Maya: surface.obj (rest) with "
               "surface.pc2 (point cache), and surface.glb (morph targets)"),
      field<S>("output", "bonds", SINEW_AT(S, output.bonds), "",
               "also writes the bonds between particles as lines, with length, strain, force and "
               "whether they broke"),
      field<S>("output", "volume", SINEW_AT(S, output.volume), "",
               "also writes the body as tetrahedra between particles, up to the surface of the "
               "mesh, with their volumes and whether they are torn"),
  };
  std::vector<Field<Settings>> content = content_rows();
  for (Field<Settings>& row : content) all.push_back(std::move(row));
  return all;
}

}  // namespace sinew
