// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/figures/drawn_volume.h>

#include <algorithm>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/volume/tensor_lines.h>

namespace sinew {
namespace {

constexpr double lines_across = 36;  // lines keep this part of the body's diagonal from each other

std::vector<SymmetricTensor> tensors_in(const Column& column) {
  const auto* values = std::get_if<std::vector<double>>(&column.values);
  if (!values || column.components != 6)
    throw bad_input("lines need a symmetric tensor, not the array " + shown(column.name),
                    "choose --array stress, or leave it out");
  std::vector<SymmetricTensor> tensors(values->size() / 6);
  for (std::size_t i = 0; i < tensors.size(); ++i)
    std::copy_n(values->begin() + static_cast<std::ptrdiff_t>(6 * i), 6, tensors[i].begin());
  return tensors;
}

/// The cells that are torn, or those that are not.
std::vector<Cell> cells_of(const Dataset& data, bool are_torn) {
  const std::vector<std::int32_t>& torn = integers(data.cell_columns, "torn");
  std::vector<Cell> cells;
  for (std::size_t c = 0; c < torn.size(); ++c) {
    if ((torn[c] != 0) != are_torn) continue;
    Cell& cell = cells.emplace_back();
    for (std::size_t k = 0; k < 4; ++k)
      cell[k] = static_cast<std::uint32_t>(data.connectivity[4 * c + k]);
  }
  return cells;
}

std::vector<Cell> whole_cells(const Dataset& data) { return cells_of(data, false); }

/// Whether each point is a corner of a torn cell, or close to one: what is seen through the hole.
std::vector<bool> near_torn(const Dataset& data, const std::vector<Cell>& torn) {
  constexpr int rings = 2;  // neighbors of neighbors
  std::vector<bool> is_near(data.points.size());
  for (const Cell& cell : torn)
    for (const std::uint32_t corner : cell) is_near[corner] = true;
  for (int ring = 0; ring < rings && !torn.empty(); ++ring) {
    const std::vector<bool> before = is_near;
    for (std::size_t at = 0; at + 3 < data.connectivity.size(); at += 4) {
      const auto corner = [&](std::size_t k) {
        return static_cast<std::size_t>(data.connectivity[at + k]);
      };
      if (before[corner(0)] || before[corner(1)] || before[corner(2)] || before[corner(3)])
        for (std::size_t k = 0; k < 4; ++k) is_near[corner(k)] = true;
    }
  }
  return is_near;
}

}  // namespace

Dataset DrawnVolume::cells(std::size_t index, const FrameState& frame, Column column) const {
  Dataset particles;
  particles.points = frame.positions;
  particles.point_columns = {std::move(column)};
  if (!frame.broken_bonds.empty())
    particles.point_columns.push_back({"broken_bonds", 1, frame.broken_bonds});
  return volume_.at(index, particles);
}

DrawnVolume::Opened DrawnVolume::cut(std::size_t index, const FrameState& frame,
                                     std::vector<double> values, const CutPlane& asked) const {
  // Many particles may lie exactly on it, as layers do at rest.
  const double aside = 1e-3 * run_->body.particles.radius;
  const CutPlane plane{asked.point + aside * asked.normal, asked.normal};
  Dataset data = cells(index, frame, {"value", 1, std::move(values)});
  SnapshotCut cut{plane.point, plane.normal, {}, numbers(data.point_columns, "value"), {}};
  std::vector<bool> in_front(data.points.size());
  for (std::size_t i = 0; i < data.points.size(); ++i)
    in_front[i] = plane.distance(data.points[i]) > 0;
  for (const Cell& cell : whole_cells(data))
    if (std::any_of(cell.begin(), cell.end(), [&](auto point) { return in_front[point]; }) &&
        !std::all_of(cell.begin(), cell.end(), [&](auto point) { return in_front[point]; }))
      cut.cells.push_back(cell);
  std::vector<bool> in_hole = near_torn(data, cells_of(data, true));
  in_hole.resize(frame.positions.size());
  cut.points = std::move(data.points);
  return {std::move(cut), std::move(in_hole)};
}

std::vector<SnapshotCurve> DrawnVolume::lines(std::size_t index, const FrameState& frame,
                                              const Column& tensor, double min_value) const {
  const Dataset data = cells(index, frame, tensor);
  const double size = bounds(positions_of(run_->body.particles)).diagonal().norm();
  const double spacing = std::max(size / lines_across, 2 * run_->body.particles.radius);
  std::vector<SnapshotCurve> curves;
  for (TensorLine& line : tensor_lines(data.points, whole_cells(data),
                                       tensors_in(*find(data.point_columns, tensor.name)),
                                       {.spacing = spacing, .min_value = min_value}))
    curves.push_back({std::move(line.points), std::move(line.values)});
  return curves;
}

std::vector<double> largest_principals(const Column& tensor) {
  std::vector<double> values;
  for (const SymmetricTensor& one : tensors_in(tensor))
    values.push_back(largest_principal(one).value);
  return values;
}

}  // namespace sinew
