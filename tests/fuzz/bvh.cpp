// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/bvh/bvh.h>

#include <algorithm>
#include <cmath>

#include "targets.h"

namespace sinew::fuzz {
namespace {

void require_sound(const Rig& rig, const Bvh& bvh) {
  require(rig.skeleton.size() == bvh.joints.size());
  for (const Bone& bone : rig.skeleton.bones)
    require(bone.length > 0 && bone.rest.origin.allFinite() && bone.rest.rotation.allFinite() &&
            is_one_line(bone.name));
  for (const Clip& clip : rig.clips)
    for (const Track& track : clip.motion.tracks)
      for (const Quat& turn : track.rotation.values) require(std::abs(turn.norm() - 1) < 1e-9);
}

}  // namespace

void bvh(std::string_view bytes) {
  expect_sound_or_refused([&] {
    const Bvh read = parse_bvh(std::string(bytes), "fuzz.bvh");
    BvhOptions options;
    // Up to a thousand keys: the million that a clip may have take seconds here.
    options.rate = bytes.size() % 2 ? 0 : std::min(7.0, 1000 / (read.frame_time * read.frames));
    require_sound(rig_of(read, options), read);
  });
}

}  // namespace sinew::fuzz
