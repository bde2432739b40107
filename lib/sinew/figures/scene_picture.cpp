// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/figures/scene_picture.h>

#include <algorithm>
#include <limits>

#include <sinew/core/text.h>
#include <sinew/rig/motion.h>
#include <sinew/run/world_shown.h>
#include <sinew/scene/rig.h>
#include <sinew/scene/world.h>

namespace sinew {
namespace {

/// What a picture shows of a scene.
struct DrawnScene {
  const Skeleton& skeleton;
  const Points& rest;  ///< places of the particles, by id
  double radius;
  const World* world;
  const Triangles& surface;
  Triangles obstacles;
};

std::vector<bool> held_particles(const DrawnScene& scene) {
  std::vector<bool> held(scene.rest.size());
  if (scene.world)
    for (const Pinned& pin : scene.world->pins) held[pin.particle] = true;
  return held;
}

/// The particle farthest from all bones, which do not hide it.
std::size_t visible_particle(const DrawnScene& scene) {
  const std::vector<bool> held = held_particles(scene);
  std::size_t best = 0;
  double farthest = -1;
  for (std::size_t i = 0; i < scene.rest.size(); ++i) {
    if (held[i]) continue;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Bone& bone : scene.skeleton.bones)
      nearest = std::min(nearest, distance_to(bone, scene.rest[i]));
    if (nearest > farthest) farthest = nearest, best = i;
  }
  return best;
}

/// Returns the particles of a load on a part of the body: all would hide it.
std::vector<std::uint32_t> loaded_part(const Load& load, const Points& rest) {
  return 2 * load.particles.size() > rest.size() ? std::vector<std::uint32_t>() : load.particles;
}

void add_particles(const DrawnScene& scene, Snapshot& snapshot) {
  snapshot.radius = scene.radius;
  if (scene.rest.empty()) return;
  const auto add = [&](std::size_t i, Mark mark) {
    snapshot.particles.push_back(scene.rest[i]);
    snapshot.marks.push_back(mark);
  };
  if (scene.world) {
    for (const Pinned& pin : scene.world->pins) add(pin.particle, Mark::held);
    for (const Load& load : scene.world->loads)
      for (const std::uint32_t i : loaded_part(load, scene.rest)) add(i, Mark::loaded);
    for (const std::uint32_t i : scene.world->muscles.active) add(i, Mark::muscle);
  }
  add(visible_particle(scene), Mark::sample);
}

Snapshot snapshot_of(DrawnScene scene) {
  Snapshot snapshot;
  snapshot.caption = std::to_string(scene.rest.size()) + " particles, " +
                     std::to_string(scene.skeleton.size()) + " bones";
  snapshot.surface = scene.surface;
  for (const Bone& bone : scene.skeleton.bones) {
    const RigidFrame& rest = bone.rest;
    snapshot.bones.push_back({rest.origin, rest.origin + bone.length * bone.axis(), rest.rotation});
  }
  add_particles(scene, snapshot);
  snapshot.obstacles = std::move(scene.obstacles);
  Box body = bounds(scene.surface.points);
  for (const SnapshotBone& bone : snapshot.bones) body.extend(bone.head).extend(bone.tail);
  snapshot.obstacle_space = obstacle_space(body);
  return snapshot;
}

Triangles obstacles_at_start(const Prepared& prepared) {
  Triangles all;
  if (!prepared.body.world) return all;
  const Pose pose = pose_at(prepared.body.skeleton, prepared.motion, 0);
  const WorldNow now = world_at(*prepared.body.world, 0, pose);
  for (std::size_t k = 0; k < prepared.obstacles.size(); ++k) {
    const RigidFrame& frame = now.obstacles[k].frame;
    const int first = static_cast<int>(all.points.size());
    for (const Vec3& point : prepared.obstacles[k].points)
      all.points.push_back(frame.origin + frame.rotation * point);
    for (const auto& [a, b, c] : prepared.obstacles[k].faces)
      all.faces.push_back({first + a, first + b, first + c});
  }
  return all;
}

}  // namespace

Snapshot scene_snapshot(const Prepared& prepared) {
  const Body& body = prepared.body;
  return snapshot_of({body.skeleton, body.rest, body.material.pair.r, body.world.get(),
                      prepared.surface.triangles, obstacles_at_start(prepared)});
}

Snapshot scene_snapshot(const RunFiles& run) {
  const Points rest =
      positions_of(run.ids.empty() ? run.body.particles : read_body(run.folder.body()).particles);
  const auto world = world_of_run(run);
  return snapshot_of({run.skeleton, rest, run.body.particles.radius, world.get(), run.surface,
                      read_obstacles(run, 0)});
}

Snapshot intrusion_snapshot(const Prepared& prepared, const Intrusion& found) {
  const Body& body = prepared.body;
  const Pose pose = pose_at(body.skeleton, prepared.motion, found.deepest);
  Snapshot snapshot;
  snapshot.radius = body.material.pair.r;
  snapshot.caption =
      intrusions_text({&found, 1}, body) + " at " + three_digits(found.deepest) + " s";
  snapshot.surface = prepared.surface.triangles;
  Points& skin = snapshot.surface.points;
  skin = dual_quaternion_skinned(skin, carried_weights(body.rest, weights_of(body.binding), skin),
                                 body.skeleton, pose);
  const Points now = skinned(body, pose);
  for (const std::uint32_t i : overlapping(body, pose, found.bones)) {
    snapshot.particles.push_back(now[i]);
    snapshot.marks.push_back(Mark::within);
  }
  for (std::size_t b = 0; b < pose.size(); ++b) {
    const BonePose& bone = pose[b];
    const Vec3 head = bone.frame.origin;
    snapshot.bones.push_back({head,
                              bone.carried(body.skeleton.bones[b].tail(), body.skeleton.bones[b]),
                              bone.frame.rotation});
  }
  return snapshot;
}

void write_scene_picture(const Snapshot& scene, const ElevationOptions& options,
                         const PageFiles& files, const std::string& path) {
  Painter painter(scene.surface, {});
  const auto on = [&](const Paper& paper) {
    ElevationOptions with_paper = options;
    with_paper.paper = paper;
    return elevations(painter, scene, with_paper);
  };
  write_page(on, files, path);
}

}  // namespace sinew
