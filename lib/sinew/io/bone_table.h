// SPDX-License-Identifier: GPL-3.0-or-later
// bones.csv: force and moment of each bone on the body over time, one row per bone and frame.
//
//     BoneTable table("out/bend/bones.csv");
//     table.add(time, skeleton, sums, {springs, pins, obstacles});
//     table.close();
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>

#include <sinew/io/frame_table.h>
#include <sinew/io/frames.h>

namespace sinew {

/// What is told of a bone at one moment.
struct BoneRow {
  Vec3 force, moment;  ///< on the body, N and N m about its head
  double power;        ///< into the body, W; of a rigid bone force . v + moment . omega
};

/// Columns: time (s), bone (its name), force_x, force_y, force_z (N), moment_x, moment_y, moment_z
/// (N m, about the head), power (W), all of the bone on the body; the same of its parts, which are
/// called spring_force_x and so on: through its springs, pins and obstacles. Grows frame by frame.
class BoneTable {
 public:
  /// Continues after the first `kept` frames of an existing table of as many `bones`. Throws not
  /// written, and bad input when it holds fewer.
  explicit BoneTable(const std::filesystem::path& path, std::size_t bones = 0,
                     std::size_t kept = 0);

  /// One frame; per bone the sums and the parts (empty: zeros). Throws not written.
  void add(double time, const Skeleton& skeleton, std::span<const BoneRow> sums,
           const std::array<std::span<const BoneRow>, 3>& parts);
  void close() { table_.close(); }  ///< throws not written

 private:
  FrameTable table_;
};

}  // namespace sinew
