// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes are a BVH file that gives a sound rig, or bad input in one line.
//
//   CXX=clang++-14 cmake -S . -B build/fuzz -DSINEW_FUZZ=ON && cmake --build build/fuzz --target
//   bvh_fuzz build/fuzz/tests/bvh_fuzz -max_total_time=180 -rss_limit_mb=512 CORPUS data/motions

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>

#include "core/error.h"
#include "rig/bvh/bvh.h"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void require_sound(const sinew::Rig& rig, const sinew::Bvh& bvh) {
  require(rig.skeleton.size() == bvh.joints.size());
  for (const sinew::Bone& bone : rig.skeleton.bones)
    require(bone.length > 0 && bone.rest.origin.allFinite() && bone.rest.rotation.allFinite());
  for (const sinew::Clip& clip : rig.clips)
    for (const sinew::Track& track : clip.motion.tracks)
      for (const sinew::Quat& turn : track.rotation.values)
        require(std::abs(turn.norm() - 1) < 1e-9);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  try {
    const sinew::Bvh bvh =
        sinew::parse_bvh({reinterpret_cast<const char*>(data), size}, "fuzz.bvh");
    sinew::BvhOptions options;
    options.rate = size % 2 ? 0 : 7;
    require_sound(sinew::rig_of(bvh, options), bvh);
  } catch (const sinew::Error& error) {
    require(error.exit() == sinew::Exit::bad_input && std::strstr(error.what(), "; "));
    const char* end = error.what() + std::strlen(error.what());
    require(std::none_of(error.what(), end, [](unsigned char c) { return std::iscntrl(c); }));
  }
  return 0;
}
