// SPDX-License-Identifier: GPL-3.0-or-later
// The single VTU files of a run: blowup.vtu, the defects of a mesh, and body.vtu.
//
//     const BodyFile body = read_body("out/bend/body.vtu");
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sinew/core/dataset.h>
#include <sinew/core/options.h>
#include <sinew/core/particles.h>
#include <sinew/core/triangles.h>
#include <sinew/io/frames.h>

namespace sinew {

// blowup.vtu: the body before the step in which a simulation became unstable, with the offending
// particles marked.

/// Why a particle made the step fail.
enum class Offence : std::int32_t { none = 0, too_fast = 1, not_finite = 2 };

struct BlowupFrame {
  const Particles& before;             ///< the step, in any order
  const Points& rest;                  ///< m, in the written order
  std::span<const std::int32_t> bone;  ///< in the written order
  std::span<const Offence> offence;    ///< in the written order
  std::span<const double> moved;  ///< in the step, relative to its bone, in radii; 0 if not finite
};

Dataset blowup_dataset(const BlowupFrame& frame, Moment moment);

/// Throws not written.
void write_blowup(const std::filesystem::path& path, const BlowupFrame& frame, Moment moment);

// The defects of a mesh for ParaView: its faces and its defective edges, marked.

/// One number per face, then one per edge, unless noted.
struct DefectsFile {
  Triangles surface;
  std::vector<std::array<std::int32_t, 2>> edges;  ///< points of each defective edge
  std::vector<std::int32_t> defect;     ///< 0 none, 1 open, 2 crowded, 3 twisted edge; 4 turned,
                                        ///< 5 cutting, 6 flat face
  std::vector<std::int32_t> component;  ///< -1 for edges
  std::vector<std::int32_t> hole;       ///< -1 for faces and closed edges
};

/// Triangles followed by lines.
Dataset defects_dataset(const DefectsFile& defects);
/// Throws not written.
void write_defects(const std::filesystem::path& path, const DefectsFile& defects);

// body.vtu: the filled body at rest, in the mesh's own coordinates, Float64.

struct BodyFile {
  Particles particles;                              ///< at rest, in the written order
  std::vector<std::int32_t> neighbors;              ///< touching particles of each
  std::vector<std::int32_t> component;              ///< connected component of each, from 0
  std::optional<std::vector<double>> volume_share;  ///< share as Filling::volume_share
  std::optional<std::vector<double>> stiffness;     ///< stiffness of each material over the body's
  std::optional<std::vector<double>> density;  ///< the same of the density: factors on the mass
  std::optional<std::vector<double>> volume_stiffness;  ///< K_v, Pa, where it differs
  std::optional<std::vector<std::int32_t>> bone;        ///< bone of each particle, once bound
  std::optional<std::vector<double>> weight;            ///< weight of that bone in it, once bound
  std::string meta;                                     ///< UTF-8 JSON, or empty
};

/// Moves the arrays where the body is an rvalue.
Dataset body_dataset(BodyFile body);

/// Throws not written.
void write_body(const std::filesystem::path& path, BodyFile body,
                Encoding encoding = Encoding::zlib);

/// Throws bad input, naming the file, where it is not a body: arrays are missing, ids are not
/// 0, 1, 2, ..., radius or mass is not positive or differs between particles, or a coordinate is
/// not finite.
BodyFile read_body(const std::filesystem::path& path);

}  // namespace sinew
