// SPDX-License-Identifier: GPL-3.0-or-later
// The crossings of the rows of a lattice with a surface: one exact ray per row instead of one query
// per site. The sum of signed crossings along a row is the winding number of a closed surface; the
// cost is proportional to triangles and crossings, not to sites.
//
// Decisions use exact predicates. A row that meets an edge or lies in a face is treated as shifted
// infinitesimally across (the first of two symbolic shifts, the second along z): so no row meets an
// edge, and a crossing of two triangles' common edge is counted once.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/fill/lattice.h>

namespace sinew {

// A lattice projected along its rows: each row is a point (across, up) of a plane, in which the
// rows of a layer are evenly spaced.

inline constexpr double rounding = 1.2e-16;  // relative error of one operation, slightly enlarged

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

  /// A point relative to the lattice's origin, m, in right-handed axes: x along the rows, z up.
  Vec3 turned(const Vec3& p) const {
    Vec3 from = p - lattice_.origin;
    if (!fcc_) return from;
    constexpr double half = std::numbers::sqrt2 / 2;
    return {(from.x() + from.y()) * half, (from.y() - from.x()) * half, from.z()};
  }

  /// b - a in these axes. Accurate across and up even where it is much longer along the rows.
  Vec3 turned_between(const Vec3& a, const Vec3& b) const {
    Vec3 d = b - a;
    if (!fcc_) return d;
    constexpr double half = std::numbers::sqrt2 / 2;
    const double lost = lost_in(b.y(), a.y(), d.y()) - lost_in(b.x(), a.x(), d.x());
    return {(d.x() + d.y()) * half, ((d.y() - d.x()) + lost) * half, d.z()};
  }

  /// Whether rows run along (1, 1, 0) rather than along x.
  bool diagonal() const { return fcc_; }

  double layer_up(int layer) const {
    return lattice_.origin.z() + lattice_.unit.z() * (lattice_.low[2] + layer);
  }
  double row_across(const LatticeLayer& layer, int row) const {  // exact
    return across_origin_ + across_unit_ * (layer.across + across_step_ * row);
  }

  /// Fractional index of a position among the rows of a layer, and among the layers, from 0.
  double row_at(const LatticeLayer& layer, double across) const {
    return ((across - across_origin_) / across_unit_ - layer.across) / across_step_;
  }
  double layer_at(double up) const {
    return (up - lattice_.origin.z()) / lattice_.unit.z() - lattice_.low[2];
  }

  /// Fractional index of the site at coordinate x of a row, from its first.
  double site_at(const LatticeRow& row, double x) const {
    const double first = lattice_.origin.x() + lattice_.unit.x() * row.first[0];
    return (x - first) / (lattice_.unit.x() * lattice_.along[0]);
  }
  double site_step() const { return lattice_.unit.x() * lattice_.along[0]; }  ///< in x, m

 private:
  /// Rounding error of the difference d = a - b (Knuth).
  static double lost_in(double a, double b, double d) {
    const double part = d - a;
    return (a - (d - part)) - (b + part);
  }

  const Lattice& lattice_;
  bool fcc_;
  double across_origin_, across_unit_;
  int across_step_;
};

// The side on which an edge passes a row, seen along the row: exact, and without ties.

class RowSide {
 public:
  /// No coordinate of an edge may exceed `largest`, m.
  RowSide(const Lattice& lattice, double largest);

  /// The sign of (a - q) x (b - q) in the plane (across, up), q being the row; 0: the row meets the
  /// edge's line.
  int exact(const Vec3& a, const Vec3& b, const LatticeRow& row) const;

  /// The sign that replaces an exact 0 when the row is shifted infinitesimally across, and by much
  /// less up; 0 only for edges along the row.
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
  auto operator<=>(const RowSite&) const = default;  // NOLINT(modernize-use-nullptr)
};

struct RowCrossings {
  std::vector<std::size_t> first;   ///< index of each row's first crossing, and the total number
  std::vector<Crossing> crossings;  ///< crossings by row, then site, then face
  std::vector<RowSite> on_surface;  ///< sites exactly on a triangle, sorted, each once

  std::span<const Crossing> of(std::size_t row) const {
    return {crossings.data() + first[row], first[row + 1] - first[row]};
  }
};

/// Accepts any triangles. The same for any number of threads.
RowCrossings row_crossings(const Lattice& lattice, const Triangles& surface);

/// Adds those of other faces, which are numbered from `first_face` on. Sites on these do not count.
void add_crossings(const RowCrossings& others, int first_face, RowCrossings& all);

}  // namespace sinew
