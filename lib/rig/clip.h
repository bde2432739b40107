// SPDX-License-Identifier: GPL-3.0-or-later
// What a file of a rig holds: a skeleton and the motions it knows by name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "rig/motion.h"
#include "rig/skeleton.h"

namespace sinew {

struct Clip {
  std::string name;
  Motion motion;
  double duration = 0;    ///< s
  int frames = 0;         ///< 0 where keys lie in no frames
  double frame_time = 0;  ///< s between frames; 0 where keys lie in no frames
};

struct Rig {
  Skeleton skeleton;
  std::vector<Clip> clips;
};

/// Throws bad input (without the path) for a name that is not there, with the nearest one that is.
const Clip& find_clip(const std::vector<Clip>& clips, std::string_view name);

}  // namespace sinew
