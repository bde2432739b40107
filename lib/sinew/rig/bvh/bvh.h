// SPDX-License-Identifier: GPL-3.0-or-later
// BVH (Biovision hierarchy): a skeleton of joints, and the angles of each in every frame.
//
//     const Rig rig = rig_of(read_bvh("walk.bvh"), {.scale = 0.01});
//
// There is no standard; this is what Biovision's and Motion Analysis' files have in common (M.
// Meredith, S. Maddock: Motion Capture File Formats Explained, 2001). Also accepted: words in any
// case, any spaces and line ends, frames that are split over lines, numbers such as "+1", ".5" or
// "1e-3", a byte order mark, names with spaces, several roots, joints without channels, channels in
// any order, an End Site beside child joints (of several in one joint the first counts), with a
// name or "CHANNELS 0". One frame more than announced, or fewer, are read with a warning. A file
// ending after its HIERARCHY is a skeleton without a clip. Not accepted: comments, scale channels.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/rig/motion.h>

namespace sinew {

enum class BvhChannel { x_position, y_position, z_position, x_rotation, y_rotation, z_rotation };

/// Lengths in units of the file, in its directions.
struct BvhJoint {
  std::string name;                  ///< name in the file: may be empty, or that of another joint
  int parent = no_bone;              ///< index of an earlier joint; no_bone for a root
  Vec3 offset = Vec3::Zero();        ///< vector from the parent's joint, at rest
  std::vector<BvhChannel> channels;  ///< 0 to 6 different ones, in the file's order
  std::optional<Vec3> end;           ///< End Site: from this joint to the bone's tail, at rest

  bool operator==(const BvhJoint&) const = default;
};

/// The contents of a file, without any interpretation.
struct Bvh {
  std::vector<BvhJoint> joints;            ///< parents come first
  int frames = 0;                          ///< 0: the file holds a skeleton only
  double frame_time = 0;                   ///< s
  std::vector<double> values;              ///< frames x channels(), degrees and units of the file
  std::vector<std::string> warnings = {};  ///< what the file gets wrong and is read all the same

  std::size_t channels() const;  ///< number of channels of all joints
  bool operator==(const Bvh&) const = default;
};

/// Reads a file of up to 256 MiB, 10,000 joints and a depth of 200. Every number is finite and at
/// most 1e9; the frame time is between 1e-9 and 1e6 s. Throws bad input with line and column.
Bvh read_bvh(const std::filesystem::path& path);

/// The same for a text; `file` names it in errors.
Bvh parse_bvh(std::string_view text, const std::string& file);

/// The meaning of a joint's position channels.
enum class BvhPositions {
  replace,  ///< position relative to the parent; the offset where there is no channel
  add,      ///< displacement from the offset
};

struct BvhOptions {
  std::string name = "clip";  ///< name of the clip
  double scale = 1;           ///< meters per unit of the file
  std::string up = "y";       ///< the file's direction that becomes the scene's z: "x", "-x", ...
  std::string forward = "z";  ///< the file's direction that becomes the scene's x
  int start = 0;              ///< first frame, counted from 0; it gets time 0
  int end = -1;               ///< last frame; -1: the file's last
  double rate = 0;            ///< keys per second, by slerp between the frames; 0: the file's
  BvhPositions positions = BvhPositions::replace;
};

/// Skeleton and clip. At rest nothing is rotated and each joint is at its offset. The rotation of a
/// joint is R1 R2 R3 of its rotation channels in their order (the first one outermost); its own
/// rotation does not rotate its position, wherever its position channels are in the order. The
/// scene's y, a figure's left, is up x forward. Between frames rotations are interpolated by slerp
/// (the shortest rotation) and positions linearly. A rate that does not divide the clip's duration
/// ends it early, by less than one key. Without frames there is no clip. Throws bad input for
/// options out of range, more than 20 million keys, and what skeleton_of() rejects.
Rig rig_of(const Bvh& bvh, const BvhOptions& options = {});

}  // namespace sinew
