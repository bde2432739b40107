// SPDX-License-Identifier: GPL-3.0-or-later
// Where the rows of a lattice cross a surface: one exact ray per row instead of one query per site.
// Along a row the sum of signed crossings so far is the winding number of a closed surface, and the
// cost grows with triangles and crossings, not with sites.
//
// Decisions are those of exact predicates. Where a row meets an edge or lies in a face it counts as
// shifted a little across (the first of two symbolic shifts, the second along z): so no row ever
// meets an edge, and a crossing of two triangles' common edge is counted once.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/fill/lattice.h>

namespace sinew {

// A lattice seen along its rows: each row is one point (across, up) of a plane, in which the rows
// of a layer follow each other evenly.

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

// On which side of a row an edge passes it, seen along the row: exactly, and without ties.

class RowSide {
 public:
  /// No coordinate of an edge may exceed `largest`, m.
  RowSide(const Lattice& lattice, double largest);

  /// The sign of (a - q) x (b - q) in the plane (across, up), q being the row; 0: the row meets the
  /// edge's line.
  int exact(const Vec3& a, const Vec3& b, const LatticeRow& row) const;

  /// What an exact sign of 0 becomes when the row is shifted a little across, and by much less up;
  /// 0 only for edges along the row.
  int shifted(const Vec3& a, const Vec3& b) const;

  /// A bound on all coordinates, and on `across`, m.
  double extent() const { return extent_; }

 private:
  const Lattice& lattice_;
  RowFrame frame_;
  double extent_;
};

/// The largest coordinate of a lattice's box and of points, in absolute value, m.
double largest_coordinate(const Lattice& lattice, const Points& points);

struct Crossing {
  std::int32_t site;  ///< the first site of the row at or beyond the crossing; may be past the last
  std::int32_t face;
  std::int32_t winding;  ///< +1 where the row enters through the face's front, -1 where it leaves
};

struct RowSite {
  std::int32_t row, site;
  auto operator<=>(const RowSite&) const = default;
};

struct RowCrossings {
  std::vector<std::size_t> first;   ///< of each row, and one past the last row's end
  std::vector<Crossing> crossings;  ///< by row, then site, then face
  std::vector<RowSite> on_surface;  ///< sites exactly on a triangle, sorted, each once

  std::span<const Crossing> of(std::size_t row) const {
    return {crossings.data() + first[row], first[row + 1] - first[row]};
  }
};

/// Any triangles will do. The same for every number of threads.
RowCrossings row_crossings(const Lattice& lattice, const Triangles& surface);

}  // namespace sinew
