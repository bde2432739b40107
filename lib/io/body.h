// SPDX-License-Identifier: GPL-3.0-or-later
// body.vtu: the filled body at rest, in the mesh's own coordinates, Float64.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/dataset.h"
#include "core/particles.h"
#include "core/settings.h"

namespace sinew {

struct BodyFile {
  Particles particles;                            ///< at rest, in the written order
  std::vector<std::int32_t> neighbours;           ///< touching particles of each
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
