// SPDX-License-Identifier: GPL-3.0-or-later
// bones.csv: the force and moment of the body on each bone over time, one row per bone and frame.
//
//     BoneTable table("out/bend/bones.csv");
//     table.add(time, skeleton, reactions, power);
//     table.close();
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <sinew/core/file.h>
#include <sinew/io/frames.h>

namespace sinew {

/// Columns: time (s), bone (its name), force_x, force_y, force_z (N), moment_x, moment_y, moment_z
/// (N m, about the head), power (W, of the bone on the body). Grows frame by frame.
class BoneTable {
 public:
  /// Continues after the first `kept` frames of an existing table of as many `bones`. Throws not
  /// written, and bad input when it holds fewer.
  explicit BoneTable(const std::filesystem::path& path, std::size_t bones = 0,
                     std::size_t kept = 0);

  /// One frame; `power` in W. Throws not written.
  void add(double time, const Skeleton& skeleton, const Reactions& reactions,
           std::span<const double> power);
  void close();  ///< throws not written

 private:
  GrowingFile file_;
};

}  // namespace sinew
