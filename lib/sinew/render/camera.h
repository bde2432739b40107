// SPDX-License-Identifier: GPL-3.0-or-later
// The camera of a picture: a parallel projection, so that sizes can be compared anywhere in it.
//
//     const Camera camera{three_quarter_view(), seen(three_quarter_view(), snapshot)};
#pragma once

#include <sinew/render/snapshot.h>

namespace sinew {

/// Rows: to the right, up, and toward the viewer, who is in front of the body (at -y), slightly to
/// its right and above; z is up. A bend in the x-z plane appears nearly at its true size.
Mat3 three_quarter_view();

/// The view from the direction `towards_viewer` (not along z, not zero).
Mat3 view_from(const Vec3& towards_viewer);

/// The view from above, x to the right and y upward.
Mat3 view_from_above();

struct Camera {
  Mat3 view = three_quarter_view();
  Box frame;  ///< in the view's axes, m; all of it is in the picture
};

/// The box around everything in `snapshot` in the axes of `view`, m; empty for an empty
/// snapshot. Throws bad input for positions that are not finite.
Box seen(const Mat3& view, const Snapshot& snapshot);

/// The upright cylinder about `axis` (a point on it) that holds everything of snapshots: what a
/// camera has to show that turns about it.
struct Cylinder {
  Vec3 axis = Vec3::Zero();
  double radius = 0, low = 0, high = 0;  ///< low and high above the axis' point, m

  void extend(const Snapshot& snapshot);  ///< throws as seen() does
  void extend(const Cylinder& other);
};

/// `camera` moved about the cylinder's axis by `angle` (rad; counterclockwise seen from above). All
/// of the cylinder is in the picture, at every angle at the same place and scale.
Camera orbiting(const Cylinder& cylinder, const Mat3& view, double angle);

/// Meters per pixel at which `frame` just fits into a picture.
double meters_per_pixel(const Box& frame, int width, int height);

}  // namespace sinew
