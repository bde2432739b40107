// SPDX-License-Identifier: GPL-3.0-or-later
// Cells that move with their particles. Points that are no particles follow those nearby as the
// skin does, by the same weights and deformation gradients: exact for affine motion.
//
//     const MovingCells cells(volume_cells(surface, options, rest), rest, radius, skeleton,
//     binding); const Points now = cells.at(positions); const std::vector<double> J =
//     cells.volume_ratios(now);
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include <sinew/core/dataset.h>
#include <sinew/rig/skin.h>
#include <sinew/volume/volume_cells.h>

namespace sinew {

/// Beside a crack, a cell of a larger volume ratio spans it: its points follow both sides.
inline constexpr double largest_whole = 1.5;

class MovingCells {
 public:
  /// The cells of particles at `rest` (m, by id) with `radius` (m).
  MovingCells(VolumeCells cells, const Points& rest, double radius);
  /// The same; points follow no particles of bones that are not theirs: see make_skin().
  MovingCells(VolumeCells cells, const Points& rest, double radius, const Skeleton& skeleton,
              const Binding& binding);

  const VolumeCells& rest() const { return cells_; }

  /// All points while the particles are at `now` (m, by id), m.
  Points at(const Points& now) const;
  /// A column of all particles, by id, at all points: weighted means, and integers of the particle
  /// that moves a point most.
  Column at_points(const Column& of_particles) const;
  /// Volume of each cell with its points at `now` over that at rest; negative: inside out.
  std::vector<double> volume_ratios(const Points& now) const;

  /// Pairs of particles of the same cell that are nearest or second neighbors at rest, the lower
  /// first, each once, ascending.
  const std::vector<std::array<std::uint32_t, 2>>& pairs() const { return pairs_; }
  /// Whether particles of each pair touch at rest.
  const std::vector<char>& touching() const { return touching_; }
  /// 1 for cells with a pair that is apart, one number per pair, and for those that hang on to them
  /// across the crack: with a volume ratio above largest_whole, and a point of a torn cell.
  std::vector<std::int32_t> torn(const std::vector<char>& apart,
                                 const std::vector<double>& volume_ratios) const;

 private:
  MovingCells(VolumeCells cells, const Points& rest, double radius,
              const std::function<Skin(const Points&)>& skin_of);
  void find_pairs(const Points& rest, double radius);

  VolumeCells cells_;
  std::vector<std::uint32_t> followers_;  ///< points that are no particles
  Skin skin_;                             ///< these
  std::vector<double> volume_;            ///< volumes of cells at rest, m^3
  std::vector<std::array<std::uint32_t, 2>> pairs_;
  std::vector<char> touching_;
  std::vector<std::array<std::uint32_t, 2>> pair_of_cell_;  ///< rows of a pair and a cell
};

}  // namespace sinew
