// SPDX-License-Identifier: GPL-3.0-or-later
// A small bent box without any physics: two bones, the second turns by 90 degrees, and particles
// and surface follow by blending. Every frame is a closed form of time.
#pragma once

#include <sinew/core/triangles.h>
#include <sinew/io/frames.h>
#include <sinew/io/particle_frame.h>
#include <sinew/io/single_files.h>
#include <sinew/rig/motion.h>

namespace sinew {

/// Each particle on one bone, with that weight.
Binding one_bone_each(const std::vector<std::int32_t>& bones, double weight = 1);

class SyntheticRun {
 public:
  SyntheticRun();

  Dataset particles(Moment moment) const;
  Dataset surface(Moment moment) const;
  Dataset bones(Moment moment) const;
  Dataset frames(Moment moment) const;
  /// Two squares, one rising and turning about z.
  Dataset obstacles(Moment moment) const;
  BodyFile body() const;

  std::size_t count() const { return rest.size(); }

  static constexpr double radius = 0.01;    // m
  static constexpr double half_turn = 1.0;  // s, when the second bone has turned by 90 degrees

  Points rest;                     // m, written order
  std::vector<std::int32_t> bone;  // per particle
  Triangles skin;                  // at rest
  std::vector<std::int32_t> skin_bone;
  Skeleton skeleton;
  Motion motion;
};

}  // namespace sinew
