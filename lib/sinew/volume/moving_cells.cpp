// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/volume/moving_cells.h>

#include <algorithm>
#include <tuple>
#include <type_traits>
#include <utility>

#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/core/rest_neighbors.h>

namespace sinew {
namespace {

constexpr std::size_t at_a_time = 4096;  // points or cells

Points places_of(const VolumeCells& cells) {
  Points places;
  for (std::size_t i = 0; i < cells.points.size(); ++i)
    if (cells.id[i] < 0) places.push_back(cells.points[i]);
  return places;
}

std::uint32_t particle_of(const Skin& skin, std::uint32_t k) {
  return skin.near[skin.weighted[skin.particle[k]]];
}

}  // namespace

MovingCells::MovingCells(VolumeCells cells, const Points& rest, double radius,
                         const std::function<Skin(const Points&)>& skin_of)
    : cells_(std::move(cells)), skin_(without_lone_particles(skin_of(places_of(cells_)))) {
  for (std::uint32_t i = 0; i < cells_.points.size(); ++i)
    if (cells_.id[i] < 0) followers_.push_back(i);
  for (const Cell& cell : cells_.cells) volume_.push_back(volume_of(cells_.points, cell));
  find_pairs(rest, radius);
}

MovingCells::MovingCells(VolumeCells cells, const Points& rest, double radius)
    : MovingCells(std::move(cells), rest, radius,
                  [&](const Points& places) { return make_skin(places, rest, radius); }) {}

MovingCells::MovingCells(VolumeCells cells, const Points& rest, double radius,
                         const Skeleton& skeleton, const Binding& binding)
    : MovingCells(std::move(cells), rest, radius, [&](const Points& places) {
        return make_skin(places, rest, radius, skeleton, binding);
      }) {}

void MovingCells::find_pairs(const Points& rest, double radius) {
  struct Found {
    std::array<std::uint32_t, 2> pair;
    std::uint32_t cell;
  };
  std::vector<Found> found;
  const double range = second_neighbor_range * radius;
  for (std::uint32_t c = 0; c < cells_.cells.size(); ++c)
    for (const std::uint32_t v : cells_.cells[c])
      for (const std::uint32_t w : cells_.cells[c]) {
        const std::int32_t i = cells_.beside[v], j = cells_.beside[w];
        if (i >= 0 && i < j && (rest[i] - rest[j]).norm() < range)
          found.push_back({{static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)}, c});
      }
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    return std::tie(a.pair, a.cell) < std::tie(b.pair, b.cell);
  });
  for (const Found& one : found) {
    if (pairs_.empty() || pairs_.back() != one.pair) {
      pairs_.push_back(one.pair);
      const double distance = (rest[one.pair[0]] - rest[one.pair[1]]).norm();
      touching_.push_back(distance < rest_neighbor_range(radius));
    }
    pair_of_cell_.push_back({static_cast<std::uint32_t>(pairs_.size() - 1), one.cell});
  }
}

Points MovingCells::at(const Points& now) const {
  const Points followed = follow(skin_, now);
  Points points(cells_.points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    if (cells_.id[i] >= 0) points[i] = now[cells_.id[i]];
  for (std::size_t k = 0; k < followers_.size(); ++k) points[followers_[k]] = followed[k];
  return points;
}

Column MovingCells::at_points(const Column& of_particles) const {
  const auto width = static_cast<std::size_t>(of_particles.components);
  const auto find = [&](const auto& values) {
    std::decay_t<decltype(values)> found(width * cells_.points.size());
    const auto copy = [&](std::size_t point, std::size_t particle) {
      for (std::size_t k = 0; k < width; ++k)
        found[width * point + k] = values[width * particle + k];
    };
    for (std::size_t i = 0; i < cells_.points.size(); ++i)
      if (cells_.id[i] >= 0) copy(i, static_cast<std::size_t>(cells_.id[i]));
    parallel_for(followers_.size(), at_a_time, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) {
        const std::uint32_t first = skin_.first[f], last = skin_.first[f + 1];
        if constexpr (std::is_floating_point_v<std::decay_t<decltype(values[0])>>) {
          for (std::uint32_t e = first; e < last; ++e)
            for (std::size_t k = 0; k < width; ++k)
              found[width * followers_[f] + k] +=
                  skin_.weight[e] * values[width * particle_of(skin_, e) + k];
        } else {
          const auto heaviest =
              std::max_element(skin_.weight.begin() + first, skin_.weight.begin() + last);
          copy(followers_[f],
               particle_of(skin_, static_cast<std::uint32_t>(heaviest - skin_.weight.begin())));
        }
      }
    });
    return Column{of_particles.name, of_particles.components, std::move(found)};
  };
  return std::visit(find, of_particles.values);
}

std::vector<double> MovingCells::volume_ratios(const Points& now) const {
  std::vector<double> ratios(cells_.cells.size());
  parallel_for(ratios.size(), at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      ratios[c] = volume_of(now, cells_.cells[c]) / volume_[c];
  });
  return ratios;
}

std::vector<std::int32_t> MovingCells::torn(const std::vector<char>& apart,
                                            const std::vector<double>& volume_ratios) const {
  std::vector<std::int32_t> torn(cells_.cells.size());
  for (const auto& [pair, cell] : pair_of_cell_)
    if (apart[pair]) torn[cell] = 1;
  std::vector<char> at_crack(cells_.points.size());
  const auto mark = [&](std::size_t cell) {
    for (const std::uint32_t point : cells_.cells[cell]) at_crack[point] = 1;
  };
  std::vector<std::size_t> stretched;
  for (std::size_t c = 0; c < torn.size(); ++c)
    if (torn[c] != 0)
      mark(c);
    else if (volume_ratios[c] > largest_whole)
      stretched.push_back(c);
  const auto reached = [&](std::size_t c) {
    const auto& points = cells_.cells[c];
    if (std::none_of(points.begin(), points.end(), [&](auto point) { return at_crack[point]; }))
      return false;
    torn[c] = 1, mark(c);
    return true;
  };
  while (std::erase_if(stretched, reached) > 0) {
  }
  return torn;
}

}  // namespace sinew
