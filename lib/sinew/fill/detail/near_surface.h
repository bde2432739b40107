// SPDX-License-Identifier: GPL-3.0-or-later
// The sites of a lattice near a surface: to keep particles clear of it, or to fill a layer on it.
// Triangles dilated by the distance are rasterized onto the rows, without nearest-triangle queries.
// The cost is proportional to the rows that the dilated triangles meet.
//
//     const std::vector<Run> layer = runs_near(lattice, surface, thickness);
#pragma once

#include <array>
#include <limits>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/core/vector.h>
#include <sinew/fill/lattice.h>
#include <sinew/fill/runs.h>

namespace sinew {

// All points within a distance of a triangle, intersected with rows of a lattice, in axes (along,
// across, up) of which the first is that of the rows. The dilated triangle is convex: a slab over
// the face, a cylinder around each side, a ball around each corner. So a line meets it in one
// interval, the hull of its intervals with the parts, each in closed form.

using Corners = std::array<Vec3, 3>;  // also on one line, or at one point

/// The extent, upward, of the points within `distance` of the triangle.
Interval up_reach(const Corners& corners, double distance);

/// Bounds on the rows with up from `low` to `high` that meet these points; may be too large.
Interval across_reach(const Corners& corners, double distance, double low, double high);

class DilatedTriangle {
 public:
  DilatedTriangle(const Corners& corners, double distance);  // m, >= 0

  /// The part of the row through (across, up) within the distance.
  Interval along(double across, double up) const;

  /// Bounds on `along` in a third of the time: may be too large; empty for most rows that miss.
  Interval along_at_most(double across, double up) const;

 private:
  struct Side {
    Vec3 edge;              ///< vector from its corner to the next one
    Vec3 inward;            ///< across the side, in the face
    double across, up;      ///< the direction of `edge` across the rows, of length 1
    double slope, stretch;  ///< length of `edge` along, and in all, per length across the rows
    double squared_length;
  };

  static Side side(const Vec3& edge, const Vec3& normal);
  static void keep_beside(const Side& side, const Vec3& from, double shift, Interval& part);
  void add_ball(const Vec3& from, double along, Interval& all) const;
  void add_cylinder(const Side& side, const Vec3& from, double along, Interval& all) const;
  void add_slab(const Corners& from, Interval& all) const;

  Corners corners_;
  std::array<Side, 3> sides_;
  int longest_ = 0;
  Vec3 normal_;  ///< unit normal; zero where the face has no area
  Vec3 middle_;
  double distance_, squared_distance_;
  double bound_;  ///< radius of a ball around the middle that contains the dilated triangle
};

/// All sites whose distance from the surface is at most `distance` (>= 0, m; from a small part of
/// the spacing to many spacings), as runs of body 0 by row, then site, none touching. Accepts any
/// triangles, also without area. Exact up to rounding: 1e-15 of the coordinates. The same for any
/// number of threads.
std::vector<Run> runs_near(const Lattice& lattice, const Triangles& surface, double distance);

}  // namespace sinew
