// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/lattice.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/local_origin.h>
#include <sinew/core/particles.h>

namespace sinew {

namespace {

/// Unit of all coordinates: sums of two coordinates still fit into 53 bits.
double quantum(const Box& box, const Vec3& origin, const Vec3& unit) {
  const double farthest =
      std::max({box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff(),
                origin.cwiseAbs().maxCoeff()}) +
      2 * unit.maxCoeff();
  return std::ldexp(1.0, std::ilogb(farthest) - 51);
}

Vec3 rounded(const Vec3& v, double quantum) {
  return (v / quantum).array().round().matrix() * quantum;
}

/// Steps from the origin to a side of the box. Rounding must not exclude a site on the surface.
int steps(double length, double unit) { return static_cast<int>(std::floor(length / unit + 1e-9)); }

bool odd(int i) { return i % 2 != 0; }

int floor_third(int i) { return i >= 0 ? i / 3 : -((2 - i) / 3); }

/// Rows along (1, 1, 0) of the sites with i + j + k even: i - j is constant in each.
void add_fcc_layer(Lattice& lattice, int k) {
  const LatticePlace &low = lattice.low, &high = lattice.high;
  int across = low[0] - high[1];
  if (odd(across) != odd(k)) ++across;
  LatticeLayer layer{lattice.rows.size(), 0, across};
  for (; across <= high[0] - low[1]; across += 2, ++layer.rows) {
    const int from = std::max(low[0], across + low[1]);
    const int to = std::min(high[0], across + high[1]);
    lattice.rows.push_back({{from, from - across, k}, std::max(0, to - from + 1)});
  }
  lattice.layers.push_back(layer);
}

/// Rows along x in steps of 2 r; layers alternate, every second one above the first one's hollows.
void add_hcp_layer(Lattice& lattice, int k) {
  const LatticePlace &low = lattice.low, &high = lattice.high;
  const int dip = odd(k) ? 1 : 0;
  int row = floor_third(low[1] - dip + 2);  // the first with 3 row + dip >= low
  LatticeLayer layer{lattice.rows.size(), 0, 3 * row + dip};
  for (; 3 * row + dip <= high[1]; ++row, ++layer.rows) {
    const int from = odd(low[0]) == odd(row + dip) ? low[0] : low[0] + 1;
    lattice.rows.push_back({{from, 3 * row + dip, k}, std::max(0, (high[0] - from) / 2 + 1)});
  }
  lattice.layers.push_back(layer);
}

}  // namespace

std::int64_t Lattice::row_at(int k, int across) const {
  if (k < low[2] || k > high[2]) return -1;
  const LatticeLayer& layer = layers[k - low[2]];
  const int step = packing == Packing::fcc ? 2 : 3, from = across - layer.across;
  if (from < 0 || from % step != 0 || from / step >= layer.rows) return -1;
  return static_cast<std::int64_t>(layer.first_row) + from / step;
}

std::span<const LatticePlace, 12> Lattice::nearest(int k) const {
  using Steps = std::array<LatticePlace, 12>;
  static constexpr Steps fcc = {{{1, 1, 0},
                                 {-1, -1, 0},
                                 {1, -1, 0},
                                 {-1, 1, 0},
                                 {1, 0, 1},
                                 {-1, 0, 1},
                                 {0, 1, 1},
                                 {0, -1, 1},
                                 {1, 0, -1},
                                 {-1, 0, -1},
                                 {0, 1, -1},
                                 {0, -1, -1}}};
  static constexpr Steps hcp_even = {{{2, 0, 0},
                                      {-2, 0, 0},
                                      {1, 3, 0},
                                      {-1, 3, 0},
                                      {1, -3, 0},
                                      {-1, -3, 0},
                                      {1, 1, 1},
                                      {-1, 1, 1},
                                      {0, -2, 1},
                                      {1, 1, -1},
                                      {-1, 1, -1},
                                      {0, -2, -1}}};
  static constexpr Steps hcp_odd = {{{2, 0, 0},
                                     {-2, 0, 0},
                                     {1, 3, 0},
                                     {-1, 3, 0},
                                     {1, -3, 0},
                                     {-1, -3, 0},
                                     {1, -1, 1},
                                     {-1, -1, 1},
                                     {0, 2, 1},
                                     {1, -1, -1},
                                     {-1, -1, -1},
                                     {0, 2, -1}}};
  if (packing == Packing::fcc) return fcc;
  return odd(k) ? hcp_odd : hcp_even;
}

std::uint64_t Lattice::sites() const {
  std::uint64_t sum = 0;
  for (const LatticeRow& row : rows) sum += row.sites;
  return sum;
}

Lattice lattice_in(const Box& box, Packing packing, double radius,
                   const std::optional<Vec3>& origin, double min_step) {
  const bool fcc = packing == Packing::fcc;
  const Vec3 center = origin.value_or(box.center());
  const Vec3 unit = fcc ? Vec3(Vec3::Constant(half_plane_spacing(radius)))
                        : Vec3(radius, radius / std::sqrt(3.0), radius * std::sqrt(8.0 / 3));
  const double step = std::max(quantum(box, center, unit), min_step);
  Lattice lattice;
  lattice.packing = packing;
  lattice.radius = radius;
  // Up: spacing is at least 2r, and a face n layers away stays outside.
  lattice.unit = (unit / step).array().ceil().matrix() * step;
  lattice.origin = rounded(center, step);
  lattice.along = fcc ? LatticePlace{1, 1, 0} : LatticePlace{2, 0, 0};
  for (int axis = 0; axis < 3; ++axis) {
    const double at = lattice.origin[axis], size = lattice.unit[axis];
    lattice.low[axis] = -steps(at - box.min()[axis], size);
    lattice.high[axis] = steps(box.max()[axis] - at, size);
  }
  for (int k = lattice.low[2]; k <= lattice.high[2]; ++k)
    fcc ? add_fcc_layer(lattice, k) : add_hcp_layer(lattice, k);
  return lattice;
}

LatticeSize lattice_size(const Box& box, double radius) {
  const Vec3 layers = box.sizes() / half_plane_spacing(radius) + Vec3::Ones();
  return {layers.prod() / 2, layers.z() * (layers.x() + layers.y())};
}

namespace {

/// A number near the center of low .. high whose difference to any double between them is exact; 0
/// where they are near 0 already.
double exact_shift(double low, double high) {
  const double nearest = std::min(std::abs(low), std::abs(high)), size = high - low;
  if (low * high <= 0 || nearest < 2 * size) return 0;
  const double step = std::ldexp(1.0, std::ilogb(nearest) - 52);  // all of them are multiples
  return std::round((low + size / 2) / step) * step;
}

}  // namespace

LatticeFrame::LatticeFrame(const Points& points, const Mat3& turn)
    : turn_(turn), turned_(turn != Mat3::Identity()) {
  const Box box = bounds(points);
  for (int axis = 0; axis < 3; ++axis) shift_[axis] = exact_shift(box.min()[axis], box.max()[axis]);
  if (!local_origin(box).isZero(0))
    step_ = std::ldexp(1.0, std::ilogb(box.center().cwiseAbs().maxCoeff()) - 51);
}

Triangles LatticeFrame::to_lattice(Triangles surface) const {
  for (Vec3& point : surface.points) point = to_lattice(point);
  return surface;
}

Vec3 LatticeFrame::to_lattice(const Vec3& point) const {
  const Vec3 near = point - shift_;
  return turned_ ? Vec3(turn_.transpose() * near) : near;
}

Vec3 LatticeFrame::from_lattice(const Vec3& site) const {
  return (turned_ ? Vec3(turn_ * site) : site) + shift_;
}

}  // namespace sinew
