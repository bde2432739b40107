// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/detail/carried_cells.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <sinew/body/body.h>
#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>

namespace sinew {
namespace {

constexpr double cells_per_width = 12;
constexpr std::size_t cells_at_a_time = 64;

template <class Visit>
void for_each_bone(const Body& body, const Visit& visit) {
  for (std::uint32_t i = 0; i < body.rest.size(); ++i) {
    const auto influences = body.binding.of(i);
    for (const Influence& one : influences) visit(i, one.bone);
    if (influences.empty()) visit(i, nearest_bone(body.skeleton, body.rest[i]));
  }
}

}  // namespace

std::vector<double> widths_of(const Body& body) {
  const double r = body.material.pair.r;
  std::vector<double> width(body.skeleton.size(), 0);
  for_each_bone(body, [&](std::uint32_t, int bone) {
    width[static_cast<std::size_t>(bone)] += volume_per_particle(r);
  });
  for (std::size_t b = 0; b < width.size(); ++b)
    width[b] = std::max(std::sqrt(width[b] / body.skeleton.bones[b].length), 2 * r);
  return width;
}

std::vector<Cell> cells_of(const Body& body, const std::vector<double>& width) {
  std::map<std::array<int, 4>, Cell> cells;
  for_each_bone(body, [&](std::uint32_t i, int bone) {
    const Vec3 at = body.rest[i] * (cells_per_width / width[static_cast<std::size_t>(bone)]);
    const auto number = [&](int axis) { return static_cast<int>(std::floor(at[axis])); };
    Cell& cell = cells[{bone, number(0), number(1), number(2)}];
    cell.bone = bone;
    cell.particles.push_back(i);
    cell.box.extend(body.rest[i]);
  });
  std::vector<Cell> all;
  for (auto& [place, cell] : cells) all.push_back(std::move(cell));
  return all;
}

void on_cells(const std::vector<Cell>& cells, const std::function<void(std::size_t)>& job) {
  parallel_for(cells.size(), cells_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) job(n);
  });
}

std::vector<std::uint8_t> particles_of(const std::vector<Cell>& cells,
                                       const std::vector<std::uint8_t>& marks, std::size_t count) {
  std::vector<std::uint8_t> particles(count, 0);
  for (std::size_t n = 0; n < cells.size(); ++n)
    for (const std::uint32_t i : cells[n].particles) particles[i] |= marks[n];
  return particles;
}

}  // namespace sinew
