// SPDX-License-Identifier: GPL-3.0-or-later
// supports.csv: what each support and load does to the body over time, one row each per frame.
//
//     SupportTable table(folder / "supports.csv", world);
//     table.add(now, support_frames(world, now, rest));
//     table.close();
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include <sinew/io/frame_table.h>
#include <sinew/io/frames.h>
#include <sinew/world/world.h>

namespace sinew {

/// The machine at one moment.
struct MachineMoment {
  double time;              ///< s
  const Points& positions;  ///< index: particle id, m
  std::span<const ObstaclePose> supports;
  std::span<const Reaction> support_reactions, load_reactions;  ///< on the body
};

/// Supports first, then loads, in their order. `rest`: by id, m.
std::vector<SupportFrame> support_frames(const World& world, const MachineMoment& now,
                                         const Points& rest);

/// Columns: time (s), name, kind (support or load), force_x, force_y, force_z (N, on the body),
/// moment_x, moment_y, moment_z (N m, about the pivot), power (W, into the body), displacement_x,
/// displacement_y, displacement_z (m, mean of what it holds or loads, of a load by its weights),
/// pivot_x, pivot_y, pivot_z (m; of a support it moves with it). Supports first, in their order.
class SupportTable {
 public:
  /// The world must outlive it. Continues after `kept` frames; throws as FrameTable does.
  SupportTable(const std::filesystem::path& path, const World& world, std::size_t kept = 0);

  /// `frames`: of that moment. Throws not written.
  void add(const MachineMoment& now, std::span<const SupportFrame> frames);
  void close() { table_.close(); }  ///< throws not written

 private:
  const World& world_;
  FrameTable table_;
};

}  // namespace sinew
