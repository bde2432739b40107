// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/core/parallel.h>
#include <sinew/volume/detail/scaffold.h>

namespace sinew {
namespace {

using CellOfSite = std::array<LatticePlace, 4>;
using CellsOfSite = std::array<CellOfSite, 6>;

constexpr std::size_t sites_at_a_time = 1024;
constexpr double margin = 3;  // radii: no cell with a site inside reaches farther

/// The regular tetrahedra in two of the eight unit cubes around a site, and the octahedron above
/// it, whose upright diagonal is the edge of its four parts.
constexpr CellsOfSite fcc_cells = {{{{{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}}},
                                    {{{0, 0, 0}, {-1, 1, 0}, {-1, 0, 1}, {0, 1, 1}}},
                                    {{{0, 0, 0}, {0, 0, 2}, {1, 0, 1}, {0, 1, 1}}},
                                    {{{0, 0, 0}, {0, 0, 2}, {0, 1, 1}, {-1, 0, 1}}},
                                    {{{0, 0, 0}, {0, 0, 2}, {-1, 0, 1}, {0, -1, 1}}},
                                    {{{0, 0, 0}, {0, 0, 2}, {0, -1, 1}, {1, 0, 1}}}}};

/// A site with the three above it, with the three below it, and the octahedron between its layer
/// and the next one. Layers alternate: in odd ones all is mirrored across.
constexpr CellsOfSite hcp_cells(int across) {
  const LatticePlace far = {0, 4 * across, 1}, a = {1, 3 * across, 0}, b = {-1, 3 * across, 0},
                     c = {-1, across, 1}, d = {1, across, 1};
  const LatticePlace above = {0, -2 * across, 1}, left = {1, across, -1}, right = {-1, across, -1},
                     below = {0, -2 * across, -1};
  return {{{{{0, 0, 0}, c, d, above}},
           {{{0, 0, 0}, left, right, below}},
           {{{0, 0, 0}, far, a, b}},
           {{{0, 0, 0}, far, b, c}},
           {{{0, 0, 0}, far, c, d}},
           {{{0, 0, 0}, far, d, a}}}};
}

const CellsOfSite& cells_of_site(Packing packing, int k) {
  static constexpr CellsOfSite even = hcp_cells(1), odd = hcp_cells(-1);
  if (packing == Packing::fcc) return fcc_cells;
  return k % 2 != 0 ? odd : even;
}

Lattice lattice_around(const BodySpace& space, const PackOptions& options) {
  const Vec3 beyond = Vec3::Constant(margin * *options.radius);
  return lattice_in(Box(space.box.min() - beyond, space.box.max() + beyond), options.packing,
                    *options.radius, space.lattice_origin.value_or(space.box.center()));
}

}  // namespace

Honeycomb::Honeycomb(Lattice lattice) : lattice_(std::move(lattice)), first_{0} {
  for (const LatticeRow& row : lattice_.rows) first_.push_back(first_.back() + row.sites);
  const auto sites = static_cast<std::size_t>(first_.back());
  body_.assign(sites, -1);
  particle_.assign(sites, -1);
}

Honeycomb::Honeycomb(Lattice lattice, const std::function<bool(const Vec3& site)>& inside)
    : Honeycomb(std::move(lattice)) {
  take_inside(inside);
}

Honeycomb::Honeycomb(const BodySpace& space, const PackOptions& options, const Points& rest)
    : Honeycomb(lattice_around(space, options)) {
  find_inside(space, options);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const std::int64_t site = site_at(place_of(rest[i]));
    if (site < 0) continue;
    particle_[site] = static_cast<std::int32_t>(i);
    if (body_[site] < 0) body_[site] = 0;
  }
}

void Honeycomb::take_inside(const std::function<bool(const Vec3& site)>& inside) {
  parallel_for(lattice_.rows.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (int n = 0; n < lattice_.rows[row].sites; ++n)
        if (inside(lattice_.site(lattice_.rows[row], n))) body_[first_[row] + n] = 0;
  });
}

void Honeycomb::find_inside(const BodySpace& space, const PackOptions& options) {
  if (options.thickness) {
    const InsideSpace layer(space.surface, options.thickness);
    return take_inside([&](const Vec3& site) { return layer.contains(site); });
  }
  InsideRuns inside = inside_runs(lattice_, space.surface);
  for (const Run& run : inside.runs)
    for (int n = run.first; n < run.last; ++n)
      body_[first_[run.row] + n] = inside.bodies > 0 ? inside.block_of[run.body] : run.body;
  body_of_ = std::move(inside.body_of);
  for (int& body : body_of_)
    if (body >= 0) body = inside.block_of[body];
  bodies_ = std::max(1, inside.bodies);
}

Surface Honeycomb::faces_of(const Surface& surface, int body) const {
  Surface part = surface;
  if (bodies_ == 1) return part;
  part.triangles.faces.clear();
  for (std::size_t f = 0; f < surface.triangles.faces.size(); ++f)
    if (const int of = body_of_[surface.component[f]]; of == body || of < 0)
      part.triangles.faces.push_back(surface.triangles.faces[f]);
  return part;
}

LatticePlace Honeycomb::place_of(const Vec3& point) const {
  LatticePlace place;
  for (int axis = 0; axis < 3; ++axis)
    place[axis] =
        static_cast<int>(std::lround((point[axis] - lattice_.origin[axis]) / lattice_.unit[axis]));
  return place;
}

std::int64_t Honeycomb::site_at(const LatticePlace& place) const {
  const bool fcc = lattice_.packing == Packing::fcc;
  const std::int64_t row = lattice_.row_at(place[2], fcc ? place[0] - place[1] : place[1]);
  if (row < 0) return -1;
  const int n = (place[0] - lattice_.rows[row].first[0]) / lattice_.along[0];
  return n < 0 || n >= lattice_.rows[row].sites ? -1 : first_[row] + n;
}

Scaffold Honeycomb::around(int body) const {
  Scaffold scaffold;
  std::vector<std::array<std::int64_t, 4>> cells;
  std::vector<char> used(body_.size());
  for (const LatticeRow& row : lattice_.rows)
    for (int n = 0; n < row.sites; ++n)
      for (const CellOfSite& steps : cells_of_site(lattice_.packing, row.first[2])) {
        std::array<std::int64_t, 4> cell;
        for (int v = 0; v < 4; ++v) {
          LatticePlace place = row.first;
          for (int axis = 0; axis < 3; ++axis)
            place[axis] += n * lattice_.along[axis] + steps[v][axis];
          cell[v] = site_at(place);
        }
        if (std::any_of(cell.begin(), cell.end(), [](std::int64_t site) { return site < 0; }) ||
            std::none_of(cell.begin(), cell.end(),
                         [&](std::int64_t site) { return body_[site] == body; }))
          continue;
        cells.push_back(cell);
        for (const std::int64_t site : cell) used[site] = 1;
      }
  std::vector<std::uint32_t> number(body_.size());
  for (std::size_t row = 0; row < lattice_.rows.size(); ++row)
    for (int n = 0; n < lattice_.rows[row].sites; ++n) {
      const std::int64_t site = first_[row] + n;
      if (!used[site]) continue;
      number[site] = static_cast<std::uint32_t>(scaffold.points.size());
      scaffold.points.push_back(lattice_.site(lattice_.rows[row], n));
      scaffold.inside.push_back(body_[site] == body);
      scaffold.particle.push_back(body_[site] == body ? particle_[site] : -1);
    }
  for (const auto& [a, b, c, d] : cells)
    scaffold.cells.push_back({number[a], number[b], number[c], number[d]});
  return scaffold;
}

}  // namespace sinew
