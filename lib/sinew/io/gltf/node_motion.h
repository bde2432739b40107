// SPDX-License-Identifier: GPL-3.0-or-later
// One animation of a glTF file: how its nodes move, in their own terms.
#pragma once

#include <vector>

#include <sinew/io/gltf/checks.h>
#include <sinew/rig/curve.h>

namespace sinew {

/// What changes of a node's place over time; curves without keys: what does not.
struct GltfNodeCurves {
  Curve<Vec3> translation, scale;
  RotationCurve rotation;

  bool empty() const { return translation.empty() && scale.empty() && rotation.empty(); }
};

struct GltfNodeMotion {
  std::vector<GltfPlace> places;       ///< of each node; what a curve moves is not to be used
  std::vector<GltfNodeCurves> curves;  ///< of each node
  std::vector<double> times;           ///< of all keys, s, ascending, each once

  /// Of a node within its parent.
  Affine at(int node, double time) const;
};

/// Keys are the file's; channels that never change their value are taken into the places. Scales
/// that change by less than 1e-5 of themselves count as unchanged: rounding of exporters. Throws
/// bad input (without the path) for times that do not ascend from 0 or more, numbers that are not
/// finite and rotations of length 0.
GltfNodeMotion gltf_node_motion(const CheckedGltf& gltf, std::size_t animation);

}  // namespace sinew
