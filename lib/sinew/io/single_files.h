// SPDX-License-Identifier: GPL-3.0-or-later
// blowup.vtu: the body before the step in which a simulation became unstable, its offenders marked.
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

/// A particle's part in the step that failed.
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

// What is wrong with a mesh, to be seen in ParaView: its faces and its defective edges, marked.

/// One number per face, then one per edge, where not said otherwise.
struct DefectsFile {
  Triangles surface;
  std::vector<std::array<std::int32_t, 2>> edges;  ///< points of each defective edge
  std::vector<std::int32_t> defect;     ///< 0 none, 1 open, 2 crowded, 3 twisted edge; 4 turned,
                                        ///< 5 cutting, 6 flat face
  std::vector<std::int32_t> component;  ///< -1 for edges
  std::vector<std::int32_t> hole;       ///< -1 for faces and closed edges
};

/// A VTU of triangles followed by lines. Throws not written.
void write_defects(const std::filesystem::path& path, const DefectsFile& defects);

// body.vtu: the filled body at rest, in the mesh's own coordinates, Float64.

struct BodyFile {
  Particles particles;                            ///< at rest, in the written order
  std::vector<std::int32_t> neighbors;            ///< touching particles of each
  std::vector<std::int32_t> component;            ///< connected piece of each, from 0
  std::optional<std::vector<std::int32_t>> bone;  ///< of each, once bound
  std::optional<std::vector<double>> weight;      ///< that bone's share in it, once bound
  std::string meta;                               ///< UTF-8 JSON, or empty
};

/// Arrays of millions of particles are moved, not copied, where the body is given away.
Dataset body_dataset(BodyFile body);

/// Throws not written.
void write_body(const std::filesystem::path& path, BodyFile body,
                Encoding encoding = Encoding::zlib);

/// Throws bad input, naming the file, when it is not a body: arrays missing, ids that are not
/// 0, 1, 2, ..., a radius or mass that is not positive or differs between particles, a coordinate
/// that is not finite.
BodyFile read_body(const std::filesystem::path& path);

}  // namespace sinew
