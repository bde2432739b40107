// SPDX-License-Identifier: GPL-3.0-or-later
// The animations of a glTF file as clips of bones.
//
//     const std::vector<Clip> clips = gltf_clips(gltf, gltf_bind_pose(gltf), 60);
#pragma once

#include <string>
#include <vector>

#include <sinew/io/gltf/checks.h>
#include <sinew/rig/motion.h>

namespace sinew {

/// Makes one of animations without a name that are equally long and move other nodes each: some
/// exporters write one for each joint.
void join_unnamed(CheckedGltf& gltf);

/// All clips, each of a name of its own; `rate` as in GltfRigOptions. Throws bad input (without the
/// path) for damaged animations, and for more than fits memory.
std::vector<Clip> gltf_clips(const CheckedGltf& gltf, const GltfBindPose& bind, double rate);

/// The clips of `from` for the nodes of the same names, as read_gltf_clips() says.
std::vector<Clip> gltf_clips_from(const CheckedGltf& from, const CheckedGltf& gltf,
                                  const GltfBindPose& bind, double rate,
                                  std::vector<std::string>& warnings);

}  // namespace sinew
