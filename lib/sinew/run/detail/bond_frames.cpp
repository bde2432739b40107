// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/detail/bond_frames.h>

#include <utility>
#include <vector>

namespace sinew {

namespace {

/// The place of each particle in the frame; -1 where it is not in it.
std::vector<std::int32_t> places(std::size_t particles, std::span<const std::int32_t> ids) {
  if (ids.empty()) return vertex_cells(particles);
  std::vector<std::int32_t> place(particles, -1);
  for (std::size_t k = 0; k < ids.size(); ++k)
    place[static_cast<std::size_t>(ids[k])] = static_cast<std::int32_t>(k);
  return place;
}

}  // namespace

Dataset bonds_dataset(const BondValues& bonds, const Points& positions,
                      std::span<const std::int32_t> ids, Moment moment) {
  Dataset data;
  data.time = moment.time;
  data.cycle = moment.cycle;
  data.kind = CellKind::line;
  std::vector<std::int32_t> id(ids.begin(), ids.end());
  if (ids.empty()) id = vertex_cells(positions.size());
  for (const std::int32_t one : id) data.points.push_back(positions[static_cast<std::size_t>(one)]);
  const std::vector<std::int32_t> place = places(positions.size(), ids);
  std::vector<double> length, strain, force;
  std::vector<std::int32_t> broken;
  for (std::size_t k = 0; k < bonds.ends.size(); ++k) {
    const auto [i, j] = bonds.ends[k];
    if (place[i] < 0 || place[j] < 0) continue;
    data.connectivity.insert(data.connectivity.end(), {place[i], place[j]});
    length.push_back(bonds.length[k]);
    strain.push_back(bonds.strain[k]);
    force.push_back(bonds.force[k]);
    broken.push_back(bonds.broken[k]);
  }
  data.point_columns = {column("id", std::move(id))};
  data.cell_columns = {column("strain", std::move(strain)), column("length", std::move(length)),
                       column("force", std::move(force)), column("broken", std::move(broken))};
  return data;
}

}  // namespace sinew
