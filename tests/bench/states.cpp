// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <string>

#include <sinew/groups/static_groups.h>
#include <sinew/mesh/refine.h>
#include <sinew/world/world.h>

#include "bench/states.h"
#include "support/world.h"

namespace sinew::bench {
namespace {

constexpr double r = 0.010;             // m
constexpr double turn = 90;             // degrees
constexpr double bend_zone = 3;         // widths; the faces stretch and shrink by 26 %
constexpr double crushed_width = 0.75;  // near the body-centered packing: 14 neighbors, not 12
constexpr double strong_grip = 64;      // springs as stiff as bonds in the paper's box
constexpr int paper_across = 11, paper_along = 49;  // half-planes
constexpr double approach = 0.5;                    // s, of bones that bend
constexpr int steps_of_loading = 1000;              // until loads act in full
constexpr std::array names{"rest", "bent", "twisted", "crushed", "flowed", "bending"};
constexpr std::array variant_names{
    "paper",    "initial_neighbors", "bonded",  "twelve_bonds", "bonded_volume", "breaking",
    "yielding", "symmetric",         "central", "plane",        "sphere",        "pinned",
    "muscle",   "relaxing",          "pressed", "grouped"};

struct Bar {
  int across = 0, along = 0;  // half-planes, odd: a site is in the middle

  double width() const { return across * half_plane_spacing(r); }
  double length() const { return along * half_plane_spacing(r); }
  double zone() const { return bend_zone * width(); }
  double slower() const { return along / static_cast<double>(paper_along); }  ///< than the paper's
};

int odd(double value) { return 2 * static_cast<int>(value / 2) + 1; }

Bar bar_of(std::size_t count) {
  const double sites = 2.0 * static_cast<double>(count);
  const double cube = paper_along / static_cast<double>(paper_across);
  const int across = odd(std::cbrt(sites / cube));
  return {across, odd(sites / across / across)};
}

/// The middle line follows an arc towards x over the zone; the ends stay straight.
Vec3 bent(const Vec3& rest, const Bar& bar) {
  const double zone = bar.zone(), begin = (bar.length() - zone) / 2;
  const double radius = zone / radians(turn);
  const double s = std::clamp(rest.z() - begin, 0.0, zone), angle = s / radius;
  const Vec3 along(std::sin(angle), 0, std::cos(angle)),
      across(std::cos(angle), 0, -std::sin(angle));
  const Vec3 center(radius, 0, begin);
  return center + (rest.x() - radius) * across + rest.y() * Vec3::UnitY() +
         (rest.z() - begin - s) * along;
}

Vec3 twisted(const Vec3& rest, const Bar& bar) {
  return test::turned(Vec3::UnitZ(), turn * rest.z() / bar.length()) * rest;
}

Vec3 crushed(const Vec3& rest) { return {crushed_width * rest.x(), rest.y(), rest.z()}; }

/// Two bones along the middle line; those of a bent body meet where its straight ends would.
std::vector<BoneDefinition> bones_of(Condition condition, const Bar& bar) {
  const double straight = (bar.length() - bar.zone()) / 2;
  const double half = straight + bar.zone() / radians(turn);
  if (condition != Condition::bent) return test::box_scene(bar.along).bones;
  return {{"lower", "", Vec3::Zero(), Vec3(0, 0, half)},
          {"upper", "lower", {}, Vec3(half, 0, half)}};
}

/// Springs as stiff as bonds, whatever the body's cross-section.
void grip(BindingOptions& binding, const Bar& bar) {
  const double widths = bar.across / static_cast<double>(paper_across);
  binding.stiffness = binding.twist_stiffness = binding.axial_stiffness =
      strong_grip * widths * widths;
}

/// Bends from upright to 90 degrees in twice the approach, beginning at `time` (s).
TrackDefinition bending(double time, const Bar& bar) {
  const double end = time + 2 * approach * bar.slower();
  return test::track("upper", {test::bend_key(time, 0), test::bend_key(end, turn)});
}

void choose(Variant variant, MaterialOptions& material) {
  if (variant == Variant::initial_neighbors) material.cohesion = Cohesion::initial_neighbors;
  if (variant == Variant::symmetric) material.damping_form = DampingForm::symmetric;
  if (variant == Variant::central) material.damping_form = DampingForm::central;
  if (variant == Variant::bonded_volume) material.model = MaterialModel::bonded_volume;
  if (variant == Variant::twelve_bonds) material.isotropic = false;
  if (variant == Variant::bonded || variant == Variant::twelve_bonds ||
      variant == Variant::breaking || variant == Variant::yielding ||
      variant == Variant::relaxing || variant == Variant::pressed)
    material.model = MaterialModel::bonded;
  if (variant == Variant::breaking) material.breaking_strain = 0.3;
  if (variant == Variant::yielding) material.yield_strain = 0.02;
  if (variant == Variant::relaxing) {
    material.relaxation_shares = {0.3, 0.2};
    material.relaxation_times = {0.1, 2};
  }
}

/// The surface around particles, in triangles as scenes have them.
Triangles skin_of(const Points& rest) {
  const Box box(bounds(rest).min() - Vec3::Constant(0.7 * r),
                bounds(rest).max() + Vec3::Constant(0.7 * r));
  Triangles skin;
  for (int k = 0; k < 8; ++k) skin.points.push_back(box.corner(static_cast<Box::CornerType>(k)));
  const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& [a, b, c, d] : quads) {
    skin.faces.push_back({a, b, c});
    skin.faces.push_back({a, c, d});
  }
  return refined(skin, longest_pressed_side * r);
}

Obstacle wall(const Material& material, const Shape& shape) {
  Obstacle made;
  made.shape = shape;
  made.stiffness = material.pair.contact_stiffness();
  made.damping = std::sqrt(made.stiffness * material.mass) / 2;
  made.friction = 0.5;
  return made;
}

/// What the variant puts around a body at `rest`; obstacles overlap it by a tenth of a radius.
std::shared_ptr<const World> world_of(Variant variant, const Bar& bar, const Points& rest,
                                      const Material& material) {
  World world;
  Box box;
  for (const Vec3& point : rest) box.extend(point);
  if (variant == Variant::plane)
    world.obstacles = {wall(material, PlaneShape{{0, 0, box.min().z() - 0.9 * r}, Vec3::UnitZ()})};
  if (variant == Variant::sphere) {
    const Vec3 center(box.min().x() - 0.9 * r - bar.width(), 0, bar.length() / 4);
    world.obstacles = {wall(material, SphereShape{center, bar.width()})};
  }
  if (variant == Variant::pinned) {
    const PlaneShape lowest{{0, 0, box.min().z() + r / 2}, Vec3::UnitZ()};
    world.pins = pinned(rest, {{{lowest, 0}, 0}}, 2);
  }
  if (variant == Variant::muscle) {
    Muscle muscle;
    muscle.name = "all";
    muscle.strength = 0.02 * material.young_modulus();
    muscle.weights = weights_in({}, rest);
    world.muscles = make_muscles(rest, r, {muscle});
  }
  if (variant == Variant::pressed)
    world.loads = {pressure_load("skin", skin_of(rest), 0.02 * material.young_modulus(), rest, r)};
  const bool any = !world.obstacles.empty() || !world.pins.empty() || !world.loads.empty() ||
                   !world.muscles.muscles.empty();
  return any ? std::make_shared<const World>(std::move(world)) : nullptr;
}

Settings settings_of(Condition condition, Variant variant, const Bar& bar) {
  Settings settings = test::box_scene(bar.along);
  choose(variant, settings.material);
  if (condition == Condition::bending) settings.tracks = {bending(-approach * bar.slower(), bar)};
  settings.bones = bones_of(condition, bar);
  if (condition == Condition::bent || condition == Condition::crushed) grip(settings.binding, bar);
  if (condition == Condition::twisted) {
    settings.tracks = {test::track("upper", {test::twist_key(0, turn)})};
    settings.binding.joint_zone = bar.length() / bar.width();
  }
  return settings;
}

template <class Map>
Points mapped(Points points, Map&& map) {
  for (Vec3& point : points) point = map(point);
  return points;
}

/// Where the body is bound: only strong bones, bound to it in this shape, keep it bent or crushed.
Points rest_of(Condition condition, const Bar& bar) {
  const Points box = test::fcc_box(bar.across, bar.across, bar.along, r);
  if (condition == Condition::bent) return mapped(box, [&](const Vec3& x) { return bent(x, bar); });
  if (condition == Condition::crushed) return mapped(box, crushed);
  return box;
}

/// The start: twisted by its bones, which keep an even twist, or shaken out of its lattice.
Particles start_of(Condition condition, const Bar& bar, const Body& body) {
  if (condition == Condition::flowed) return test::shaken(body.rest, body.material, r, 0);
  if (condition != Condition::twisted) return particles_at(body.rest, r, body.material.mass);
  const auto twist = [&](const Vec3& x) { return twisted(x, bar); };
  return particles_at(mapped(body.rest, twist), r, body.material.mass);
}

/// The written order, whatever the present order.
Particles in_written_order(const Particles& particles) {
  Particles written = particles;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const std::int32_t id = particles.id[i];
    written.set_position(id, particles.position(i));
    written.set_velocity(id, particles.velocity(i));
    written.id[id] = id;
  }
  return written;
}

bool is_loaded(const Scene& scene) { return scene.body.world && !scene.body.world->loads.empty(); }

Particles after(int steps, Scene scene, const Particles& start) {
  if (!scene.approach.tracks.empty()) scene.motion = scene.approach;
  if (is_loaded(scene)) {  // by what grows: a shock is another state
    World growing = *scene.body.world;
    for (Load& load : growing.loads) load.scale = {{0, steps * scene.step}, {0, 1}};
    scene.body.world = std::make_shared<const World>(std::move(growing));
  }
  Simulation simulation = simulation_of(scene, start, Precision::binary64, NeighborSearch::lists);
  for (int step = 0; step < steps; ++step) simulation.step();
  return in_written_order(simulation.particles());
}

}  // namespace

std::string_view name_of(Condition condition) { return names[static_cast<std::size_t>(condition)]; }

std::string_view name_of(Variant variant) {
  return variant_names[static_cast<std::size_t>(variant)];
}

Condition condition_named(std::string_view name) {
  for (const Condition condition : conditions)
    if (name == name_of(condition)) return condition;
  throw bad_input("no state '" + std::string(name) + "'",
                  "use rest, bent, twisted, crushed, flowed or bending");
}

Scene scene_of(Condition condition, std::size_t count, Variant variant) {
  const Bar bar = bar_of(count);
  Settings settings = settings_of(condition, variant, bar);
  Scene scene;
  scene.body = test::make_body(settings, rest_of(condition, bar));
  scene.body.world = world_of(variant, bar, scene.body.rest, scene.body.material);
  scene.motion = motion_of(settings, scene.body.skeleton);
  if (variant == Variant::grouped)
    scene.body.grouping = std::make_shared<const Grouping>(
        static_groups(scene.body, moving_joints(scene.body.skeleton, scene.motion, 1), {}));
  scene.start = start_of(condition, bar, scene.body);
  if (condition == Condition::bending) {
    settings.tracks = {bending(0, bar)};
    scene.approach = motion_of(settings, scene.body.skeleton);
  }
  const double limit =
      step_limit(settings.solver.integrator, scene.body.material, scene.body.springs);
  scene.step = choose_step(settings.solver, limit, settings.output.interval).step;
  scene.approach_steps = static_cast<int>(std::ceil(approach * bar.slower() / scene.step));
  return scene;
}

Particles settled(const Scene& scene, Condition condition) {
  if (condition == Condition::rest && !is_loaded(scene)) return scene.start;
  if (condition == Condition::rest) return after(steps_of_loading, scene, scene.start);
  if (condition == Condition::bending) return after(scene.approach_steps, scene, scene.start);
  if (condition != Condition::flowed) return after(100, scene, scene.start);
  Particles particles = scene.start;  // overlapping, they would burst apart in full steps
  for (const double fraction : {0.1, 0.4, 1.0, 1.0}) {
    Scene slower = scene;
    slower.step = fraction * scene.step;
    particles = after(100, slower, particles);
  }
  return particles;
}

Simulation simulation_of(const Scene& scene, const Particles& particles, Precision precision,
                         NeighborSearch search) {
  Stepping stepping;
  stepping.step = scene.step;
  stepping.precision = precision;
  stepping.neighbor_search = search;
  return Simulation(scene.body, scene.motion, particles, stepping);
}

}  // namespace sinew::bench
