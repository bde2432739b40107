// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/world.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/mesh/surface_distance.h>
#include <sinew/rig/motion.h>
#include <sinew/scene/context.h>
#include <sinew/scene/rig.h>
#include <sinew/world/shapes.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

std::string entry(const char* list, std::size_t index) {
  std::string path = "world.";
  path += list;
  path += '[' + std::to_string(index) + ']';
  return path;
}

Region region_of(const RegionSettings& given) {
  Region region;
  region.falloff = given.falloff;
  if (given.low)
    region.shape = BoxShape{(*given.low + *given.high) / 2, (*given.high - *given.low) / 2};
  else if (given.center)
    region.shape = SphereShape{*given.center, *given.radius};
  return region;
}

KeyedValue values_of(const std::vector<ValueKeySettings>& keys) {
  KeyedValue values;
  for (const ValueKeySettings& key : keys) {
    values.times.push_back(key.time);
    values.values.push_back(key.value);
  }
  return values;
}

FieldForm form_of(const FieldSettings& given) {
  switch (given.shape) {
    case FieldShape::uniform:
      return UniformAcceleration{*given.acceleration};
    case FieldShape::density:
      return ForceDensity{*given.density};
    case FieldShape::attraction:
      return Attraction{*given.point, *given.strength, *given.core};
    case FieldShape::swirl:
      return Swirl{*given.point, given.axis, *given.strength, *given.core};
  }
  return UniformAcceleration{};
}

/// A shape about its own center, and the center's place in the scene.
struct Placed {  // NOLINT(bugprone-exception-escape): moving a shape throws nothing
  Shape shape;
  Vec3 middle = Vec3::Zero();
  Triangles surface;
};

Placed placed_mesh(const Surface& surface) {
  Placed placed;
  placed.surface = surface.triangles;
  const Box box = bounds(placed.surface.points);
  placed.middle = box.center();
  for (Vec3& point : placed.surface.points) point -= placed.middle;
  MeshShape shape;
  shape.bounds = bounds(placed.surface.points);
  shape.distance = [distance = std::make_shared<SurfaceDistance>(surface),
                    middle = placed.middle](const Vec3& point) -> SignedDistance {
    const NearestPlace nearest = distance->from(point + middle);
    return {nearest.distance, nearest.normal};
  };
  placed.shape = std::move(shape);
  return placed;
}

/// `mesh`: for that shape alone. `size`: of the body, m.
Placed placed_shape(const ObstacleSettings& given, const Surface& mesh, double size) {
  const Vec3 zero = Vec3::Zero();
  Placed placed;
  switch (given.shape) {
    case ObstacleShape::mesh:
      return placed_mesh(mesh);
    case ObstacleShape::plane:
      placed = {PlaneShape{zero, given.normal}, given.point, {}};
      break;
    case ObstacleShape::sphere:
      placed = {SphereShape{zero, *given.radius}, *given.center, {}};
      break;
    case ObstacleShape::capsule: {
      const Vec3 middle = (*given.from + *given.to) / 2;
      placed = {CapsuleShape{*given.from - middle, *given.to - middle, *given.radius}, middle, {}};
      break;
    }
    case ObstacleShape::box:
      placed = {BoxShape{zero, *given.size / 2, rotation_of(given.rotation)}, *given.center, {}};
      break;
  }
  placed.surface = surface_of(placed.shape, size);
  return placed;
}

ObstacleMotion motion_of(const ObstacleSettings& given, const Vec3& middle, int bone,
                         const Skeleton& skeleton) {
  if (!given.keys.empty()) return keyed_motion(given.name, given.interpolation, given.keys, middle);
  const RigidFrame frame = {middle, Mat3::Identity()};
  return bone == no_bone ? still(frame) : attached_to_bone(bone, skeleton.bones[bone], frame);
}

void add_obstacles(const Settings& settings, std::span<const Surface> meshes, const Body& body,
                   World& world, std::vector<Triangles>& surfaces) {
  const Material& material = body.material;
  const double k = material.pair.contact_stiffness();
  const double size = 2 * bounds(body.rest).diagonal().norm();
  for (std::size_t i = 0; i < settings.world.obstacles.size(); ++i) {
    const ObstacleSettings& given = settings.world.obstacles[i];
    const std::string path = entry("obstacles", i);
    const int bone = bone_at(settings, path, body.skeleton, given.bone);
    Placed placed = with_context(settings, (path + ".mesh").c_str(),
                                 [&] { return placed_shape(given, meshes[i], size); });
    Obstacle obstacle;
    obstacle.name = given.name;
    obstacle.shape = std::move(placed.shape);
    obstacle.motion = motion_of(given, placed.middle, bone, body.skeleton);
    if (given.keys.empty()) obstacle.bone = bone;
    obstacle.stiffness = given.stiffness * k;
    obstacle.damping = given.damping * std::sqrt(obstacle.stiffness * material.mass);
    obstacle.friction = given.friction;
    obstacle.friction_scale = values_of(given.friction_keys);
    world.obstacles.push_back(std::move(obstacle));
    surfaces.push_back(std::move(placed.surface));
  }
}

void add_pins(const Settings& settings, const Body& body, World& world) {
  std::vector<Pin> pins;
  for (std::size_t i = 0; i < settings.world.pins.size(); ++i) {
    const PinSettings& given = settings.world.pins[i];
    pins.push_back(
        {region_of(given.region), bone_at(settings, entry("pins", i), body.skeleton, given.bone)});
  }
  world.pins = with_context(settings, "world.pins", [&] {
    return pinned(body.rest, pins, static_cast<int>(body.skeleton.size()));
  });
}

Muscle muscle_of(const MuscleSettings& given, const std::string& path, const Settings& settings,
                 const Body& body) {
  const int bone = bone_at(settings, path, body.skeleton, given.bone);
  Muscle muscle;
  muscle.name = given.name;
  muscle.direction = given.direction ? *given.direction : body.skeleton.bones[bone].axis();
  muscle.strength = given.strength;
  muscle.activation = values_of(given.keys);
  const Region region = region_of(given.region);
  muscle.weights = bone == no_bone || region.shape ? weights_in(region, body.rest)
                                                   : weights_bound_to(bone, body.binding);
  if (muscle.weights.empty())
    throw bad_input(settings.place(path), "muscle '" + given.name + "' has no particles",
                    "place its region on the body at rest, or name a bone that holds some");
  return muscle;
}

void add_muscles(const Settings& settings, const Body& body, World& world) {
  std::vector<Muscle> muscles;
  for (std::size_t i = 0; i < settings.world.muscles.size(); ++i)
    muscles.push_back(muscle_of(settings.world.muscles[i], entry("muscles", i), settings, body));
  if (muscles.empty()) return;
  world.muscles = with_context(settings, "world.muscles", [&] {
    return make_muscles(rest_shape(body.rest, neighbors_of(body)->nearest), std::move(muscles),
                        body.volume_share);
  });
}

}  // namespace

/// The motion of a bone with its head at the center.
ObstacleMotion keyed_motion(const std::string& name, Interpolation interpolation,
                            std::span<const PlaceKeySettings> keys, const Vec3& middle) {
  const std::vector<BoneDefinition> bones = {{name, "", middle, Vec3(middle + Vec3::UnitX())}};
  TrackDefinition track;
  track.bone = name;
  track.interpolation = interpolation;
  for (const PlaceKeySettings& key : keys) {
    KeyDefinition& made = track.keys.emplace_back();
    made.time = key.time;
    made.translation = key.translation;
    made.axis = key.axis;
    made.angle = key.angle;
  }
  const Skeleton skeleton = make_skeleton(bones);
  Motion motion = played(make_motion(std::span(&track, 1), skeleton), {});
  return [skeleton, motion = std::move(motion)](double time, const Pose&) {
    const BonePose bone = pose_at(skeleton, motion, time).front();
    return ObstaclePose{{bone.frame.origin, bone.turn}, bone.velocity, bone.angular_velocity};
  };
}

SceneWorld world_of(const Settings& settings, const SceneFiles& files, const Body& body,
                    std::span<const std::int32_t> component) {
  SceneWorld made;
  const ParticleParts parts(settings, body, files.surface, component);
  made.probes = probes_of(settings, body, parts);
  if (settings.world.empty() && settings.supports.empty() && settings.loads.empty()) return made;
  World world;
  add_obstacles(settings, files.obstacles, body, world, made.obstacles);
  world.drag.rate = settings.world.drag;
  for (const FieldSettings& given : settings.world.fields)
    world.fields.push_back(
        {given.name, form_of(given), region_of(given.region), values_of(given.keys)});
  add_muscles(settings, body, world);
  add_pins(settings, body, world);
  add_machine(settings, body, parts, world);
  with_context(settings, "world", [&] { check_world(world); });
  made.world = std::make_shared<const World>(std::move(world));
  return made;
}

WorldLoad load_of(const Body& body) {
  const double rate = body.rigid_damping ? body.rigid_damping->rate : 0;
  if (!body.world) return {0, rate};
  Particles particle;
  particle.radius = body.material.pair.r;
  particle.mass = lightest(body).mass;
  return {added_stiffness(*body.world, particle), added_damping(*body.world, particle) + rate};
}

}  // namespace sinew
