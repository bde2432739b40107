// SPDX-License-Identifier: GPL-3.0-or-later
// A small body to measure: an FCC box along z about two bones in one line, and ways to move it.
#pragma once

#include <functional>
#include <numbers>

#include <sinew/body/volume_weights.h>
#include <sinew/core/particles.h>
#include <sinew/material/laws.h>
#include <sinew/metrics/frame_metrics.h>

namespace sinew::test {

inline constexpr double r = 0.01;                     // m
inline constexpr double h = std::numbers::sqrt2 * r;  // half-plane spacing
inline constexpr int across = 5, along = 20;          // half-planes
inline constexpr double half_length = along * h / 2;  // of the body; the joint is there
inline constexpr double b = 2.6 * r;

using Map = std::function<Vec3(const Vec3&)>;

/// Plane k of the lattice lies at z = (k + 1/2) h; x and y are centered on the bones.
inline Points fcc_box(int width = across, int planes = along) {
  Points points;
  const double middle = (width - 1) / 2.0;
  for (int k = 0; k < planes; ++k)
    for (int j = 0; j < width; ++j)
      for (int i = 0; i < width; ++i)
        if ((i + j + k) % 2 == 0) points.push_back(h * Vec3(i - middle, j - middle, k + 0.5));
  return points;
}

inline int plane_of(const Vec3& point) { return static_cast<int>(std::floor(point.z() / h)); }

/// A closed box with corners `low` and `high`, outside out.
inline Triangles box_surface(const Vec3& low, const Vec3& high) {
  Triangles box;
  for (int corner = 0; corner < 8; ++corner)
    box.points.push_back({corner & 1 ? high.x() : low.x(), corner & 2 ? high.y() : low.y(),
                          corner & 4 ? high.z() : low.z()});
  box.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
               {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return box;
}

/// A flat square of n x n cells, each of two faces, in the plane z = 0.
inline Triangles sheet(int n, double edge = 1) {
  Triangles out;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) out.points.push_back(edge * Vec3(i, j, 0));
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = (n + 1) * j + i;
      out.faces.push_back({a, a + 1, a + n + 2});
      out.faces.push_back({a, a + n + 2, a + n + 1});
    }
  return out;
}

/// Columns: z (the axis), x, y.
inline Mat3 upright() { return (Mat3() << 0, 1, 0, 0, 0, 1, 1, 0, 0).finished(); }

inline Bone bone_at(const std::string& name, int parent, double from, double to) {
  return {name, parent, to - from, {Vec3(0, 0, from), upright()}};
}

inline RestInput box_input() {
  RestInput input;
  input.positions = fcc_box();
  const double side = across * h / 2;
  input.surface = box_surface({-side, -side, 0}, {side, side, 2 * half_length});
  input.skeleton.bones = {bone_at("lower", -1, 0, half_length),
                          bone_at("upper", 0, half_length, 2 * half_length)};
  for (const Vec3& point : input.positions) input.bone.push_back(point.z() > half_length);
  input.material.pair.r = r;
  input.material.pair.b = b;
  input.material.mass = not_measured;
  input.forces.known = false;
  return input;
}

/// The same body elsewhere.
inline RestInput moved_to(const Vec3& shift, RestInput input) {
  for (Vec3& point : input.positions) point += shift;
  for (Vec3& point : input.surface.points) point += shift;
  for (Bone& bone : input.skeleton.bones) bone.rest.origin += shift;
  return input;
}

using ForceAt = double (*)(const Material&, double);

/// `force` between all particles.
inline ForceLaw law_without_bonds(ForceAt force) {
  ForceLaw law{};
  law.has_bonds = true;
  law.force = force;
  return law;
}

/// Springs of the material's stiffness between neighbors at rest, and `force` between others.
inline ForceLaw law_of_springs(ForceAt force, ForceAt energy = nullptr) {
  ForceLaw law = law_without_bonds(force);
  law.has_memory = true;
  law.energy = energy;
  law.bond_force = [](const Material&, const BondSpring& bond, double d) {
    return bond.stiffness * (bond.length - d);
  };
  law.bond_energy = [](const Material&, const BondSpring& bond, double d) {
    return bond.stiffness * (bond.length - d) * (bond.length - d) / 2;
  };
  return law;
}

/// Its particles act on each other by this law, which must outlive all that is made of it.
inline void obey(RestInput& input, const ForceLaw& law) {
  input.material.law = &law;
  input.material.bond.stiffness = 1;
  input.forces.known = true;
  input.forces.factors = std::make_shared<const BondFactors>();
}

/// Particles keep their volumes, with their weights as simulations find them (Pa).
inline void keep_volumes(RestInput& input, double stiffness) {
  BondFactors factors;
  factors.volume_weight = own_volume_weights(
      input.positions, neighbors_within(input.positions, rest_neighbor_range(r)), r);
  input.material.volume_stiffness = stiffness;
  input.forces.factors = std::make_shared<const BondFactors>(std::move(factors));
}

inline Points mapped(Points points, const Map& map) {
  for (Vec3& point : points) point = map(point);
  return points;
}

/// Particles and surface moved by the map, the bones left where they are at rest.
inline FrameState moved(const RestBody& body, const Map& map) {
  FrameState state;
  state.positions = mapped(body.shape.points, map);
  state.velocities.assign(body.particles(), Vec3::Zero());
  state.surface_points = mapped(body.surface.points, map);
  for (const Bone& bone : body.bones) state.bones.push_back(bone.rest);
  return state;
}

inline FrameState at_rest(const RestBody& body) {
  return moved(body, [](const Vec3& point) { return point; });
}

/// The body and its bones moved as one piece.
inline FrameState moved_rigidly(const RestBody& body, const Mat3& turn, const Vec3& shift) {
  FrameState state = moved(body, [&](const Vec3& point) -> Vec3 { return turn * point + shift; });
  for (RigidFrame& bone : state.bones) bone = {turn * bone.origin + shift, turn * bone.rotation};
  return state;
}

inline Mat3 turned(double degrees_, const Vec3& axis) {
  return Eigen::AngleAxisd(radians(degrees_), axis.normalized()).toRotationMatrix();
}

/// Each point turned about z by angle(z) degrees.
inline Map twisted(const std::function<double(double)>& angle) {
  return [angle](const Vec3& point) -> Vec3 {
    return turned(angle(point.z()), Vec3::UnitZ()) * point;
  };
}

}  // namespace sinew::test
