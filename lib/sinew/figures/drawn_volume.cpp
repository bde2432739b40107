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

/// The cells that are not torn.
std::vector<Cell> whole_cells(const Dataset& data) {
  const std::vector<std::int32_t>& torn = integers(data.cell_columns, "torn");
  std::vector<Cell> cells;
  for (std::size_t c = 0; c < torn.size(); ++c) {
    if (torn[c]) continue;
    Cell& cell = cells.emplace_back();
    for (std::size_t k = 0; k < 4; ++k)
      cell[k] = static_cast<std::uint32_t>(data.connectivity[4 * c + k]);
  }
  return cells;
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

SnapshotCut DrawnVolume::cut(std::size_t index, const FrameState& frame, std::vector<double> values,
                             const CutPlane& asked) const {
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
  cut.points = std::move(data.points);
  return cut;
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
