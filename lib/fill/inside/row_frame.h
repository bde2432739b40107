// SPDX-License-Identifier: GPL-3.0-or-later
// A lattice seen along its rows: each row is one point (across, up) of a plane, in which the rows
// of a layer follow each other evenly.
#pragma once

#include <cmath>
#include <numbers>

#include "fill/lattice.h"

namespace sinew {

inline constexpr double rounding = 1.2e-16;  // of one operation, relative, and a little more

class RowFrame {
 public:
  explicit RowFrame(const Lattice& lattice)
      : lattice_(lattice),
        fcc_(lattice.packing == Packing::fcc),
        across_origin_(fcc_ ? lattice.origin.x() - lattice.origin.y() : lattice.origin.y()),
        across_unit_(fcc_ ? lattice.unit.x() : lattice.unit.y()),
        across_step_(fcc_ ? 2 : 3) {}

  /// FCC: x - y, rounded; HCP: y.
  double across(const Vec3& p) const { return fcc_ ? p.x() - p.y() : p.y(); }

  /// +1 where (along, across, up) is right-handed, else -1.
  int handedness() const { return fcc_ ? -1 : 1; }

  /// A point relative to the lattice's origin, in right-handed axes of which x runs along the rows
  /// and z up, m.
  Vec3 turned(const Vec3& p) const {
    const Vec3 from = p - lattice_.origin;
    if (!fcc_) return from;
    constexpr double half = std::numbers::sqrt2 / 2;
    return {(from.x() + from.y()) * half, (from.y() - from.x()) * half, from.z()};
  }

  /// The way from a to b in these axes. Across and up it is right to the last bits even where the
  /// way along is much longer.
  Vec3 turned_between(const Vec3& a, const Vec3& b) const {
    const Vec3 way = b - a;
    if (!fcc_) return way;
    constexpr double half = std::numbers::sqrt2 / 2;
    const double lost = lost_in(b.y(), a.y(), way.y()) - lost_in(b.x(), a.x(), way.x());
    return {(way.x() + way.y()) * half, ((way.y() - way.x()) + lost) * half, way.z()};
  }

  /// Whether rows run along (1, 1, 0) rather than along x.
  bool diagonal() const { return fcc_; }

  double layer_up(int layer) const {
    return lattice_.origin.z() + lattice_.unit.z() * (lattice_.low[2] + layer);
  }
  double row_across(const LatticeLayer& layer, int row) const {  // exact
    return across_origin_ + across_unit_ * (layer.across + across_step_ * row);
  }

  /// Where among the rows of a layer, and among the layers, something lies: 0 is the first.
  double row_at(const LatticeLayer& layer, double across) const {
    return ((across - across_origin_) / across_unit_ - layer.across) / across_step_;
  }
  double layer_at(double up) const {
    return (up - lattice_.origin.z()) / lattice_.unit.z() - lattice_.low[2];
  }

  /// Along a row x alone tells where: the site at x, as a number of sites from the row's first.
  double site_at(const LatticeRow& row, double x) const {
    const double first = lattice_.origin.x() + lattice_.unit.x() * row.first[0];
    return (x - first) / (lattice_.unit.x() * lattice_.along[0]);
  }
  double site_step() const { return lattice_.unit.x() * lattice_.along[0]; }  ///< in x, m

 private:
  /// What rounding took from the difference d = a - b (Knuth).
  static double lost_in(double a, double b, double d) {
    const double part = d - a;
    return (a - (d - part)) - (b + part);
  }

  const Lattice& lattice_;
  bool fcc_;
  double across_origin_, across_unit_;
  int across_step_;
};

}  // namespace sinew
