// SPDX-License-Identifier: GPL-3.0-or-later
// The limbs of a body as a tree of lines, from the curves to which its skin contracts.
//
//     const std::vector<Limb> limbs = limbs_of(curve_skeleton(surface.triangles));
//     const LimbRig rig = bones_of(limbs, {.radius = radius});
#pragma once

#include <vector>

#include <sinew/core/curve_graph.h>
#include <sinew/core/options.h>

namespace sinew {

/// A line without branches. Those of the same body without a parent begin at one point, the others
/// where their parent ends.
struct Limb {
  enum class End {
    tip,   ///< on the surface
    fork,  ///< other limbs begin there
    ring,  ///< where a ring is cut open
  };

  int body = 0;               ///< the component of the graph
  int parent = -1;            ///< an earlier limb
  Points line;                ///< points from where it begins, m
  std::vector<double> inner;  ///< distance of these points from the surface, m
  End end = End::tip;
  bool on_ring = false;  ///< both its ends hold the rest of the body
};

/// m.
double length(const Limb& limb);

/// A tree for each component of the graph, which begins where the way to all of the body is the
/// shortest. A ring is cut open where the way from there is the longest. Branches that do not come
/// out of the ball around the place where they begin, by its width again, are no limbs. Lines end
/// at tips, on the surface. A body without limbs, such as a ball, has two, from its middle along
/// its longest axis; the longer one of several comes first.
std::vector<Limb> limbs_of(const CurveGraph& graph);

/// Two limbs from the middle of the points to both sides, along the axis in which they are the
/// longest: of z, x, y if these are as long.
std::vector<Limb> axis_limbs(const Points& skin);

// Bones along the limbs, and a motion that bends each a little and back.

struct LimbRigOptions {
  double radius = 0;   ///< radius of the particles, m: bones end as far below the tips
  double angle = 30;   ///< angle by which a limb bends, in all, degrees
  double bend = 0.5;   ///< time to bend, s
  double hold = 0.25;  ///< time it stays bent, s; then it bends back
};

struct LimbRig {
  std::vector<BoneDefinition> bones;  ///< parents first; the root of each body has no parent
  std::vector<TrackDefinition> tracks;
};

/// One root per body, in its middle, does not move. A limb begins with a bone in the ball around
/// that place, which does not move on its parent either, and goes on with bones short enough for
/// its curves and for a smooth bend. All of its bones turn about one axis, across the limb, towards
/// the side to which the body is thin: limbs side by side do not meet. Those that hold other limbs
/// bend less, those attached at both ends not at all; the two halves of a ring that leaves and
/// meets the body in one place bend as one.
LimbRig bones_of(const std::vector<Limb>& limbs, const LimbRigOptions& options);

}  // namespace sinew
