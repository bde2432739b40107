// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/drawn_pulls.h>

#include <algorithm>
#include <limits>

#include <sinew/core/error.h>
#include <sinew/core/particles.h>
#include <sinew/core/rest_neighbors.h>
#include <sinew/rig/binding.h>
#include <sinew/scene/bind_scene.h>
#include <sinew/scene/rig.h>

namespace sinew {
namespace {

/// Picks `count` of the points, each as far as possible from those before it (of equally far ones
/// the first); all of fewer.
std::vector<std::size_t> spread(const Points& points, std::size_t count) {
  std::vector<double> gap(points.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> picked;
  for (std::size_t next = 0; picked.size() < std::min(count, points.size());) {
    picked.push_back(next);
    for (std::size_t i = 0; i < points.size(); ++i)
      gap[i] = std::min(gap[i], (points[i] - points[next]).squaredNorm());
    next = static_cast<std::size_t>(std::max_element(gap.begin(), gap.end()) - gap.begin());
  }
  std::sort(picked.begin(), picked.end());
  return picked;
}

/// The binding of the whole body, by particle id: frames may lack some of its particles.
Binding binding_of(const RunFiles& run, const SceneFiles& files) {
  const Particles particles = read_body(run.folder.body()).particles;
  const Points rest = positions_of(particles);
  const RestNeighbors near = rest_neighbors(rest, particles.radius, false);
  return bind_scene(run.settings, files, run.skeleton, rest, near.nearest, particles.radius);
}

}  // namespace

double DrawnPull::strongest() const {
  return std::max({radial.norm(), twist.norm(), axial.norm()});
}

DrawnPulls::DrawnPulls(const RunFiles& run, std::size_t count) : run_(&run) {
  const SceneFiles files = read_rig_files(run.settings);
  motion_ = rig_of(run.settings, files).motion;
  std::vector<Picked> bound;
  Points places;
  if (run.skeleton.size() > 0) {
    const Binding binding = binding_of(run, files);
    springs_ = bone_springs(run.settings.binding, run.material, binding, run.skeleton);
    hold_stretched(motion_, run.skeleton, run.material, springs_);
    for (std::size_t i = 0; i < run.body.particles.size(); ++i) {
      const auto influences =
          binding.of(run.ids.empty() ? i : static_cast<std::size_t>(run.ids[i]));
      if (influences.empty()) continue;
      places.push_back(run.body.particles.position(i));
      bound.push_back({i, influences.front(), places.back()});
    }
  }
  if (bound.empty())
    throw bad_input(Place{run.folder.path.string()}, "no particle of the run has a bone",
                    "choose another view, as --view body, or run a scene with skeleton.bones");
  for (const std::size_t k : spread(places, count)) picked_.push_back(bound[k]);
}

std::vector<DrawnPull> DrawnPulls::at(const FrameState& frame) const {
  const Pose pose = pose_at(run_->skeleton, motion_, frame.time);
  std::vector<DrawnPull> pulls;
  for (const Picked& one : picked_) {
    const auto b = static_cast<std::size_t>(one.influence.bone);
    const Bone& bone = run_->skeleton.bones[b];
    const Vec3& position = frame.positions[one.particle];
    const BonePull pull =
        bone_pull(springs_[b], one.influence, bone, pose[b],
                  {one.rest, position, Vec3::Zero(), run_->body.particles.radius});
    pulls.push_back({one.particle, one.influence.bone, carried_foot(one.influence, bone, pose[b]),
                     position, pull.radial, pull.twist, pull.axial});
  }
  return pulls;
}

double DrawnPulls::negligible() const {
  constexpr double rounding = 1e-6;  // fraction of a radius: frames are in single precision
  double stiffest = 0;
  for (const BoneSprings& springs : springs_) stiffest = std::max(stiffest, springs.stiffest());
  return rounding * run_->body.particles.radius * stiffest;
}

}  // namespace sinew
