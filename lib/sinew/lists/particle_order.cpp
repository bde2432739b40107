// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lists/particle_order.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <sinew/body/grouping.h>
#include <sinew/core/parallel.h>

namespace sinew {

namespace {

constexpr std::size_t particles_per_copy = 16384;
constexpr std::size_t columns_per_piece = 64;

/// How columns divide the body's bounding box.
struct Columns {
  int along = 0;                    ///< axis along the columns
  std::array<int, 2> across{1, 2};  ///< the others
  std::array<double, 3> low{};
  double edge = 1;
  std::int64_t rows = 1, places = 1;  ///< columns: rows x places

  std::size_t count() const { return static_cast<std::size_t>(rows * places); }
  /// Rows run back and forth.
  std::uint32_t of(double a, double b) const {
    const auto row = std::min(static_cast<std::int64_t>((a - low[across[0]]) / edge), rows - 1);
    const auto at = std::min(static_cast<std::int64_t>((b - low[across[1]]) / edge), places - 1);
    return static_cast<std::uint32_t>(row * places + (row % 2 == 0 ? at : places - 1 - at));
  }
};

template <class Coord>
Columns columns_of(const std::array<Coord*, 3>& x, std::size_t count, double edge) {
  Columns columns;
  std::array<double, 3> size{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax_element(x[axis], x[axis] + count);
    columns.low[axis] = static_cast<double>(*low);
    size[axis] = static_cast<double>(*high) - columns.low[axis];
  }
  columns.along = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
  columns.across = {(columns.along + 1) % 3, (columns.along + 2) % 3};
  columns.edge = edge;
  const double most = 2.0 * static_cast<double>(count) + 1024;  // a particle may be far away
  const auto along = [&](int side) {
    return std::floor(size[columns.across[side]] / columns.edge) + 1;
  };
  while (along(0) * along(1) > most) columns.edge *= 1.5;
  columns.rows = static_cast<std::int64_t>(along(0));
  columns.places = static_cast<std::int64_t>(along(1));
  return columns;
}

constexpr double off_lattice = 1e-3;    // in spacings of planes
constexpr double farthest_plane = 1e9;  // still a whole number of 32 bits

/// Lattice planes of a group of particles, slowest axis first.
struct Planes {
  std::array<Vec3, 3> axes;

  Planes(const Mat3& lattice, const Vec3& across) {
    int slowest = 0;
    (lattice.transpose() * across).cwiseAbs().maxCoeff(&slowest);
    // The later one of the other two is slower, as in a body filled row by row.
    const int fastest = slowest == 0 ? 1 : 0, middle = 3 - slowest - fastest;
    axes = {lattice.col(slowest), lattice.col(middle), lattice.col(fastest)};
  }
};

using Site = std::array<std::int32_t, 3>;

/// Particles of a body by their places in a list of ids.
struct Listed {
  const Body& body;
  std::span<const std::int32_t> id;

  const Vec3& rest(std::uint32_t place) const {
    return body.rest[static_cast<std::size_t>(id[place])];
  }
};

/// The sites of the particles `group`; none where they are on no lattice.
std::vector<Site> sites_of(const Listed& particles, const std::vector<std::uint32_t>& group,
                           const Planes& planes) {
  const double spacing = half_plane_spacing(particles.body.material.pair.r);
  std::vector<Site> sites(group.size());
  const auto find_sites = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Vec3 from = particles.rest(group[k]) - particles.rest(group[0]);
      for (int axis = 0; axis < 3; ++axis) {
        const double at = from.dot(planes.axes[axis]) / spacing, whole = std::round(at);
        if (!(std::abs(at) < farthest_plane && std::abs(at - whole) < off_lattice)) return 1.0;
        sites[k][axis] = static_cast<std::int32_t>(whole);
      }
    }
    return 0.0;
  };
  const double off = parallel_sum(group.size(), particles_per_copy, find_sites);
  return off > 0 ? std::vector<Site>() : sites;
}

/// Sorts `order` by one coordinate of the sites, keeping the order of equal ones.
void sort_by(const std::vector<Site>& sites, int axis, std::vector<std::uint32_t>& order) {
  const auto [low, high] = std::minmax_element(
      sites.begin(), sites.end(), [&](const Site& a, const Site& b) { return a[axis] < b[axis]; });
  const std::int64_t least = (*low)[axis], planes = (*high)[axis] - least + 1;
  if (planes > 4 * static_cast<std::int64_t>(sites.size()) + 1024) {  // a particle far away
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return sites[a][axis] < sites[b][axis];
    });
    return;
  }
  std::vector<std::uint32_t> first(static_cast<std::size_t>(planes) + 1, 0);
  for (const Site& site : sites) ++first[static_cast<std::size_t>(site[axis] - least) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> sorted(order.size());
  for (const std::uint32_t k : order)
    sorted[first[static_cast<std::size_t>(sites[k][axis] - least)]++] = k;
  order = std::move(sorted);
}

/// The direction along which the particles `group` extend farthest.
Vec3 longest_side(const Listed& particles, const std::vector<std::uint32_t>& group) {
  const Mat3& lattice = particles.body.lattice;
  Box box;
  for (const std::uint32_t place : group) box.extend(lattice.transpose() * particles.rest(place));
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  return lattice.col(axis);
}

void sort_by_planes(const Listed& particles, const Vec3& across,
                    std::vector<std::uint32_t>& group) {
  const std::vector<Site> sites =
      sites_of(particles, group, Planes(particles.body.lattice, across));
  if (sites.empty()) return;
  std::vector<std::uint32_t> order(group.size());
  std::iota(order.begin(), order.end(), 0U);
  for (const int axis : {2, 1, 0}) sort_by(sites, axis, order);
  std::vector<std::uint32_t> sorted(group.size());
  for (std::size_t k = 0; k < order.size(); ++k) sorted[k] = group[order[k]];
  group = std::move(sorted);
}

/// Where the members of each of some sets are in an order, on average; -1 for none.
template <class SetOf>
std::vector<double> means_of(const std::vector<std::uint32_t>& order, std::size_t sets,
                             const SetOf& set_of) {
  std::vector<double> sum(sets, 0), count(sets, 0);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t set = set_of(k);
    if (set < sets) sum[set] += static_cast<double>(k), count[set] += 1;
  }
  for (std::size_t set = 0; set < sets; ++set)
    sum[set] = count[set] > 0 ? sum[set] / count[set] : -1;
  return sum;
}

/// Parts each group into its core, its shell and its rim, face by face, and the free particles into
/// those between groups, in the same order otherwise. What is next to each other remains so: pieces
/// of distant particles would be near everything.
void sort_by_layers(const Grouping& grouping, std::span<const std::int32_t> id,
                    std::vector<std::uint32_t>& order) {
  constexpr std::size_t layers = 4, faces = 64;
  const std::size_t free = grouping.size() * layers * faces;
  const auto group_of = [&](std::size_t k) {
    return static_cast<std::size_t>(grouping.group[static_cast<std::size_t>(id[order[k]])]);
  };
  std::vector<double> groups = means_of(order, grouping.size(), group_of);
  std::sort(groups.begin(), groups.end());
  std::vector<std::size_t> part(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto i = static_cast<std::size_t>(id[order[k]]);
    const auto before = std::lower_bound(groups.begin(), groups.end(), static_cast<double>(k));
    part[k] = grouping.group[i] < 0
                  ? free + static_cast<std::size_t>(before - groups.begin())
                  : (group_of(k) * layers + static_cast<std::size_t>(grouping.layer[i])) * faces +
                        grouping.face[i];
  }
  const std::vector<double> means =
      means_of(order, free + grouping.size() + 1, [&](std::size_t k) { return part[k]; });
  std::vector<std::uint32_t> at(order.size());
  std::iota(at.begin(), at.end(), 0U);
  std::stable_sort(at.begin(), at.end(), [&](std::uint32_t a, std::uint32_t b) {
    return means[part[a]] != means[part[b]] ? means[part[a]] < means[part[b]] : part[a] < part[b];
  });
  for (std::uint32_t& k : at) k = order[k];
  order = std::move(at);
}

}  // namespace

std::vector<std::uint32_t> order_at_rest(const Body& body, std::span<const std::int32_t> id) {
  const Listed particles{body, id};
  const std::size_t bones = body.skeleton.size();
  std::vector<std::vector<std::uint32_t>> groups(bones + 1);
  for (std::uint32_t place = 0; place < id.size(); ++place) {
    const int bone = body.binding.bone(static_cast<std::size_t>(id[place]));
    groups[bone == no_bone ? bones : static_cast<std::size_t>(bone)].push_back(place);
  }
  parallel_for(groups.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      if (groups[b].empty()) continue;
      const Vec3 across =
          b < bones ? body.skeleton.bones[b].axis() : longest_side(particles, groups[b]);
      sort_by_planes(particles, across, groups[b]);
    }
  });
  std::vector<std::uint32_t> order;
  order.reserve(id.size());
  for (const auto& group : groups) order.insert(order.end(), group.begin(), group.end());
  if (body.grouping) sort_by_layers(*body.grouping, id, order);
  return order;
}

template <class Real>
std::vector<std::uint32_t> order_by_columns(BlockState<Real>& state, double edge) {
  const std::size_t n = state.size();
  const auto arrays = state.arrays();
  const std::array x{arrays.x[0], arrays.x[1], arrays.x[2]};
  const Columns columns = columns_of(x, n, edge);
  std::vector<std::uint32_t> column(n), first(columns.count() + 1, 0), order(n);
  parallel_for(n, particles_per_copy, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      column[k] = columns.of(static_cast<double>(x[columns.across[0]][k]),
                             static_cast<double>(x[columns.across[1]][k]));
  });
  for (const std::uint32_t c : column) ++first[c + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::size_t k = 0; k < n; ++k) order[next[column[k]]++] = static_cast<std::uint32_t>(k);
  const auto* along = x[columns.along];
  parallel_for(columns.count(), columns_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      std::sort(order.begin() + first[c], order.begin() + first[c + 1],
                [&](std::uint32_t a, std::uint32_t b) {
                  return along[a] != along[b] ? along[a] < along[b] : a < b;
                });
  });
  return order;
}

template <class Real>
void reorder(BlockState<Real>& from, const std::vector<std::uint32_t>& order,
             BlockState<Real>& to) {
  const auto a = from.arrays(), b = to.arrays();
  parallel_for(order.size(), particles_per_copy, [&](std::size_t begin, std::size_t end) {
    for (int axis = 0; axis < 3; ++axis)
      for (std::size_t k = begin; k < end; ++k) {
        b.x[axis][k] = a.x[axis][order[k]];
        b.v[axis][k] = a.v[axis][order[k]];
      }
  });
  to.pad();
}

template std::vector<std::uint32_t> order_by_columns(BlockState<double>&, double);
template std::vector<std::uint32_t> order_by_columns(BlockState<float>&, double);
template void reorder(BlockState<double>&, const std::vector<std::uint32_t>&, BlockState<double>&);
template void reorder(BlockState<float>&, const std::vector<std::uint32_t>&, BlockState<float>&);

}  // namespace sinew
