// SPDX-License-Identifier: GPL-3.0-or-later
// One animation of a glTF file: the motion of its nodes, relative to their parents.
//
//     const Affine place = gltf_node_motion(gltf, animation).at(node, time);
#pragma once

#include <vector>

#include <sinew/io/gltf/checks.h>
#include <sinew/rig/curve.h>

namespace sinew {

/// The animated properties of a node; a curve without keys: the property does not change.
struct GltfNodeCurves {
  Curve<Vec3> translation, scale;
  RotationCurve rotation;

  bool empty() const { return translation.empty() && scale.empty() && rotation.empty(); }
};

struct GltfNodeMotion {
  std::vector<GltfPlace> places;       ///< places of each node; animated properties are invalid
  std::vector<GltfNodeCurves> curves;  ///< curves of each node
  std::vector<double> times;           ///< times of all keys, s, ascending, each once

  /// Transform of a node relative to its parent.
  Affine at(int node, double time) const;
};

/// Keys are the file's (two at one time are a jump); channels of constant value are moved into
/// `places`. Scales that change by less than a relative 1e-5 count as constant: rounding of
/// exporters. Throws bad input (without the path) for times that are negative or do not ascend,
/// numbers that are not finite and rotations of length 0.
GltfNodeMotion gltf_node_motion(const CheckedGltf& gltf, std::size_t animation);

}  // namespace sinew
