// SPDX-License-Identifier: GPL-3.0-or-later
// Builds small worlds for tests in a line or two.
#pragma once

#include <cmath>
#include <random>

#include <sinew/analysis/time_step.h>
#include <sinew/core/deformation.h>
#include <sinew/core/particles.h>
#include <sinew/scene/damping.h>
#include <sinew/scene/prepare.h>
#include <sinew/scene/rig.h>
#include <sinew/settings/settings.h>
#include <sinew/stepping/simulation.h>

namespace sinew::test {

/// Sites of FCC in an upright box of nx x ny x nz half-planes, x and y centered on 0, z from 0.
inline Points fcc_box(int nx, int ny, int nz, double r) {
  const double s = half_plane_spacing(r);
  const int ci = nx / 2, cj = ny / 2, ck = nz / 2;  // the site in the middle exists
  Points points;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        if ((i - ci + j - cj + k - ck) % 2 == 0)
          points.emplace_back(s * (i - ci), s * (j - cj), s * (k + 0.5));
  return points;
}

/// Nearest neighbors of particles of radius r.
inline NeighborLists nearest(const Points& rest, double r) {
  return rest_neighbors(rest, r, false).nearest;
}

/// The neighbors that count for a material.
inline RestNeighbors neighbors(const Points& rest, const Material& material) {
  return rest_neighbors(rest, material.pair.r, material.bond.second > 0);
}

/// Sites within `radius_in_r` radii of the origin, of FCC or HCP (layers A B A B along z).
inline Points fcc_ball(double radius_in_r, double r) {
  const int n = 2 * static_cast<int>(radius_in_r) + 1;
  Points points;
  for (Vec3 site : fcc_box(n, n, n, r)) {
    site.z() -= half_plane_spacing(r) * (n / 2 + 0.5);
    if (site.norm() < radius_in_r * r) points.push_back(site);
  }
  return points;
}

inline Points hcp_ball(double radius_in_r, double r) {
  const int n = static_cast<int>(radius_in_r) + 2;
  const double row = std::sqrt(3.0) * r, layer = std::sqrt(8.0 / 3) * r;
  Points points;
  for (int k = -n; k <= n; ++k)
    for (int j = -n; j <= n; ++j)
      for (int i = -n; i <= n; ++i) {
        const double in_b = k & 1;
        const Vec3 site(2 * r * i + r * (j & 1) + r * in_b, row * j + row / 3 * in_b, layer * k);
        if (site.norm() < radius_in_r * r) points.push_back(site);
      }
  return points;
}

/// F X + shift for all points.
inline Points affine(Points points, const Mat3& F, const Vec3& shift = Vec3::Zero()) {
  for (Vec3& point : points) point = F * point + shift;
  return points;
}

/// The rotation by `angle` degrees about `axis`.
inline Mat3 turned(const Vec3& axis, double angle) {
  return Eigen::AngleAxisd(radians(angle), axis.normalized()).toRotationMatrix();
}

/// Entries between -0.5 and 0.5.
inline Mat3 random_matrix(std::mt19937& random) {
  std::uniform_real_distribution<double> half(-0.5, 0.5);
  Mat3 matrix;
  for (double& entry : matrix.reshaped()) entry = half(random);
  return matrix;
}

inline Vec3 random_vector(std::mt19937& random) { return random_matrix(random).col(0); }

/// The same particles in another order: place i holds what was at order[i].
inline Particles reordered(const Particles& particles, const std::vector<std::size_t>& order) {
  Particles other = particles;
  for (std::size_t i = 0; i < order.size(); ++i) {
    other.set_position(i, particles.position(order[i]));
    other.set_velocity(i, particles.velocity(order[i]));
    other.id[i] = particles.id[order[i]];
  }
  return other;
}

/// A scene of the paper's box, or of a bar of other height, with two bones along z and no motion.
inline Settings box_scene(int half_planes = 49) {
  Settings settings;
  settings.body.radius = 0.010;
  const double height = half_planes * half_plane_spacing(0.010);
  settings.bones = {{"lower", "", Vec3(0, 0, 0), Vec3(0, 0, height / 2)},
                    {"upper", "lower", {}, Vec3(0, 0, height)}};
  return settings;
}

/// Key of a rotation by `angle` degrees about y, or of a twist.
inline KeyDefinition bend_key(double time, double angle) {
  KeyDefinition key;
  key.time = time;
  key.axis = Vec3::UnitY();
  key.angle = angle;
  return key;
}

inline KeyDefinition twist_key(double time, double angle) {
  KeyDefinition key;
  key.time = time;
  key.twist = angle;
  return key;
}

inline TrackDefinition track(const std::string& bone, std::vector<KeyDefinition> keys) {
  TrackDefinition track;
  track.bone = bone;
  track.keys = std::move(keys);
  return track;
}

/// Particles of the scene's radius and density at `rest`.
inline Particles particles_of(const Settings& settings, const Points& rest) {
  const double r = *settings.body.radius;
  return particles_at(rest, r, settings.material.density * volume_per_particle(r));
}

inline Body make_body(const Settings& settings, const Points& rest) {
  Body body = make_body(settings, {}, skeleton_of(settings), particles_of(settings, rest));
  std::optional<ElasticModes> modes;
  set_damping(settings, body, modes);
  return body;
}

/// The scene with particles at `rest` in place of a mesh.
inline Prepared prepared(const Settings& settings, const Points& rest) {
  BodyFile filled;
  filled.particles = particles_of(settings, rest);
  return prepare({settings, std::move(filled), false});
}

/// A simulation of particles at `rest`, with the step that the settings choose.
inline Simulation make_simulation(const Settings& settings, const Points& rest) {
  return start(prepared(settings, rest));
}

/// The scene without bone forces: the body is free.
inline Settings unbound(Settings settings) {
  settings.binding.stiffness = settings.binding.twist_stiffness = 0;
  settings.binding.axial_stiffness = 0;
  return settings;
}

/// The material of the scene's particles.
inline Material material_of(const Settings& settings) {
  const double r = *settings.body.radius;
  return make_material(settings.material, {r, settings.material.density * volume_per_particle(r)});
}

/// A simulation that starts with `particles` and takes steps of `step` (s).
inline Simulation simulation_from(const Settings& settings, const Points& rest,
                                  const Particles& particles, double step) {
  const Body body = make_body(settings, rest);
  return Simulation(body, motion_of(settings, body.skeleton), particles,
                    stepping_of(settings.solver, step));
}

/// Largest speed, m/s.
inline double largest_speed(const Particles& particles) {
  double most = 0;
  for (std::size_t i = 0; i < particles.size(); ++i)
    most = std::max(most, particles.velocity(i).norm());
  return most;
}

/// Particles at `points` shaken by up to `shake` along each axis, with velocities up to `speed`.
inline Particles shaken(const Points& points, const Material& material, double shake, double speed,
                        unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&] {
    const double x = unit(random), y = unit(random), z = unit(random);
    return Vec3(x, y, z);
  };
  Particles particles = particles_at(points, material.pair.r, material.mass);
  for (std::size_t i = 0; i < points.size(); ++i) {
    particles.set_position(i, points[i] + shake * vector());
    particles.set_velocity(i, speed * vector());
  }
  return particles;
}

/// Deformation gradients of all particles.
inline std::vector<Mat3> deformation_gradients(const RestShape& rest, const Points& now) {
  std::vector<Mat3> gradients;
  for (std::size_t i = 0; i < now.size(); ++i)
    gradients.push_back(deformation_gradient(rest, now, i));
  return gradients;
}

}  // namespace sinew::test
