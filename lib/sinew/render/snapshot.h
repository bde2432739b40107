// SPDX-License-Identifier: GPL-3.0-or-later
// The input of a picture: one moment of a run as plain values, in the order of the files.
//
//     Snapshot snapshot{.caption = "t = 1 s", .particles = points, .radius = 0.01};
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <sinew/core/color.h>
#include <sinew/core/triangles.h>
#include <sinew/core/vector.h>

namespace sinew {

struct SnapshotBone {
  Vec3 head = Vec3::Zero(), tail = Vec3::Zero();  ///< m
  Mat3 axes = Mat3::Identity();                   ///< columns: along the bone, and two sides
};

/// A vector to be drawn, such as the force on a particle.
struct SnapshotArrow {
  Vec3 from = Vec3::Zero(), along = Vec3::Zero();  ///< m; `along` is the arrow as drawn
  double value = 0;                                ///< shown in color
};

/// The force of a support or a load on the body.
struct SnapshotForce {
  Vec3 from = Vec3::Zero(), along = Vec3::Zero();  ///< m; `along` is the arrow as drawn
  bool is_load = false;                            ///< drawn violet; else of a support, dark
};

/// A line between two points, such as a bond of two particles.
struct SnapshotLine {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< m
  double value = 0;                             ///< shown in color
};

/// A curve, such as a line of stress, with a value at each of its points.
struct SnapshotCurve {
  Points points;               ///< n x 3, m
  std::vector<double> values;  ///< shown in color
};

/// The body as tetrahedra cut open by a plane.
struct SnapshotCut {
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitY();  ///< m; the part toward `normal` is left out
  Points points;                                      ///< n x 3, m
  std::vector<double> values;                         ///< one per point, shown in color
  std::vector<std::array<std::uint32_t, 4>> cells;    ///< cells that the plane crosses
};

/// The path of a picked particle up to this moment.
struct SnapshotTrace {
  Points path;        ///< n x 3, m; ends where the particle is
  std::string label;  ///< beside it
};

/// What a particle is, beside its value.
enum class Mark : std::uint8_t {
  none,
  held,    ///< in place, on a bone or by a support, drawn dark, or with a dark dot
  loaded,  ///< pushed by a force or a pressure, drawn violet
  muscle,  ///< drawn red
  sample,  ///< shown for its size
  within,  ///< other flesh, drawn orange
};

/// One moment. Any part may be empty and is then not drawn.
struct Snapshot {
  std::string caption;              ///< below the picture, may have several lines
  Points particles;                 ///< n x 3, m
  double radius = 0;                ///< radius of each particle, m
  std::vector<double> values;       ///< one per particle, shown in color; empty: all alike
  Triangles surface;                ///< the same faces in all snapshots of a run
  std::vector<double> skin_values;  ///< one per point of the surface, in color; empty: none
  /// One per point of the surface: only where they are negative it is drawn; empty: all of it.
  std::vector<double> skin_sides;
  bool opened = false;  ///< a part is left out: the skin stays, pale, where nothing else is seen
  std::vector<SnapshotBone> bones;
  std::vector<SnapshotArrow> arrows;
  std::vector<SnapshotLine> lines;
  std::vector<SnapshotCurve> curves;
  SnapshotCut cut;
  Points references;                  ///< where bones hold particles, m, drawn as small balls
  std::vector<SnapshotTrace> traces;  ///< over everything else
  std::vector<SnapshotForce> forces;  ///< over everything else
  std::vector<Mark> marks;            ///< one per particle; empty: none
  Triangles obstacles;                ///< translucent
  Box obstacle_space;  ///< they are drawn as far as they lie in it, in the scene's axes, m
};

/// Moves all of it, m.
void shift(Snapshot& snapshot, const Vec3& by);

/// The particles with this mark, without their values.
Snapshot marked(const Snapshot& snapshot, Mark mark);

/// The values that colors stand for, the same for all pictures of a run.
struct ColorScale {
  std::string name;  ///< name of the quantity, "displacement"
  std::string unit;  ///< "m", or empty for a plain number
  double low = 0, high = 1;
  ColorMap map = ColorMap::indigo;
  std::vector<std::string> names = {};  ///< names of the values 0, 1, ... up to `high`, if any
  std::vector<Color> colors = {};       ///< colors of these values; empty: those of the map
  std::string note = {};                ///< beside the name, as ", 1st to 99th percentile"

  /// Position of `value` between low and high: 0 .. 1, clamped; not-a-number of not-a-number.
  double position(double value) const;
  Color color(double value) const;
};

}  // namespace sinew
