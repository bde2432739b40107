// SPDX-License-Identifier: GPL-3.0-or-later
#include "rig_info.h"

#include <algorithm>

#include "core/closest_packing.h"
#include "core/number_text.h"
#include "physics/time_step.h"

namespace sinew {
namespace {

constexpr int least_samples = 200;  // of a clip, for its largest speed

/// The largest speed of any bone's head or tail in a clip, m/s.
double largest_speed(const Skeleton& skeleton, const Clip& clip) {
  const int samples = std::max(least_samples, 2 * clip.frames);
  double fastest = 0;
  for (int sample = 0; sample <= samples; ++sample) {
    const Pose pose = pose_at(skeleton, clip.motion, clip.duration * sample / samples);
    for (std::size_t b = 0; b < pose.size(); ++b) {
      const double length = pose[b].stretch * skeleton.bones[b].length;
      const Vec3 tail = pose[b].frame.origin + length * pose[b].axis();
      fastest = std::max({fastest, pose[b].velocity.norm(), pose[b].velocity_at(tail).norm()});
    }
  }
  return fastest;
}

/// The step that a body of the default material takes by itself, s.
double usual_step(double radius) {
  const MaterialSettings settings;
  const Material material =
      make_material(settings, radius, settings.density * volume_per_particle(radius));
  const SolverSettings solver;
  return solver.time_step_factor * step_limit(solver.integrator, material, {});
}

void add_tree(const Skeleton& skeleton, int parent, const std::string& indent, Results& results) {
  for (std::size_t b = 0; b < skeleton.size(); ++b) {
    if (skeleton.bones[b].parent != parent) continue;
    results.add(indent + skeleton.bones[b].name, skeleton.bones[b].length, "m");
    add_tree(skeleton, static_cast<int>(b), indent + "  ", results);
  }
}

}  // namespace

void add_rig_info(const Rig& rig, std::optional<double> radius, Results& results) {
  results.add("bones", rig.skeleton.size());
  const Clip none;
  const Clip& first = rig.clips.empty() ? none : rig.clips.front();
  results.add("frames", first.frames);
  results.add("frame_time", first.frame_time, "s");
  results.add("duration", first.duration, "s");
  for (const Clip& clip : rig.clips) results.add("clip", clip.name);
  if (radius) {
    double fastest = 0;
    for (const Clip& clip : rig.clips)
      fastest = std::max(fastest, largest_speed(rig.skeleton, clip));
    const double step = usual_step(*radius);
    results.add("bone_speed", fastest * step / *radius,
                "radii per step of " + three_digits(step) + " s, that of the default material");
  }
  add_tree(rig.skeleton, no_bone, "", results);
}

}  // namespace sinew
